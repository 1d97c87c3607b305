// When an image will be good enough, from a short pilot: its noise shrinks with a power of time, mostly the square
// root, its bias does not or hardly does.
//
// in: a reference, and four independent images of the same render time. The differences of the four are samples of the
// noise of their mean, with its fireflies and its places. What is left between mean and reference, block by block of
// 8 x 8 pixels, is bias where it is significant. The predicted image at a later time is reference + bias + shrunken
// noise, and is compared with the reference as any image is.
#pragma once

#include <array>
#include <optional>

#include "bench/statistics/medians.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

struct Pilot {
  std::array<Image, 4> parts;  // independent, of equal render time
  double seconds = 0;          // of all four together
  // Bias falls with time to this power: 0 for what a method never finds, above for merging (biasDecay).
  double biasExponent = 0;
  // Noise falls with time to this power: more slowly where all of it is that of merges (noiseDecay).
  double noiseExponent = 0.5;
};

// The bias of merging is proportional to the squared radius, r_i^2 = r_1^2 i^(alpha - 1), so it falls with time to the
// power 1 - alpha (METHODS 5).
inline double biasDecay(double radiusAlpha) { return 1 - radiusAlpha; }
// The variance of an iteration's merges goes as 1 / r_i^2, so that of the mean of i falls as i^-alpha (METHODS 5).
inline double noiseDecay(double radiusAlpha) { return 0.5 * radiusAlpha; }

struct Prediction {
  double ssimNow = 0;             // of the mean of the pilot's images
  double ssimLimit = 0;           // after kLongestSeconds: what bias leaves
  std::optional<double> seconds;  // until the target; nothing where that is not within kLongestSeconds
  Interval interval;              // of seconds, from three independent samples of the noise
};
constexpr double kLongestSeconds = 1e7;

// referenceNoise: half the difference of two halves of the reference, as its own noise.
Prediction predict(const PreparedReference& reference, const Image& referenceNoise, const Pilot& pilot,
                   double targetSsim);

}  // namespace wavecrest
