// Error taken apart: what of a method's mean square error is bias, and what is noise that more time removes.
//
// Images of independent seeds share the bias but not the noise, and the reference's halves share neither: products of
// errors of different seeds against different halves are unbiased estimates of the squared bias (METHODS 8.4). The
// variance is the difference, mean square error - bias^2.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/campaign/reference_file.h"
#include "wavecrest/results.h"

namespace wavecrest {

struct ErrorParts {
  double meanSquareError = 0, variance = 0, biasSquared = 0;
};

// At least two images of the reference's size. Samples that are not finite anywhere are left out. Of a reference
// without halves the noise stays in mean square error and squared bias.
ErrorParts errorParts(std::span<const Image> images, const Reference& reference);

// The mean of (T - A)(T - B) over samples: the mean square error of an image without the noise of the reference,
// negative where noise decides. Nothing for a reference without halves.
std::optional<double> unbiasedMse(const Image& image, const Reference& reference);

// For every snapshot whose image is there for all these runs of one scene and method; empty for fewer than two runs.
std::vector<BiasRecord> measureBiases(std::span<const RunRecord* const> runs, const Reference& reference);

}  // namespace wavecrest
