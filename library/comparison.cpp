#include "library/comparison.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "library/errors.h"
#include "library/suggestion.h"

namespace wavecrest {
namespace {

// Whether the shorter side of the image is long enough for the metric.
bool largeEnough(const Image& image, const Metric& metric) {
  return std::min(image.width, image.height) >= metric.smallestSide;
}

// Throws ImageError where the image is too small for the metric. name: of the image, for the message.
void requireSide(const std::string& name, const Image& image, const Metric& metric) {
  if (largeEnough(image, metric)) return;
  throw ImageError(name,
                   fmt::format("image of {}x{} pixels is too small for {}", image.width, image.height, metric.name),
                   fmt::format("expected at least {0}x{0}; name other metrics with --metrics", metric.smallestSide));
}

}  // namespace

std::string metricNames() {
  std::string names;
  for (const Metric& metric : metricList()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
  return names;
}

void checkMetricNames(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Metric& metric : metricList()) known.emplace_back(metric.name);
  for (const std::string& name : names) {
    if (findMetric(name)) continue;
    throw UsageError(
        fmt::format("--metrics {}: unknown; expected some of {}{}", name, metricNames(), didYouMean(name, known)));
  }
}

std::vector<const Metric*> chosenMetrics(const std::vector<std::string>& names, const Image& image) {
  checkMetricNames(names);
  std::vector<const Metric*> chosen;
  for (const Metric& metric : metricList()) {
    const bool named = std::find(names.begin(), names.end(), metric.name) != names.end();
    // Named metrics are chosen whatever their size, so that measure() can refuse them with a message.
    if (names.empty() ? metric.byDefault && largeEnough(image, metric) : named) chosen.push_back(&metric);
  }
  return chosen;
}

std::vector<Measured> measure(const PreparedReference& reference, const ComparedImage& test,
                              const std::vector<const Metric*>& metrics, bool withMaps) {
  // All metrics are checked before the first one, which may take long, is measured.
  for (const Metric* metric : metrics) requireSide(reference.name(), test.file.image, *metric);
  std::vector<Measured> all;
  all.reserve(metrics.size());
  for (const Metric* metric : metrics) all.push_back({metric, metric->measure(reference, test, withMaps)});
  return all;
}

nlohmann::ordered_json comparisonJson(const std::vector<Measured>& all, uint64_t nonFinitePixels) {
  // Scores. A score without a name is the value of its metric, and further scores of that metric have keys beside it. A
  // metric whose scores all have names is an object.
  nlohmann::ordered_json json;
  for (const Measured& measured : all) {
    const std::string name(measured.metric->name);
    const auto& scores = measured.measurement.scores;
    // Whether the metric has a value of its own.
    const bool single = scores.front().name.empty();
    for (const Score& score : scores) {
      if (score.name.empty()) {
        json[name] = score.value;
      } else if (single) {
        json[name + "_" + std::string(score.name)] = score.value;
      } else {
        json[name][std::string(score.name)] = score.value;
      }
    }
  }
  // Pixels that were left out, and for some metrics the conditions that their scores depend on.
  json["nonfinite_pixels"] = nonFinitePixels;
  for (const Measured& measured : all) {
    const Metric& metric = *measured.metric;
    if (!metric.conditions.empty()) json["conditions"][std::string(metric.name)] = metric.conditions;
  }
  return json;
}

}  // namespace wavecrest
