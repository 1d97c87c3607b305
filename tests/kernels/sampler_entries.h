// Entry points of sampler_entries.cpp: the random numbers of a range of paths, Philox itself, and thresholds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/sampling/sampler.h"

namespace wavecrest {

struct SamplerEntries {
  size_t lanes;
  // Numbers of paths [firstPath, firstPath + count), one column per number. Columns are padded to the lane count.
  void (*fill)(const SamplerSettings& sampler, uint32_t firstPath, uint32_t block, Stream stream, size_t count,
               const std::array<float*, 4>& out);
  // One block of Philox4x32-10; all lanes compute the same. perLane chooses which counter words are lanes and which are
  // plain integers: none but the first (as in uniform4), or all of them.
  std::array<uint32_t, 4> (*philox10)(const std::array<uint32_t, 4>& counter, uint64_t key, bool perLane);
  // thresholdOf each pair of words. All three are padded to the lane count.
  void (*thresholds)(const uint32_t* upper, const uint32_t* lower, size_t count, float* out);
};

}  // namespace wavecrest
