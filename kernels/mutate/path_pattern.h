// Which perturbations suit a path: decided by its delta lobes alone (METHODS 7.6).
#pragma once

#include <cstddef>
#include <cstdint>

namespace wavecrest {

struct PathPattern {
  // A perturbation from the eye makes rows eyeEnd .. k anew and joins them with the row before; 0: it ends by meeting
  // the light.
  uint32_t eyeEnd = 0;
  // Whether it goes through a vertex that is no delta in front of one that is: multi-chain, else lens.
  bool multiChain = false;
  // A caustic perturbation makes rows causticStart .. k anew; 0: none suits.
  uint32_t causticStart = 0;
};

// Event of row i: events[i * stride], 0 where no delta lobe joins its edges; rows 1 .. edges - 1 count. lightTurns:
// whether rays leave the light in more than one direction from x_0.
inline PathPattern pathPattern(const uint32_t* events, size_t stride, uint32_t edges, bool lightTurns) {
  const auto specular = [&](uint32_t row) { return events[row * stride] != 0; };
  PathPattern out;
  for (uint32_t row = edges - 1; row >= 1; --row) {
    if (specular(row)) continue;
    if (row == 1 || !specular(row - 1)) {
      out.eyeEnd = row;
      break;
    }
    out.multiChain = true;
  }
  if (edges < 2 || specular(edges - 1)) return out;
  uint32_t start = edges - 2;
  while (start >= 1 && specular(start)) --start;
  if (start >= 1 || lightTurns) out.causticStart = start + 1;
  return out;
}

}  // namespace wavecrest
