// What a convergence report says, as plain data: scenes x methods x seeds x snapshots, every snapshot with every
// metric. Filled by collect.h from a results folder, turned into a page by html_page.h; neither knows the other.
// Everything that is indexed by metric is parallel to ConvergenceReport::metrics.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wavecrest {

/// A quality measure, and how its axis is drawn.
struct ReportMetric {
  std::string key;          ///< as in `compare --metrics`, e.g. "rmse"
  std::string name;         ///< heading, e.g. "RMSE"
  std::string explanation;  ///< one line under the heading
  bool higherIsBetter = false;
  bool logarithmic = true;
  /// Exponent of time at which the error of an unbiased method falls; drawn as a guide.
  std::optional<double> idealSlope;
};

struct NamedValue {
  std::string name, value;
};

/// One measured snapshot.
struct ReportPoint {
  double seconds = 0;  ///< render clock
  uint64_t iterations = 0;
  std::vector<double> values;  ///< per metric
};

/// One run from start to end; points in order of time.
struct ReportRun {
  uint64_t seed = 0;
  std::vector<ReportPoint> points;
};

/// Work of one pipeline stage, summed over threads.
struct ReportStage {
  std::string name;
  uint64_t items = 0;
  double seconds = 0;
};

/// 8-bit sRGB pixels, row by row from the top left, three bytes each.
struct ReportImage {
  std::string label;
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

/// One method with one choice of settings on one scene: its runs (one per seed) and what they cost.
struct ReportSeries {
  std::string method;
  std::string label;  ///< the method, and what tells two series of one method apart
  std::vector<ReportRun> runs;
  double pathsPerSecond = 0;           ///< mean over runs
  double cpuSeconds = 0;               ///< sum over runs
  std::vector<ReportStage> stages;     ///< sum over runs
  std::vector<NamedValue> settings;    ///< sampler, precision, radius, ...
  std::vector<ReportImage> snapshots;  ///< of the first run, at least its last one
};

struct ReportScene {
  std::string name;
  uint32_t width = 0, height = 0;
  ReportImage reference;
  std::string referenceOrigin;                     ///< how the reference was made, one line
  std::vector<std::optional<double>> noiseFloors;  ///< per metric: error of the reference itself, where known
  std::vector<ReportSeries> series;
};

struct ConvergenceReport {
  std::string title;
  std::vector<ReportMetric> metrics;
  std::vector<ReportScene> scenes;
  std::vector<NamedValue> environment;
};

}  // namespace wavecrest
