// What a reference's own noise does to the metrics measured against it.
//
// A reference is the mean M of two independent halves A and B. The error of M has the variance of (A - B) / 2, and
// A = M + (A - B) / 2: so comparing a half with the mean shows as much noise as M itself carries, without assuming how
// a metric grows with noise. A perfect image scores this floor against M, in the mean, by any metric of differences. By
// SSIM and Q_MOS, whose masking and variances see the noise that a half shares with M, it scores somewhat worse: the
// floor is good where it is near the best score.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "metrics/metric_list.h"

namespace wavecrest {

struct NoiseFloor {
  std::string_view metric;
  double score = 0;  // main score, the mean of both halves against the reference
};

// Halves of the same size in linear light. Metrics whose smallest size exceeds the image's are left out.
std::vector<NoiseFloor> noiseFloors(const Image& halfA, const Image& halfB, std::span<const Metric> metrics);

}  // namespace wavecrest
