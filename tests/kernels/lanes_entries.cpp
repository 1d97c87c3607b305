// Every operation of kernels/simd behind a plain pointer, for lanes_test.cpp and lane_moves_test.cpp.
#include "tests/kernels/lanes_entries.h"

#include <algorithm>

#include "kernels/simd/double_lanes.h"
#include "kernels/simd/interleave.h"
#include "kernels/simd/isa_table.h"
#include "kernels/simd/split_lanes.h"

WAVECREST_SIMD_BEGIN
namespace {

template <class V, class T>
WAVECREST_INLINE void storeFour(const FourColumns<V>& columns, T* out) {
  storeUnaligned(columns.a, out);
  storeUnaligned(columns.b, out + kLanes);
  storeUnaligned(columns.c, out + 2 * kLanes);
  storeUnaligned(columns.d, out + 3 * kLanes);
}

template <class T>
struct Sixteen {
  T numbers[16];
};
template <class T>
WAVECREST_INLINE void storeRecords(const T* columns, bool stream, T* out) {
  RecordBlock<decltype(loadUnaligned(columns))> block;
  const auto column = [columns](size_t i) WAVECREST_LAMBDA { return loadUnaligned(columns + i * kLanes); };
  for (size_t piece = 0; piece < 4; ++piece) {
    block.set(piece, column(4 * piece), column(4 * piece + 1), column(4 * piece + 2), column(4 * piece + 3));
  }
  auto* const records = reinterpret_cast<Sixteen<T>*>(out);
  if (stream) {
    block.stream(records);
  } else {
    block.store(records);
  }
}

// The table's row for an expression of a, b and c.
#define WAVECREST_OPERATION(T, NAME, EXPRESSION)                                                       \
  LaneOperation<T> {                                                                                   \
    NAME, [](const T* pa, const T* pb, const T* pc, T* out) HWY_ATTR {                                 \
      [[maybe_unused]] const auto a = loadUnaligned(pa), b = loadUnaligned(pb), c = loadUnaligned(pc); \
      storeUnaligned(EXPRESSION, out);                                                                 \
    }                                                                                                  \
  }

// Operations that Float and Double share; V is the lane type, T its element.
#define WAVECREST_REAL_OPERATIONS(V, T)                                                                            \
  WAVECREST_OPERATION(T, "add", a + b), WAVECREST_OPERATION(T, "sub", a - b), WAVECREST_OPERATION(T, "mul", a* b), \
      WAVECREST_OPERATION(T, "div", a / b), WAVECREST_OPERATION(T, "negate", -a),                                  \
      WAVECREST_OPERATION(T, "mulAdd", mulAdd(a, b, c)), WAVECREST_OPERATION(T, "negMulAdd", negMulAdd(a, b, c)),  \
      WAVECREST_OPERATION(T, "mulSub", mulSub(a, b, c)), WAVECREST_OPERATION(T, "abs", abs(a)),                    \
      WAVECREST_OPERATION(T, "min", min(a, b)), WAVECREST_OPERATION(T, "max", max(a, b)),                          \
      WAVECREST_OPERATION(T, "sqrt", sqrt(abs(a))), WAVECREST_OPERATION(T, "floor", floor(a)),                     \
      WAVECREST_OPERATION(T, "round", round(a)), WAVECREST_OPERATION(T, "copySign", copySign(a, b)),               \
      WAVECREST_OPERATION(T, "less", select(a < b, V(1), V(0))),                                                   \
      WAVECREST_OPERATION(T, "lessEqual", select(a <= b, V(1), V(0))),                                             \
      WAVECREST_OPERATION(T, "greater", select(a > b, V(1), V(0))),                                                \
      WAVECREST_OPERATION(T, "greaterEqual", select(a >= b, V(1), V(0))),                                          \
      WAVECREST_OPERATION(T, "equal", select(a == b, V(1), V(0))),                                                 \
      WAVECREST_OPERATION(T, "select", select(a < b, c, a)),                                                       \
      WAVECREST_OPERATION(T, "zeroUnless", zeroUnless(a < b, c)),                                                  \
      WAVECREST_OPERATION(T, "maskAnd", zeroUnless((a < b) & (b < c), V(1))),                                      \
      WAVECREST_OPERATION(T, "maskOr", zeroUnless((a < b) | (b < c), V(1))),                                       \
      WAVECREST_OPERATION(T, "maskXor", zeroUnless((a < b) ^ (b < c), V(1))),                                      \
      WAVECREST_OPERATION(T, "maskNot", zeroUnless(!(a < b), V(1))),                                               \
      WAVECREST_OPERATION(T, "maskAndNot", zeroUnless(andNot(a < b, b < c), V(1)))

const LaneOperation<float> kFloatOperations[] = {
    WAVECREST_REAL_OPERATIONS(Float, float),
    WAVECREST_OPERATION(float, "approximateReciprocal", approximateReciprocal(a)),
    WAVECREST_OPERATION(float, "flipSignBit", fromBits(bits(a) ^ UInt(0x80000000u))),
};

const LaneOperation<double> kDoubleOperations[] = {WAVECREST_REAL_OPERATIONS(Double, double)};

const LaneOperation<uint32_t> kUIntOperations[] = {
    WAVECREST_OPERATION(uint32_t, "add", a + b),
    WAVECREST_OPERATION(uint32_t, "sub", a - b),
    WAVECREST_OPERATION(uint32_t, "mul", a* b),
    WAVECREST_OPERATION(uint32_t, "and", a& b),
    WAVECREST_OPERATION(uint32_t, "or", a | b),
    WAVECREST_OPERATION(uint32_t, "xor", a ^ b),
    WAVECREST_OPERATION(uint32_t, "xor3", xor3(a, b, c)),
    WAVECREST_OPERATION(uint32_t, "shiftLeft5", shiftLeft<5>(a)),
    WAVECREST_OPERATION(uint32_t, "shiftRight5", shiftRight<5>(a)),
    WAVECREST_OPERATION(uint32_t, "equal", select(a == b, UInt(1u), UInt(0u))),
    WAVECREST_OPERATION(uint32_t, "notEqual", select(a != b, UInt(1u), UInt(0u))),
    WAVECREST_OPERATION(uint32_t, "less", select(a < b, UInt(1u), UInt(0u))),
    WAVECREST_OPERATION(uint32_t, "min", min(a, b)),
    WAVECREST_OPERATION(uint32_t, "max", max(a, b)),
    WAVECREST_OPERATION(uint32_t, "reverseBits", reverseBits(a)),
    WAVECREST_OPERATION(uint32_t, "hasBit7", select(hasBit(a, 7), UInt(1u), UInt(0u))),
    WAVECREST_OPERATION(uint32_t, "mulHigh", join(mulHighLow(split(a), 0xD2511F53u).high)),
    WAVECREST_OPERATION(uint32_t, "mulLow", join(mulHighLow(split(a), 0xD2511F53u).low)),
    WAVECREST_OPERATION(uint32_t, "splitXor3", join(xor3(split(a), split(b), 0x12345678u))),
};

Mask maskFromFlags(const uint32_t* flags) { return loadUnaligned(flags) != UInt(0u); }

constexpr LanesEntries kLanesEntries = {
    .target = HWY_STR(HWY_NAMESPACE),
    .targetBit = HWY_TARGET,
    .lanes = kLanes,
    .floatOperations = kFloatOperations,
    .doubleOperations = kDoubleOperations,
    .uintOperations = kUIntOperations,
    .floatToUInt = [](const float* in, uint32_t* out) HWY_ATTR { storeUnaligned(toUInt(loadUnaligned(in)), out); },
    .uintToFloat = [](const uint32_t* in, float* out) HWY_ATTR { storeUnaligned(toFloat(loadUnaligned(in)), out); },
    .floatToDouble = [](const float* in, double* out) HWY_ATTR { storeUnaligned(toDouble(loadUnaligned(in)), out); },
    .doubleToFloat = [](const double* in, float* out) HWY_ATTR { storeUnaligned(toFloat(loadUnaligned(in)), out); },
    .doubleToLong =
        [](const double* in, int64_t* out) HWY_ATTR {
          HWY_ALIGN int64_t longs[kLanes];
          storeTruncated(loadUnaligned(in), longs);
          std::copy(longs, longs + kLanes, out);
        },
    .gather =
        [](const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index, float* floatsOut,
           double* doublesOut, uint32_t* uintsOut) HWY_ATTR {
          const UInt i = loadUnaligned(index);
          storeUnaligned(gather(floats, i), floatsOut);
          storeUnaligned(gather(doubles, i), doublesOut);
          storeUnaligned(gather(uints, i), uintsOut);
        },
    .gatherFour =
        [](const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index, float* floatsOut,
           double* doublesOut, uint32_t* uintsOut) HWY_ATTR {
          const UInt i = loadUnaligned(index);
          storeFour(gatherFour(floats, i), floatsOut);
          storeFour(gatherFour(doubles, i), doublesOut);
          storeFour(gatherFour(uints, i), uintsOut);
        },
    .loadFour =
        [](const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index, float* floatsOut,
           double* doublesOut, uint32_t* uintsOut) HWY_ATTR {
          storeFour(loadFour([&](size_t k) WAVECREST_LAMBDA { return floats + index[k]; }), floatsOut);
          storeFour(loadFour([&](size_t k) WAVECREST_LAMBDA { return doubles + index[k]; }), doublesOut);
          storeFour(loadFour([&](size_t k) WAVECREST_LAMBDA { return uints + index[k]; }), uintsOut);
        },
    .storeRecords =
        [](const float* floats, const double* doubles, bool stream, float* floatsOut, double* doublesOut) HWY_ATTR {
          storeRecords(floats, stream, floatsOut);
          storeRecords(doubles, stream, doublesOut);
          flushStream();
        },
    .compress =
        [](const uint32_t* flags, const float* floats, const double* doubles, const uint32_t* uints, float* floatsOut,
           double* doublesOut, uint32_t* uintsOut) HWY_ATTR {
          const Mask m = maskFromFlags(flags);
          storeUnaligned(compress(loadUnaligned(floats), m), floatsOut);
          storeUnaligned(compress(loadUnaligned(doubles), m), doublesOut);
          storeUnaligned(compress(loadUnaligned(uints), m), uintsOut);
          return countTrue(m);
        },
    .inOrder =
        [](const uint32_t* order, const float* floats, const double* doubles, const uint32_t* uints, float* floatsOut,
           double* doublesOut, uint32_t* uintsOut) HWY_ATTR {
          const UInt lanes = loadUnaligned(order);
          storeUnaligned(inOrder(loadUnaligned(floats), lanes), floatsOut);
          storeUnaligned(inOrder(loadUnaligned(doubles), lanes), doublesOut);
          storeUnaligned(inOrder(loadUnaligned(uints), lanes), uintsOut);
        },
    .splitOrder = [](const uint32_t* flags, const uint32_t* rest, uint32_t* out)
                      HWY_ATTR { storeUnaligned(splitOrder(maskFromFlags(flags), maskFromFlags(rest)), out); },
    .firstLanes =
        [](size_t n, uint32_t* out) HWY_ATTR {
          const Mask m = firstLanes(n);
          storeUnaligned(select(m, UInt(1u), UInt(0u)), out);
          return static_cast<uint32_t>(countTrue(m));
        },
    .maskQueries =
        [](const uint32_t* flags) HWY_ATTR {
          const Mask m = maskFromFlags(flags);
          const bool nothing = none(m) && !any(m & !noLanes() & m);
          return (any(m) ? 1u : 0u) | (all(m) ? 2u : 0u) | (nothing ? 4u : 0u);
        },
    .laneIndex = [](uint32_t start, uint32_t* out) HWY_ATTR { storeUnaligned(laneIndex(start), out); },
};

WAVECREST_REGISTER_ENTRIES(LanesEntries, kLanesEntries);

}  // namespace
WAVECREST_SIMD_END
