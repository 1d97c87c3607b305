#include "bench/report/report_metrics.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "metrics/image/srgb.h"
#include "metrics/rmse.h"
#include "metrics/ssim.h"

namespace wavecrest {
namespace {

double measureRmse(const MetricReference& reference, const Image& test) { return rmse(reference.linear, test).rmse; }

double measureRelmse(const MetricReference& reference, const Image& test) {
  return relmse(reference.linear, test).relmse;
}

double measureSsim(const MetricReference& reference, const Image& test) {
  if (std::min(test.width, test.height) < kSsimSmallestSide) return std::numeric_limits<double>::quiet_NaN();
  return PreparedSsim(reference.codes).compare(encodeSrgb8(test)).mean;
}

// Halves a and b of equal variance s^2 differ by 2 s^2 in the square, their mean has variance s^2 / 2: a quarter.
double quarter(double halfAgainstHalf) { return 0.25 * halfAgainstHalf; }
double squareRootOfQuarter(double halfAgainstHalf) { return 0.5 * halfAgainstHalf; }
// SSIM falls from 1 in proportion to the squared error while that is small.
double quarterOfDistanceToOne(double halfAgainstHalf) { return 1 - quarter(1 - halfAgainstHalf); }

}  // namespace

std::span<const MeasuredMetric> measuredMetrics() {
  static const std::array<MeasuredMetric, 3> metrics = {{
      {{.key = "rmse", .name = "RMSE", .explanation = "of linear radiance; lower is better", .idealSlope = -0.5},
       measureRmse,
       squareRootOfQuarter},
      {{.key = "relmse",
        .name = "relMSE",
        .explanation = "squared error over squared radiance; lower is better",
        .idealSlope = -1},
       measureRelmse,
       quarter},
      {{.key = "ssim",
        .name = "SSIM",
        .explanation = "structural similarity of 8-bit sRGB; higher is better",
        .higherIsBetter = true,
        .logarithmic = false,
        .idealSlope = std::nullopt},
       measureSsim,
       quarterOfDistanceToOne},
  }};
  return metrics;
}

MetricReference prepareReference(Image linear) {
  Image8 codes = encodeSrgb8(linear);
  return {.linear = std::move(linear), .codes = std::move(codes)};
}

}  // namespace wavecrest
