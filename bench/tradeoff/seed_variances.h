// The variance of one image, and ratios of such figures, from renders with several seeds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bench/statistics/medians.h"

namespace wavecrest {

// Image k tells (k - 1) / k |x_k - m|^2, m being the mean of the images before it (Helmert 1876). Each such value has
// the variance as its expectation, and their mean is the sample variance. Those of Gaussian images are independent, and
// an outlier in one image makes one value large. One film is kept, however many images there are.
class SeedVariances {
 public:
  // film: the image of the next seed. The variance is relative to the brightness of the reference (relativeFilmError).
  void add(std::span<const float> film, std::span<const float> reference, size_t width);
  // Of all images but the first, in their order.
  const std::vector<double>& values() const { return values_; }

 private:
  size_t count_ = 0;
  std::vector<float> mean_;  // of all images so far
  std::vector<double> values_;
};

// The median of base[i] / own[i], without those where own[i] is 0. Different i must be independent. The interval is
// that of estimateMedianOfVisits, each ratio a visit: of fewer than kVisitsForInterval ratios their range, which holds
// the true median less often. The range of five does so in 94 of 100 cases.
Estimate medianRatio(std::span<const double> base, std::span<const double> own);

}  // namespace wavecrest
