// The elementary functions behind plain pointers, for math_test.cpp.
#include "tests/kernels/math_entries.h"

#include "kernels/simd/isa_table.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN
namespace {

// The table's row for an expression of a and b.
#define WAVECREST_FUNCTION(T, NAME, EXPRESSION)                                           \
  MathFunction<T> {                                                                       \
    NAME, [](const T* pa, const T* pb, T* out, size_t count) HWY_ATTR {                   \
      for (size_t i = 0; i < count; i += kLanes) {                                        \
        [[maybe_unused]] const auto a = loadUnaligned(pa + i), b = loadUnaligned(pb + i); \
        storeUnaligned(EXPRESSION, out + i);                                              \
      }                                                                                   \
    }                                                                                     \
  }
#define WAVECREST_FUNCTIONS(T)                                                                              \
  WAVECREST_FUNCTION(T, "sinFirstOctant", sinCosFirstOctant(a).sin),                                        \
      WAVECREST_FUNCTION(T, "cosFirstOctant", sinCosFirstOctant(a).cos),                                    \
      WAVECREST_FUNCTION(T, "sin2Pi", sinCos2Pi(a).sin), WAVECREST_FUNCTION(T, "cos2Pi", sinCos2Pi(a).cos), \
      WAVECREST_FUNCTION(T, "sin", sin(a)), WAVECREST_FUNCTION(T, "cos", cos(a)),                           \
      WAVECREST_FUNCTION(T, "log", log(a)), WAVECREST_FUNCTION(T, "log2", log2(a)),                         \
      WAVECREST_FUNCTION(T, "log1p", log1p(a)), WAVECREST_FUNCTION(T, "exp", exp(a)),                       \
      WAVECREST_FUNCTION(T, "expm1", expm1(a)), WAVECREST_FUNCTION(T, "exp2", exp2(a)),                     \
      WAVECREST_FUNCTION(T, "acos", acos(a)), WAVECREST_FUNCTION(T, "atan", atan(a)),                       \
      WAVECREST_FUNCTION(T, "atan2", atan2(a, b)), WAVECREST_FUNCTION(T, "pow", pow(a, b))

const MathFunction<float> kFloats[] = {WAVECREST_FUNCTIONS(float)};
const MathFunction<double> kDoubles[] = {WAVECREST_FUNCTIONS(double)};

constexpr MathEntries kMathEntries = {.lanes = kLanes, .floats = kFloats, .doubles = kDoubles};
WAVECREST_REGISTER_ENTRIES(MathEntries, kMathEntries);

}  // namespace
WAVECREST_SIMD_END
