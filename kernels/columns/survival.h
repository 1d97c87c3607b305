// What Russian roulette of walks follows (METHODS 1.5), as scatter reads it.
#pragma once

namespace wavecrest {

// The probability of survival is, but for its bounds, a path's throughput times `scale`; or, by albedo, the share of
// its throughput that the latest vertex has left it.
struct SurvivalRule {
  bool byAlbedo = false;
  float scale = 1;
};

}  // namespace wavecrest
