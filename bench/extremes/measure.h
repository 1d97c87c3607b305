// Renders from independent seeds, as means of whole images: the figures that rows of a sweep compare.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/session/session.h"

namespace wavecrest {

// What a render has lost, summed over its seeds.
struct Losses {
  uint64_t nonFinite = 0, closePairs = 0, cutPaths = 0;
};

// The mean of all values of an image, for each seed. Two sets of the same seeds can be compared in pairs: the same
// random numbers then meet both scenes, and what differs between them is the scenes' difference, not noise.
struct SeedValues {
  std::vector<double> means;
  Losses losses;
};

// size: samples of a pixel. Throws what Session::create throws.
SeedValues measureSeeds(const Scene& scene, RenderSettings settings, uint64_t samples, size_t seeds);

// Mean over the seeds and its standard error.
struct SeedEstimate {
  double mean = 0, error = 0;
};
SeedEstimate seedEstimateOf(const std::vector<double>& values);

// a / scale - b, seed by seed.
std::vector<double> differences(const SeedValues& a, double scale, const SeedValues& b);

}  // namespace wavecrest
