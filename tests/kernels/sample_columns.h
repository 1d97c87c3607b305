// The sampler's numbers as columns, for the tests of both samplers.
#pragma once

#include <array>
#include <vector>

#include "kernels/simd/isa_table.h"
#include "tests/kernels/sampler_entries.h"

namespace wavecrest {

using SampleColumns = std::array<std::vector<float>, 4>;

// Four columns over paths [0, count) of one iteration.
inline SampleColumns drawPaths(const SamplerSettings& sampler, size_t count, uint32_t block = 0,
                               Stream stream = Stream::camera, uint32_t firstPath = 0, Isa isa = bestIsa()) {
  const SamplerEntries& entries = IsaTable<SamplerEntries>::of(isa);
  SampleColumns columns;
  for (auto& column : columns) column.resize(count + entries.lanes);
  entries.fill(sampler, firstPath, block, stream, count,
               {columns[0].data(), columns[1].data(), columns[2].data(), columns[3].data()});
  for (auto& column : columns) column.resize(count);
  return columns;
}

// Four columns over iterations [firstIteration, firstIteration + count) of one path.
inline SampleColumns drawIterations(SamplerSettings sampler, size_t count, uint32_t path, uint32_t block = 0,
                                    Stream stream = Stream::camera, uint32_t firstIteration = 0) {
  SampleColumns columns;
  for (size_t i = 0; i < count; ++i) {
    sampler.iteration = firstIteration + static_cast<uint32_t>(i);
    const SampleColumns one = drawPaths(sampler, 1, block, stream, path);
    for (size_t d = 0; d < 4; ++d) columns[d].push_back(one[d][0]);
  }
  return columns;
}

}  // namespace wavecrest
