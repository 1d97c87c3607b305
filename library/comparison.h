// Two images compared by several metrics, and the numbers as JSON: what `wavecrest compare` does.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "metrics/metric_list.h"

namespace wavecrest {

struct Measured {
  const Metric* metric;
  Measurement measurement;
};

// "rmse, relmse, ...": what metrics may be called.
std::string metricNames();

// Throws UsageError for a name that no metric has.
void checkMetricNames(const std::vector<std::string>& names);

// Those that are named, in the list's order; none named: those that are measured by default and that the image is large
// enough for. Throws as checkMetricNames does.
std::vector<const Metric*> chosenMetrics(const std::vector<std::string>& names, const Image& image);

// Throws ImageError where the image is too small for one of the metrics, before it measures any.
std::vector<Measured> measure(const PreparedReference& reference, const ComparedImage& test,
                              const std::vector<const Metric*>& metrics, bool withMaps);

// A metric with one number is that number; further numbers of it go beside it; otherwise it is an object.
nlohmann::ordered_json comparisonJson(const std::vector<Measured>& all, uint64_t nonFinitePixels);

}  // namespace wavecrest
