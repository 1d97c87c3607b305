// The metrics of a report, in one list: how each is shown and how it is computed. A new metric is one entry here.
#pragma once

#include <optional>
#include <span>

#include "bench/report/report_data.h"
#include "metrics/image/image.h"

namespace wavecrest {

/// A reference with what is worth preparing once for many snapshots.
struct MetricReference {
  Image linear;
  Image8 codes;  ///< 8-bit sRGB
};

struct MeasuredMetric {
  ReportMetric shown;
  double (*measure)(const MetricReference& reference, const Image& test);
  /// The noise of the mean of two halves, from the measure of half against half.
  double (*noiseOfMean)(double halfAgainstHalf);
};

std::span<const MeasuredMetric> measuredMetrics();

MetricReference prepareReference(Image linear);

}  // namespace wavecrest
