// wavecrest compare REFERENCE TEST: metrics of two images, thresholds, false-colour maps.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "metrics/false_colour.h"
#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"

namespace wavecrest {
namespace {

struct CompareOptions {
  std::string reference, test, mapFolder;
  std::vector<std::string> metrics;
  bool json = false, gammaCorrected = false;
  double exposure = 0;
  std::vector<Option> thresholds;  // in the order of metricList()
  std::vector<double> limits;
};

struct Measured {
  const Metric* metric;
  Measurement measurement;
};

std::string metricNames() {
  std::string names;
  for (const Metric& metric : metricList()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
  return names;
}

bool hasThreshold(const CompareOptions& options, size_t metric) { return options.thresholds[metric].given(); }

// What was named, or the defaults; a metric with a threshold is always measured.
std::vector<const Metric*> chosenMetrics(const CompareOptions& options) {
  for (const std::string& name : options.metrics) {
    if (!findMetric(name)) throw UsageError("--metrics: unknown metric '" + name + "'; expected " + metricNames());
  }
  std::vector<const Metric*> chosen;
  for (size_t i = 0; i < metricList().size(); ++i) {
    const Metric& metric = metricList()[i];
    const auto& named = options.metrics;
    const bool wanted =
        named.empty() ? metric.byDefault : std::find(named.begin(), named.end(), metric.name) != named.end();
    if (wanted || hasThreshold(options, i)) chosen.push_back(&metric);
  }
  return chosen;
}

void requireSize(const std::string& path, const Image& image, const Metric& metric) {
  if (std::min(image.width, image.height) >= metric.smallestSide) return;
  throw ImageError(path,
                   fmt::format("image of {}x{} pixels is too small for {}", image.width, image.height, metric.name),
                   fmt::format("expected at least {0}x{0}; name other metrics with --metrics", metric.smallestSide));
}

void writeMap(const CompareOptions& options, const Measured& measured, const Image& image) {
  const Metric& metric = *measured.metric;
  double range = metric.mapRange;
  if (range == 0) range = quantile(measured.measurement.map, 0.999);
  const std::string path = (std::filesystem::path(options.mapFolder) / (std::string(metric.name) + ".png")).string();
  writePng(path, falseColour(measured.measurement.map, image.width, image.height, range));
  if (!options.json) fmt::print("map {}: 0 to {:.6g}\n", path, range);
}

// A metric with one number is that number; further numbers of it go beside it; otherwise it is an object.
nlohmann::ordered_json toJson(const std::vector<Measured>& all, uint64_t nonFinitePixels) {
  nlohmann::ordered_json json;
  for (const Measured& measured : all) {
    const std::string name(measured.metric->name);
    const auto& scores = measured.measurement.scores;
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
  json["nonfinite_pixels"] = nonFinitePixels;
  return json;
}

void printText(const std::vector<Measured>& all, uint64_t nonFinitePixels) {
  for (const Measured& measured : all) {
    std::string line;
    for (const Score& score : measured.measurement.scores) {
      line +=
          fmt::format("{}{}{}{:.9g}", line.empty() ? "" : "  ", score.name, score.name.empty() ? "" : " ", score.value);
    }
    fmt::print("{:8} {}\n", measured.metric->name, line);
  }
  if (nonFinitePixels > 0) fmt::print("{} pixels are not finite and were excluded\n", nonFinitePixels);
}

// True when every threshold holds. A score that is not a number holds no threshold.
bool checkThresholds(const CompareOptions& options, const std::vector<Measured>& all) {
  bool held = true;
  for (size_t i = 0; i < metricList().size(); ++i) {
    if (!hasThreshold(options, i)) continue;
    const Metric& metric = metricList()[i];
    const auto measured = std::find_if(all.begin(), all.end(), [&](const Measured& m) { return m.metric == &metric; });
    const double score = mainScore(metric, measured->measurement), limit = options.limits[i];
    if (metric.higherIsBetter ? score >= limit : score <= limit) continue;
    fmt::print(stderr, "wavecrest: check failed: {} is {:.9g}; --{} asks for {:.9g}\n", metric.name, score,
               metric.threshold, limit);
    held = false;
  }
  return held;
}

int compare(const CompareOptions& options) {
  const std::vector<const Metric*> metrics = chosenMetrics(options);
  ComparisonSettings settings;
  settings.exposure = options.exposure;
  settings.gammaCorrectedErrors = options.gammaCorrected;
  const PreparedReference reference(options.reference, readImage(options.reference), settings);
  const ComparedImage test = reference.prepareTest(options.test, readImage(options.test));
  const Image& image = test.file.image;
  for (const Metric* metric : metrics) requireSize(options.reference, image, *metric);

  const bool withMaps = !options.mapFolder.empty();
  if (withMaps) std::filesystem::create_directories(options.mapFolder);
  std::vector<Measured> all;
  all.reserve(metrics.size());
  for (const Metric* metric : metrics) all.push_back({metric, metric->measure(reference, test, withMaps)});
  if (options.json) {
    fmt::print("{}\n", toJson(all, test.nonFinitePixels).dump(2));
  } else {
    printText(all, test.nonFinitePixels);
  }
  if (withMaps)
    for (const Measured& measured : all) writeMap(options, measured, image);
  return checkThresholds(options, all) ? kExitDone : kExitCheck;
}

}  // namespace

void addCompareCommand(CommandLine& program, int& exitCode) {
  const Command command = program.add("compare", "measure a test image against a reference");
  auto options = std::make_shared<CompareOptions>();
  command.add("REFERENCE", options->reference, "EXR, PFM, HDR or PNG").required();
  command.add("TEST", options->test, "image of the same size").required();
  command.add("--metrics", options->metrics, "which of " + metricNames()).separatedByCommas();
  command.addFlag("--json", options->json, "print one JSON object");
  command.add("--map", options->mapFolder, "write a false-colour PNG of each metric into this folder");
  command.add("--exposure", options->exposure, "stops applied before conversion to 8 bits").between(-100.0, 100.0);
  command.addFlag("--gamma", options->gammaCorrected, "rmse and relmse on gamma-corrected 8-bit values");
  options->limits.resize(metricList().size());
  for (size_t i = 0; i < metricList().size(); ++i) {
    const Metric& metric = metricList()[i];
    options->thresholds.push_back(command.add(
        "--" + std::string(metric.threshold), options->limits[i],
        fmt::format("exit code 4 if {} is {} than this", metric.title, metric.higherIsBetter ? "less" : "more")));
  }
  command.run([options, &exitCode] { exitCode = compare(*options); });
}

}  // namespace wavecrest
