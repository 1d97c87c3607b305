// When an image will be good enough, from a short pilot: its noise shrinks with a power of time, mostly the square
// root, the bias of merging with another.
//
// in: a reference, and four independent whole images of the same render time. The differences of the four are samples
// of the noise of their mean, with its fireflies and its places. What a method leaves out or blurs is bias: what is
// left between its mean and the reference, block by block of 8 x 8 pixels, where it is significant. The predicted image
// at a later time is reference + bias + shrunken noise, and is compared with the reference as any image is.
//
// Rare bright samples spread: few pixels far off become many that are off a little, and SSIM, which a pixel can spoil
// once only, may fall behind the power of time. By how much at most is measured on the pilot, between two parts and
// four; the end of the interval has it.
//
// The reference has noise of its own. Noise looks like detail, and next to detail SSIM forgives errors, so a noisy
// reference makes predicted times too short; a smoothed one makes them too long. The truth is between the two.
#pragma once

#include <array>
#include <optional>

#include "bench/statistics/medians.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

struct Pilot {
  std::array<Image, 4> parts;  // independent, of equal render time
  double seconds = 0;          // of all four together, without what a long render does once
  double onceSeconds = 0;      // of that, in one render
  // Whether the method may have a bias. One that samples all paths of the scene has none: what its mean lacks is noise.
  bool biased = false;
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

// Three independent samples of the noise of the mean of four images.
using NoiseSamples = std::array<Image, 3>;

// The reference that pilots are compared with: the mean of four images, and three readings of it.
struct PilotReference {
  explicit PilotReference(const Pilot& pilot);

  Image mean;
  NoiseSamples noises;
  PreparedReference noisy;   // as it is
  PreparedReference likely;  // with as much local contrast as the truth has: the noise's share of the variance is taken
  PreparedReference smooth;  // out, once in the root and once in full (Wiener's filter)
  double ssim = 0;           // of the mean with noise added, against the mean: what can be judged
};

struct Prediction {
  double ssimNow = 0;             // of the mean of the pilot's images
  double ssimLimit = 0;           // after kLongestSeconds: what bias leaves
  std::optional<double> seconds;  // until the target; nothing where that is not within kLongestSeconds
  // Of seconds: by three samples of the noise, by the readings of the reference, the late one with noise that spreads,
  // by what merging may blur unseen, and by how far the pilot is from the time predicted. high is infinite where one of
  // them does not get to the target.
  Interval interval;
};
constexpr double kLongestSeconds = 1e7;

Prediction predict(const PilotReference& reference, const Pilot& pilot, double targetSsim);

}  // namespace wavecrest
