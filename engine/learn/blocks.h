// Blocks of a render that learns: iterations 0, 1, 2-3, 4-7, 8-15, ... counted from the session's first. Each block
// has as many as all before it together, so the last one has half of all samples, and what it knows decides.
//
// Within a block waves run ahead of each other freely; no wave begins the next block before all have ended this one,
// and its fold has turned what they gathered into what the next block reads.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace wavecrest {

// Of the block that has this iteration: its first one, and the first one behind it.
constexpr uint64_t beginOfBlock(uint64_t iteration) { return iteration == 0 ? 0 : std::bit_floor(iteration); }
constexpr uint64_t endOfBlock(uint64_t iteration) { return std::bit_ceil(iteration + 1); }

// The first iterations of each block gather, up to `most` of them: what is learned from so many is good enough, and
// the others render without that cost.
constexpr bool gathers(uint64_t iteration, uint64_t most) { return iteration - beginOfBlock(iteration) < most; }

// The first iteration behind this one where the block or its gathering ends: a wave of several iterations does not go
// past it.
constexpr uint64_t endOfRun(uint64_t iteration, uint64_t most) {
  const uint64_t begin = beginOfBlock(iteration), end = endOfBlock(iteration);
  return gathers(iteration, most) ? begin + std::min(most, end - begin) : end;
}

}  // namespace wavecrest
