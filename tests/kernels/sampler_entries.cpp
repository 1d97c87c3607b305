// The random numbers behind plain pointers, for sampler_test.cpp.
#include "tests/kernels/sampler_entries.h"

#include "kernels/sampling/random_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

void fill(const SamplerSettings& sampler, uint32_t firstPath, uint32_t block, Stream stream, size_t count,
          const std::array<float*, 4>& out) {
  for (size_t i = 0; i < count; i += kLanes) {
    const UInt path = laneIndex(firstPath + static_cast<uint32_t>(i));
    const Uniform4 u = uniform4(sampler, path, block, stream);
    storeUnaligned(u.a, out[0] + i);
    storeUnaligned(u.b, out[1] + i);
    storeUnaligned(u.c, out[2] + i);
    storeUnaligned(u.d, out[3] + i);
  }
}

// The last lane of each word: the one that a mistake in joining the lanes would get wrong.
template <class Block>
std::array<uint32_t, 4> lastLanes(const Block& block) {
  std::array<uint32_t, 4> words{};
  const SplitUInt lanes[] = {block.a, block.b, block.c, block.d};
  for (size_t i = 0; i < 4; ++i) {
    uint32_t all[kLanes];
    storeUnaligned(join(lanes[i]), all);
    words[i] = all[kLanes - 1];
  }
  return words;
}

std::array<uint32_t, 4> philox10(const std::array<uint32_t, 4>& x, uint64_t key, bool perLane) {
  const SplitUInt a = split(UInt(x[0])), b = split(UInt(x[1])), c = split(UInt(x[2])), d = split(UInt(x[3]));
  if (perLane) return lastLanes(philox4x32<10>(PhiloxBlock{a, b, c, d}, philoxKey(key)));
  return lastLanes(philox4x32<10>(PhiloxBlock{a, x[1], x[2], x[3]}, philoxKey(key)));
}

void thresholds(const uint32_t* upper, const uint32_t* lower, size_t count, float* out) {
  for (size_t i = 0; i < count; i += kLanes) {
    storeUnaligned(thresholdOf(loadUnaligned(upper + i), loadUnaligned(lower + i)), out + i);
  }
}

constexpr SamplerEntries kSamplerEntries = {
    .lanes = kLanes, .fill = fill, .philox10 = philox10, .thresholds = thresholds};
WAVECREST_REGISTER_ENTRIES(SamplerEntries, kSamplerEntries);

}  // namespace
WAVECREST_SIMD_END
