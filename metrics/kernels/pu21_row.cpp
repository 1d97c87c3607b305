// pu21Row: see metrics/kernels/pu21_row.h for what goes in and out.
#include "metrics/kernels/pu21_row.h"

#include "kernels/simd/lanes.h"
#include "metrics/kernels/lane_math.h"

WAVECREST_SIMD_BEGIN

namespace {

// Parameters p1 to p7 of the variant "banding_glare", the default of gfxdisp/pu21.
constexpr float kP1 = 0.353487901f, kP2 = 0.3734658629f, kP3 = 8.277049286e-05f, kP4 = 0.9062562627f,
                kP5 = 0.09150303166f, kP6 = 0.9099517204f, kP7 = 596.3148142f;
constexpr float kLeastLuminance = 0.005f, kGreatestLuminance = 10000.0f;  // cd/m2

}  // namespace

void pu21Row(const Pu21Row& row) {
  for (size_t x = 0; x < row.count; x += kLanes) {
    const Float light = min(max(loadUnaligned(row.light + x), Float(kLeastLuminance)), Float(kGreatestLuminance));
    const Float power = pow(light, Float(kP4));
    const Float ratio = mulAdd(Float(kP2), power, Float(kP1)) / mulAdd(Float(kP3), power, Float(1.0f));
    storeUnaligned(max(Float(kP7) * (pow(ratio, Float(kP5)) - Float(kP6)), Float(0.0f)), row.out + x);
  }
}

WAVECREST_SIMD_END
