// The lane types against plain C++, one value at a time, on every instruction set.
#include <hwy/highway.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "tests/kernels/isa_test.h"
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
  reference["approximateReciprocalSqrt"] = [](float a, float, float) { return 1 / std::sqrt(std::abs(a)); };
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

// ---- inputs ---------------------------------------------------------------------------------------------------------

// Values around the ones that rounding, signs and comparisons stumble over, then random ones of all sizes.
template <class T>
std::vector<T> realInputs(size_t count, unsigned seed) {
  std::vector<T> values{T(0.5), T(-0.5), T(1.5), T(-2.5), T(2), T(-2),        T(0.49999997),
                        T(7),   T(-7),   T(1),   T(1),    T(3), T(1048575.5), T(-1048576.5)};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<T> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-40, 40);
  while (values.size() < count) values.push_back(std::ldexp(mantissa(random), exponent(random)));
  std::shuffle(values.begin(), values.end(), random);
  return values;
}

std::vector<uint32_t> uintInputs(size_t count, unsigned seed) {
  std::vector<uint32_t> values{0, 0, 1, 1, 2, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff, 0xffffffff};
  std::mt19937 random(seed);
  while (values.size() < count) values.push_back(static_cast<uint32_t>(random()));
  std::shuffle(values.begin(), values.end(), random);
  return values;
}

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

TEST_P(LanesTest, gatherReadsTheIndexedValues) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(1000, 5);
  const std::vector<double> doubles = realInputs<double>(1000, 6);
  const std::vector<uint32_t> uints = uintInputs(1000, 7);
  std::vector<uint32_t> index(n);
  for (size_t i = 0; i < n; ++i) index[i] = static_cast<uint32_t>((i * 7919 + 13) % 1000);
  GuardedColumn<float> floatsOut(n);
  GuardedColumn<double> doublesOut(n);
  GuardedColumn<uint32_t> uintsOut(n);
  lanes().gather(floats.data(), doubles.data(), uints.data(), index.data(), floatsOut.data(), doublesOut.data(),
                 uintsOut.data());
  for (size_t i = 0; i < n; ++i) {
    EXPECT_EQ(floatsOut[i], floats[index[i]]);
    EXPECT_EQ(doublesOut[i], doubles[index[i]]);
    EXPECT_EQ(uintsOut[i], uints[index[i]]);
  }
  EXPECT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
}

TEST_P(LanesTest, rowsAreReadIntoColumns) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(1003, 5);
  const std::vector<double> doubles = realInputs<double>(1003, 6);
  const std::vector<uint32_t> uints = uintInputs(1003, 7);
  std::vector<uint32_t> index(n);
  for (size_t i = 0; i < n; ++i) index[i] = static_cast<uint32_t>((i * 7919 + 13) % 1000);
  for (const auto read : {lanes().gatherFour, lanes().loadFour}) {
    GuardedColumn<float> floatsOut(4 * n);
    GuardedColumn<double> doublesOut(4 * n);
    GuardedColumn<uint32_t> uintsOut(4 * n);
    read(floats.data(), doubles.data(), uints.data(), index.data(), floatsOut.data(), doublesOut.data(),
         uintsOut.data());
    for (size_t column = 0; column < 4; ++column) {
      for (size_t i = 0; i < n; ++i) {
        EXPECT_EQ(floatsOut[column * n + i], floats[index[i] + column]);
        EXPECT_EQ(doublesOut[column * n + i], doubles[index[i] + column]);
        EXPECT_EQ(uintsOut[column * n + i], uints[index[i] + column]);
      }
    }
    EXPECT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LanesTest, storeRecordsTransposesSixteenColumns) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16 * n, 5);
  const std::vector<double> doubles = realInputs<double>(16 * n, 6);
  for (const bool stream : {false, true}) {
    GuardedColumn<float> floatsOut(16 * n);
    GuardedColumn<double> doublesOut(16 * n);
    lanes().storeRecords(floats.data(), doubles.data(), stream, floatsOut.data(), doublesOut.data());
    for (size_t lane = 0; lane < n; ++lane) {
      for (size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(floatsOut[16 * lane + i], floats[i * n + lane]);
        EXPECT_EQ(doublesOut[16 * lane + i], doubles[i * n + lane]);
      }
    }
    EXPECT_TRUE(floatsOut.intact() && doublesOut.intact());
  }
}

TEST_P(LanesTest, storeScatteredKeepsTheLastOfEqualIndices) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(64, 5);
  const std::vector<double> doubles = realInputs<double>(64, 6);
  std::vector<uint32_t> index(n);
  for (size_t i = 0; i < n; ++i) index[i] = static_cast<uint32_t>(i / 2 * 3);  // lanes 2k and 2k + 1 collide
  std::vector<float> floatsOut(64, -1.0f), floatsExpected(64, -1.0f);
  std::vector<double> doublesOut(64, -1.0), doublesExpected(64, -1.0);
  lanes().storeScattered(floats.data(), doubles.data(), index.data(), floatsOut.data(), doublesOut.data());
  for (size_t i = 0; i < n; ++i) {
    floatsExpected[index[i]] = floats[i];
    doublesExpected[index[i]] = doubles[i];
  }
  EXPECT_EQ(floatsOut, floatsExpected);
  EXPECT_EQ(doublesOut, doublesExpected);
}

TEST_P(LanesTest, compressMovesTheChosenLanesToTheFrontInOrder) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16, 8);
  const std::vector<double> doubles = realInputs<double>(16, 9);
  const std::vector<uint32_t> uints = uintInputs(16, 10);
  const uint32_t masks = n == 16 ? 4096 : 1u << n;  // all masks, or a sample of the 65,536
  for (uint32_t m = 0; m < masks; ++m) {
    const uint32_t mask = n == 16 ? m * 16 + (m >> 8) : m;
    std::vector<uint32_t> flags(n);
    for (size_t i = 0; i < n; ++i) flags[i] = mask >> i & 1;
    GuardedColumn<float> floatsOut(n);
    GuardedColumn<double> doublesOut(n);
    GuardedColumn<uint32_t> uintsOut(n);
    const size_t kept = lanes().compress(flags.data(), floats.data(), doubles.data(), uints.data(), floatsOut.data(),
                                         doublesOut.data(), uintsOut.data());
    size_t next = 0;
    for (size_t i = 0; i < n; ++i) {
      if (flags[i] == 0) continue;
      ASSERT_EQ(floatsOut[next], floats[i]) << "mask " << mask;
      ASSERT_EQ(doublesOut[next], doubles[i]) << "mask " << mask;
      ASSERT_EQ(uintsOut[next], uints[i]) << "mask " << mask;
      ++next;
    }
    ASSERT_EQ(kept, next);
    ASSERT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LanesTest, inOrderTakesEachLaneFromWhereItIsTold) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16, 8);
  const std::vector<double> doubles = realInputs<double>(16, 9);
  const std::vector<uint32_t> uints = uintInputs(16, 10);
  std::mt19937 random(1);
  for (int k = 0; k < 100; ++k) {
    std::vector<uint32_t> order(n);
    for (uint32_t& lane : order) lane = static_cast<uint32_t>(random() % n);
    GuardedColumn<float> floatsOut(n);
    GuardedColumn<double> doublesOut(n);
    GuardedColumn<uint32_t> uintsOut(n);
    lanes().inOrder(order.data(), floats.data(), doubles.data(), uints.data(), floatsOut.data(), doublesOut.data(),
                    uintsOut.data());
    for (size_t i = 0; i < n; ++i) {
      ASSERT_EQ(floatsOut[i], floats[order[i]]);
      ASSERT_EQ(doublesOut[i], doubles[order[i]]);
      ASSERT_EQ(uintsOut[i], uints[order[i]]);
    }
    ASSERT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LanesTest, splitOrderPutsSomeInFrontAndTheRestAtTheEndBackwards) {
  const size_t n = lanes().lanes;
  std::mt19937 random(2);
  for (int k = 0; k < 5000; ++k) {
    std::vector<uint32_t> flags(n), rest(n), front, back, order(n);
    const uint32_t odds = static_cast<uint32_t>(random() % 4);  // also all in front, and all at the end
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t kind = odds == 0 ? 0 : odds == 1 ? 1 : static_cast<uint32_t>(random() % 3);
      flags[i] = kind == 0 ? 1 : 0;
      rest[i] = kind == 1 ? 1 : 0;
      if (kind == 0) front.push_back(i);
      if (kind == 1) back.push_back(i);
    }
    lanes().splitOrder(flags.data(), rest.data(), order.data());
    for (size_t i = 0; i < front.size(); ++i) ASSERT_EQ(order[i], front[i]);
    for (size_t i = 0; i < back.size(); ++i) ASSERT_EQ(order[n - 1 - i], back[i]);
    for (const uint32_t lane : order) ASSERT_LT(lane, n);
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
