// Samples of an environment behind a plain pointer, for sky_sampling_test.cpp.
#include "tests/kernels/sky_sampling_entries.h"

#include "kernels/endpoints/light_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

void sampleDirections(const EnvironmentView& map, const std::array<const float*, 4>& numbers,
                      const std::array<float*, 3>& direction, size_t count) {
  for (size_t i = 0; i < count; i += kLanes) {
    const Uniform4 u{loadUnaligned(numbers[0] + i), loadUnaligned(numbers[1] + i), loadUnaligned(numbers[2] + i),
                     loadUnaligned(numbers[3] + i)};
    const Vec3<Float> sampled = sampleMap<Float>(map, u);
    storeUnaligned(sampled.x, direction[0] + i);
    storeUnaligned(sampled.y, direction[1] + i);
    storeUnaligned(sampled.z, direction[2] + i);
  }
}

constexpr SkySamplingEntries kSkySamplingEntries = {.sample = sampleDirections};
WAVECREST_REGISTER_ENTRIES(SkySamplingEntries, kSkySamplingEntries);

}  // namespace
WAVECREST_SIMD_END
