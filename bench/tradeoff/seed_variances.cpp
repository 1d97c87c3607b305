#include "bench/tradeoff/seed_variances.h"

#include "bench/until/film_error.h"

namespace wavecrest {

void SeedVariances::add(std::span<const float> film, std::span<const float> reference, size_t width) {
  ++count_;
  mean_.resize(film.size(), 0.0f);
  if (count_ > 1) {
    // The difference is added to the reference, whose brightness weighs the errors of all settings.
    std::vector<float> moved(reference.begin(), reference.end());
    for (size_t i = 0; i < moved.size(); ++i) moved[i] += film[i] - mean_[i];
    const double error = relativeFilmError(reference, moved, width);
    values_.push_back(static_cast<double>(count_ - 1) / static_cast<double>(count_) * error * error);
  }
  for (size_t i = 0; i < mean_.size(); ++i) mean_[i] += (film[i] - mean_[i]) / static_cast<float>(count_);
}

Estimate medianRatio(std::span<const double> base, std::span<const double> own) {
  // Every ratio is a visit of its own.
  std::vector<std::vector<double>> ratios;
  for (size_t i = 0; i < own.size(); ++i) {
    if (own[i] > 0) ratios.push_back({base[i] / own[i]});
  }
  return ratios.empty() ? Estimate{} : estimateMedianOfVisits(ratios);
}

}  // namespace wavecrest
