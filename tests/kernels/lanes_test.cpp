// The lane types against plain C++, one value at a time, on every instruction set; what moves values between lanes and
// memory is in lane_moves_test.cpp.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "tests/kernels/isa_test.h"
#include "tests/kernels/lane_inputs.h"
#include "tests/kernels/lanes_entries.h"

namespace wavecrest {
namespace {

template <class T>
using Reference = std::map<std::string, std::function<T(T, T, T)>>;

// ---- plain C++ for each operation -----------------------------------------------------------------------------------

template <class T>
Reference<T> realReference() {
  const auto flag = [](bool b) { return b ? T(1) : T(0); };
  return {{"add", [](T a, T b, T) { return a + b; }},
          {"sub", [](T a, T b, T) { return a - b; }},
          {"mul", [](T a, T b, T) { return a * b; }},
          {"div", [](T a, T b, T) { return a / b; }},
          {"negate", [](T a, T, T) { return -a; }},
          {"mulAdd", [](T a, T b, T c) { return std::fma(a, b, c); }},
          {"negMulAdd", [](T a, T b, T c) { return std::fma(-a, b, c); }},
          {"mulSub", [](T a, T b, T c) { return std::fma(a, b, -c); }},
          {"abs", [](T a, T, T) { return std::abs(a); }},
          {"min", [](T a, T b, T) { return std::min(a, b); }},
          {"max", [](T a, T b, T) { return std::max(a, b); }},
          {"sqrt", [](T a, T, T) { return std::sqrt(std::abs(a)); }},
          {"floor", [](T a, T, T) { return std::floor(a); }},
          {"round", [](T a, T, T) { return std::nearbyint(a); }},
          {"copySign", [](T a, T b, T) { return std::copysign(a, b); }},
          {"less", [=](T a, T b, T) { return flag(a < b); }},
          {"lessEqual", [=](T a, T b, T) { return flag(a <= b); }},
          {"greater", [=](T a, T b, T) { return flag(a > b); }},
          {"greaterEqual", [=](T a, T b, T) { return flag(a >= b); }},
          {"equal", [=](T a, T b, T) { return flag(a == b); }},
          {"select", [](T a, T b, T c) { return a < b ? c : a; }},
          {"zeroUnless", [](T a, T b, T c) { return a < b ? c : T(0); }},
          {"maskAnd", [=](T a, T b, T c) { return flag(a < b && b < c); }},
          {"maskOr", [=](T a, T b, T c) { return flag(a < b || b < c); }},
          {"maskXor", [=](T a, T b, T c) { return flag((a < b) != (b < c)); }},
          {"maskNot", [=](T a, T b, T) { return flag(!(a < b)); }},
          {"maskAndNot", [=](T a, T b, T c) { return flag(a < b && !(b < c)); }}};
}

Reference<float> floatReference() {
  Reference<float> reference = realReference<float>();
  reference["approximateReciprocal"] = [](float a, float, float) { return 1 / a; };
  reference["flipSignBit"] = [](float a, float, float) { return -a; };
  return reference;
}

Reference<uint32_t> uintReference() {
  using U = uint32_t;
  constexpr uint64_t kFactor = 0xD2511F53u;
  return {{"add", [](U a, U b, U) { return a + b; }},
          {"sub", [](U a, U b, U) { return a - b; }},
          {"mul", [](U a, U b, U) { return a * b; }},
          {"and", [](U a, U b, U) { return a & b; }},
          {"or", [](U a, U b, U) { return a | b; }},
          {"xor", [](U a, U b, U) { return a ^ b; }},
          {"xor3", [](U a, U b, U c) { return a ^ b ^ c; }},
          {"shiftLeft5", [](U a, U, U) { return a << 5; }},
          {"shiftRight5", [](U a, U, U) { return a >> 5; }},
          {"equal", [](U a, U b, U) { return U{a == b}; }},
          {"notEqual", [](U a, U b, U) { return U{a != b}; }},
          {"less", [](U a, U b, U) { return U{a < b}; }},
          {"min", [](U a, U b, U) { return std::min(a, b); }},
          {"max", [](U a, U b, U) { return std::max(a, b); }},
          {"reverseBits",
           [](U a, U, U) {
             U reversed = 0;
             for (int i = 0; i < 32; ++i) reversed |= (a >> i & 1) << (31 - i);
             return reversed;
           }},
          {"hasBit7", [](U a, U, U) { return a >> 7 & 1; }},
          {"mulHigh", [](U a, U, U) { return static_cast<U>(a * kFactor >> 32); }},
          {"mulLow", [](U a, U, U) { return static_cast<U>(a * kFactor); }},
          {"splitXor3", [](U a, U b, U) { return a ^ b ^ 0x12345678u; }}};
}

// ---- comparison -----------------------------------------------------------------------------------------------------

// Runs every operation of the table on all inputs and compares each value by `agrees(name, expected, actual, a, b, c)`.
template <class T, class Agrees>
void compareOperations(std::span<const LaneOperation<T>> operations, const Reference<T>& reference, size_t lanes,
                       const std::vector<T>& a, const std::vector<T>& b, const std::vector<T>& c, Agrees&& agrees) {
  ASSERT_EQ(operations.size(), reference.size());
  for (const LaneOperation<T>& operation : operations) {
    SCOPED_TRACE(operation.name);
    ASSERT_TRUE(reference.contains(operation.name));
    const auto& expected = reference.at(operation.name);
    for (size_t i = 0; i + lanes <= a.size(); i += lanes) {
      GuardedColumn<T> out(lanes, lanes, i % 3);
      operation.run(&a[i], &b[i], &c[i], out.data());
      for (size_t lane = 0; lane < lanes; ++lane) {
        const size_t k = i + lane;
        ASSERT_TRUE(agrees(operation.name, expected(a[k], b[k], c[k]), out[lane], a[k], b[k], c[k]))
            << "a " << a[k] << " b " << b[k] << " c " << c[k] << " expected " << expected(a[k], b[k], c[k]) << " got "
            << out[lane];
      }
      ASSERT_TRUE(out.intact());
    }
  }
}

// Equal, or within what the operation's comment allows: a fused multiply-add may round twice without the instruction,
// and the approximate functions promise 2 ulp.
template <class T>
bool realAgrees(Isa isa, const std::string& name, T expected, T actual, T a, T b, T c) {
  const bool fused = isa == Isa::avx2 || isa == Isa::avx512;
  if (!fused && name == "mulAdd") return actual == expected || actual == a * b + c;
  if (!fused && name == "negMulAdd") return actual == expected || actual == c - a * b;
  if (!fused && name == "mulSub") return actual == expected || actual == a * b - c;
  if (name.starts_with("approximate")) {
    return std::abs(actual - expected) <= 2 * std::numeric_limits<T>::epsilon() * std::abs(expected);
  }
  return actual == expected;
}

class LanesTest : public IsaTest {
 protected:
  const LanesEntries& lanes() { return entries<LanesEntries>(); }
};
WAVECREST_TEST_EVERY_ISA(LanesTest);

// ---- tests ----------------------------------------------------------------------------------------------------------

// That --isa does what it says: the code behind each name was compiled for that instruction set, at that width.
TEST_P(LanesTest, runsTheNamedInstructionSet) {
  struct Expected {
    int64_t target;
    const char* name;
    size_t lanes;
  };
  const std::map<Isa, Expected> expected{{Isa::scalar, {HWY_SCALAR, "N_SCALAR", 1}},
                                         {Isa::sse4, {HWY_SSE4, "N_SSE4", 4}},
                                         {Isa::avx2, {HWY_AVX2, "N_AVX2", 8}},
                                         {Isa::avx512, {HWY_AVX3, "N_AVX3", 16}}};
  EXPECT_EQ(lanes().targetBit, expected.at(GetParam()).target);
  EXPECT_STREQ(lanes().target, expected.at(GetParam()).name);
  EXPECT_EQ(lanes().lanes, expected.at(GetParam()).lanes);
}

TEST_P(LanesTest, floatOperationsMatchPlainCode) {
  compareOperations<float>(lanes().floatOperations, floatReference(), lanes().lanes, realInputs<float>(4096, 1),
                           realInputs<float>(4096, 2), realInputs<float>(4096, 3),
                           [&](const char* name, float expected, float actual, float a, float b, float c) {
                             return realAgrees(GetParam(), name, expected, actual, a, b, c);
                           });
}

TEST_P(LanesTest, doubleOperationsMatchPlainCode) {
  compareOperations<double>(lanes().doubleOperations, realReference<double>(), lanes().lanes,
                            realInputs<double>(4096, 1), realInputs<double>(4096, 2), realInputs<double>(4096, 3),
                            [&](const char* name, double expected, double actual, double a, double b, double c) {
                              return realAgrees(GetParam(), name, expected, actual, a, b, c);
                            });
}

TEST_P(LanesTest, uintOperationsMatchPlainCode) {
  compareOperations<uint32_t>(
      lanes().uintOperations, uintReference(), lanes().lanes, uintInputs(4096, 1), uintInputs(4096, 2),
      uintInputs(4096, 3),
      [](const char*, uint32_t expected, uint32_t actual, uint32_t, uint32_t, uint32_t) { return actual == expected; });
}

TEST_P(LanesTest, conversionsMatchPlainCode) {
  const size_t n = lanes().lanes;
  const std::vector<double> doubles = realInputs<double>(1024, 4);
  for (size_t i = 0; i + n <= doubles.size(); i += n) {
    std::vector<float> floats(n), narrowed(n), fromUInt(n);
    std::vector<double> widened(n), larger(n);
    std::vector<uint32_t> uints(n);
    std::vector<int64_t> longs(n);
    lanes().doubleToFloat(&doubles[i], narrowed.data());
    for (size_t k = 0; k < n; ++k) {
      EXPECT_EQ(narrowed[k], static_cast<float>(doubles[i + k]));
      floats[k] = std::min(std::abs(narrowed[k]), 0x1.fffffep30f);
    }
    lanes().floatToDouble(floats.data(), widened.data());
    lanes().floatToUInt(floats.data(), uints.data());
    lanes().uintToFloat(uints.data(), fromUInt.data());
    for (size_t k = 0; k < n; ++k) {
      EXPECT_EQ(widened[k], static_cast<double>(floats[k]));
      EXPECT_EQ(uints[k], static_cast<uint32_t>(floats[k]));
      EXPECT_EQ(fromUInt[k], static_cast<float>(uints[k]));
      larger[k] = doubles[i + k] * 0x1p20;  // from fractions to 2^61
    }
    lanes().doubleToLong(larger.data(), longs.data());
    for (size_t k = 0; k < n; ++k) EXPECT_EQ(longs[k], static_cast<int64_t>(larger[k]));
  }
}

TEST_P(LanesTest, firstLanesSelectsExactlyTheTail) {
  const size_t n = lanes().lanes;
  for (size_t count = 0; count <= 2 * n + 1; ++count) {
    std::vector<uint32_t> flags(n, 7);
    EXPECT_EQ(lanes().firstLanes(count, flags.data()), std::min(count, n));
    for (size_t i = 0; i < n; ++i) EXPECT_EQ(flags[i], i < count ? 1u : 0u) << count;
  }
}

TEST_P(LanesTest, maskQueriesLookAtEveryLane) {
  const size_t n = lanes().lanes;
  std::vector<uint32_t> flags(n, 0);
  EXPECT_EQ(lanes().maskQueries(flags.data()), 4u);
  for (size_t i = 0; i < n; ++i) {
    std::fill(flags.begin(), flags.end(), 0u);
    flags[i] = 1;
    EXPECT_EQ(lanes().maskQueries(flags.data()), n == 1 ? 3u : 1u) << i;
    std::fill(flags.begin(), flags.end(), 1u);
    flags[i] = 0;
    EXPECT_EQ(lanes().maskQueries(flags.data()), n == 1 ? 4u : 1u) << i;
  }
  std::fill(flags.begin(), flags.end(), 1u);
  EXPECT_EQ(lanes().maskQueries(flags.data()), 3u);
}

TEST_P(LanesTest, laneIndexCountsFromItsStart) {
  std::vector<uint32_t> out(lanes().lanes), expected(lanes().lanes);
  std::iota(expected.begin(), expected.end(), 0xfffffffdu);  // wraps
  lanes().laneIndex(0xfffffffdu, out.data());
  EXPECT_EQ(out, expected);
}

}  // namespace
}  // namespace wavecrest
