// Limits on the noise of a reference, below which scores tell images apart and not the reference's noise. A noise floor
// is what an image without error scores against the noisy reference; references with other floors are other references.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wavecrest/results.h"

namespace wavecrest {

// An image without any error has at least this SSIM, and at most this share of the best run's relMSE.
constexpr double kLeastSsimFloor = 0.995, kMostRelmseShare = 0.1;

// The floors that are not met, each as a sentence's part, "SSIM of a perfect image is 0.901, below 0.995". bestRelmse:
// of the best run that is measured against the reference, where one is known.
std::vector<std::string> unmetFloors(const MetricValues& noiseFloors, std::optional<double> bestRelmse = {});

// Whether the noise floors of two references are equal, so that they may be the same reference. NaN equals NaN.
bool sameFloors(const MetricValues& a, const MetricValues& b);

}  // namespace wavecrest
