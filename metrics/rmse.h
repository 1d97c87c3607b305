// Root mean square error, relative mean square error and mean absolute percentage error: the metrics defined on numbers
// as they are read.
//
// A pixel with a NaN or infinity in either image is excluded from every mean. All arithmetic is in double and summed in
// a fixed order, so results do not depend on the number of threads.
#pragma once

#include "metrics/image/image.h"

namespace wavecrest {

// Over all pixels and channels. Both images have three channels and the same size; images without a finite pixel give
// NaN.
double rmse(const Image& reference, const Image& test);

// 8-bit codes as gamma-corrected values in 0..1. Exact where floats are not.
double rmse(const Image8& reference, const Image8& test);

struct RelmseSettings {
  double epsilon = 1e-2;  // keeps black pixels from dominating, as in Rousselle et al. 2012
};

constexpr double kTrimmedFraction = 1e-3;  // part of the pixels, those of greatest error, that `trimmed` leaves out

struct RelmseResult {
  double relmse = 0;   // mean over pixels of mean over channels of (test - reference)^2 / (reference^2 + epsilon)
  double trimmed = 0;  // the same without the worst pixels: robust against fireflies
};

RelmseResult relmse(const Image& reference, const Image& test, const RelmseSettings& settings = {});

constexpr double kMapeEpsilon = 1e-2;  // as in relmse

// Mean over pixels and channels of |test - reference| / (|reference| + epsilon): a part, not per cent.
double mape(const Image& reference, const Image& test);

}  // namespace wavecrest
