#include "bench/report/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bench/report/html_text.h"
#include "bench/report/report_metrics.h"
#include "bench/report/results_folder.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Keys of the stats file, as they are shown: what is the same for a whole campaign, and what belongs to a series.
constexpr const char* kEnvironmentKeys[] = {"version", "commit", "cpu", "isa", "threads"};
constexpr const char* kSettingKeys[] = {
    "seed",           "sampler",      "precision",         "accel",         "specialization",   "wave", "scene_hash",
    "bytes_per_path", "load_seconds", "peak_memory_bytes", "build_seconds", "nonfinite_samples"};
constexpr size_t kRenderedImages = 4;  // of a scene, shared by its series; each shows at least its last

struct SceneReference {
  MetricReference image;
  std::vector<std::optional<double>> noiseFloors;
  std::string origin;
};

Image readLinear(const fs::path& path) { return readImage(path.string()).image; }

void requireSameSize(const Image& reference, const Image& image, const fs::path& path) {
  if (image.width == reference.width && image.height == reference.height) return;
  throw ResultsError(fmt::format("{}: {} x {} pixels; expected {} x {} as in the reference", path.string(), image.width,
                                 image.height, reference.width, reference.height));
}

// Mean of two halves, and from their difference the noise that is left in it, by every metric.
SceneReference readReference(const fs::path& folder, const std::string& scene) {
  const std::vector<fs::path> files = findReference(folder, scene);
  const auto metrics = measuredMetrics();
  SceneReference reference;
  reference.noiseFloors.resize(metrics.size());
  reference.origin = files[0].filename().string();
  Image mean = readLinear(files[0]);
  if (files.size() == 2) {
    const MetricReference half = prepareReference(mean);
    const Image other = readLinear(files[1]);
    requireSameSize(mean, other, files[1]);
    for (size_t m = 0; m < metrics.size(); ++m) {
      const double noise = metrics[m].noiseOfMean(metrics[m].measure(half, other));
      if (std::isfinite(noise)) reference.noiseFloors[m] = noise;
    }
    for (size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = 0.5F * (mean.pixels[i] + other.pixels[i]);
    reference.origin = fmt::format("mean of {} and {}, two independent halves", files[0].filename().string(),
                                   files[1].filename().string());
  }
  reference.image = prepareReference(std::move(mean));
  return reference;
}

ReportImage shownImage(const std::string& label, Image8 codes) {
  return {.label = label, .width = codes.width, .height = codes.height, .rgb = std::move(codes.pixels)};
}

std::string valueText(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? formatSignificant(value.get<double>()) : value.dump();
}

// The distinct values of a key over several runs, in order of appearance: "1, 2, 3".
void addDistinct(std::vector<NamedValue>& shown, const std::vector<const RunFile*>& runs, const char* key) {
  std::vector<std::string> values;
  for (const RunFile* run : runs) {
    const auto entry = run->stats.find(key);
    if (entry == run->stats.end() || entry->is_null()) continue;
    const std::string text = valueText(*entry);
    if (std::find(values.begin(), values.end(), text) == values.end()) values.push_back(text);
  }
  if (!values.empty()) shown.push_back({key, fmt::format("{}", fmt::join(values, ", "))});
}

double number(const nlohmann::json& object, const char* key) {
  const auto entry = object.find(key);
  return entry != object.end() && entry->is_number() ? entry->get<double>() : 0;
}

void addStages(std::vector<ReportStage>& sums, const nlohmann::json& stats) {
  const auto stages = stats.find("stages");
  if (stages == stats.end() || !stages->is_array()) return;
  for (const nlohmann::json& stage : *stages) {
    const auto name = stage.find("name");
    if (name == stage.end() || !name->is_string()) continue;
    auto sum = std::find_if(sums.begin(), sums.end(), [&](const ReportStage& known) { return known.name == *name; });
    if (sum == sums.end()) sum = sums.insert(sums.end(), {.name = name->get<std::string>()});
    sum->items += static_cast<uint64_t>(number(stage, "items"));
    sum->seconds += number(stage, "seconds");
  }
}

ReportPoint measure(const SnapshotFile& snapshot, const MetricReference& reference, const Image& image) {
  ReportPoint point{.seconds = snapshot.seconds, .iterations = snapshot.iterations, .values = {}};
  for (const MeasuredMetric& metric : measuredMetrics()) point.values.push_back(metric.measure(reference, image));
  return point;
}

// Which snapshots of `count` are shown as images: the last, and before it some at even distances (the times are spaced
// logarithmically as a rule, so evenly in the look of the noise).
std::set<size_t> shownSnapshots(size_t count, size_t wanted) {
  std::set<size_t> shown;
  for (size_t k = 1; k <= wanted; ++k) shown.insert((count * k + wanted - 1) / wanted - 1);
  return shown;
}

ReportSeries collectSeries(const std::vector<const RunFile*>& runs, const std::string& label,
                           const SceneReference& reference, size_t wantedImages) {
  ReportSeries series;
  series.method = runs.front()->method;
  series.label = label;
  for (const RunFile* run : runs) {
    ReportRun measured{.seed = run->seed, .points = {}};
    const std::set<size_t> shown = shownSnapshots(run->snapshots.size(), wantedImages);
    for (size_t k = 0; k < run->snapshots.size(); ++k) {
      const SnapshotFile& snapshot = run->snapshots[k];
      const Image image = readLinear(snapshot.image);
      requireSameSize(reference.image.linear, image, snapshot.image);
      measured.points.push_back(measure(snapshot, reference.image, image));
      if (run == runs.front() && shown.contains(k)) {
        const std::string caption = fmt::format("{}, {}", label, formatSeconds(snapshot.seconds));
        series.snapshots.push_back(shownImage(caption, encodeSrgb8(image)));
      }
    }
    series.runs.push_back(std::move(measured));
    series.pathsPerSecond += number(run->stats, "paths_per_second") / static_cast<double>(runs.size());
    series.cpuSeconds += number(run->stats, "cpu_seconds");
    addStages(series.stages, run->stats);
  }
  for (const char* key : kSettingKeys) addDistinct(series.settings, runs, key);
  return series;
}

// Runs of one scene that differ by the seed only, in order of first appearance.
std::vector<std::vector<const RunFile*>> groupBySettings(const std::vector<const RunFile*>& runs) {
  std::vector<std::vector<const RunFile*>> groups;
  for (const RunFile* run : runs) {
    const auto same = [&](const std::vector<const RunFile*>& group) {
      return group[0]->method == run->method && group[0]->sampler == run->sampler &&
             group[0]->precision == run->precision;
    };
    const auto group = std::find_if(groups.begin(), groups.end(), same);
    if (group == groups.end()) {
      groups.push_back({run});
    } else {
      group->push_back(run);
    }
  }
  return groups;
}

// The method, and where several series share it what tells them apart.
std::string seriesLabel(const std::vector<std::vector<const RunFile*>>& groups, const RunFile& run) {
  std::string label = run.method;
  bool otherSampler = false, otherPrecision = false;
  for (const auto& group : groups) {
    if (group[0]->method != run.method) continue;
    otherSampler |= group[0]->sampler != run.sampler;
    otherPrecision |= group[0]->precision != run.precision;
  }
  if (otherSampler) label += " " + run.sampler;
  if (otherPrecision) label += " " + run.precision;
  return label;
}

ReportScene collectScene(const fs::path& folder, const std::string& name, const std::vector<const RunFile*>& runs) {
  ReportScene scene;
  scene.name = name;
  SceneReference reference = readReference(folder, name);
  scene.width = reference.image.linear.width;
  scene.height = reference.image.linear.height;
  scene.referenceOrigin = reference.origin;
  scene.noiseFloors = reference.noiseFloors;
  const auto groups = groupBySettings(runs);
  const size_t images = std::max<size_t>(1, kRenderedImages / groups.size());
  for (const auto& group : groups) {
    scene.series.push_back(collectSeries(group, seriesLabel(groups, *group[0]), reference, images));
  }
  scene.reference = shownImage("reference", std::move(reference.image.codes));
  return scene;
}

}  // namespace

ConvergenceReport collectReport(const fs::path& folder) {
  const std::vector<RunFile> files = readRuns(folder);
  std::vector<const RunFile*> all;
  std::vector<std::string> scenes;
  for (const RunFile& file : files) {
    all.push_back(&file);
    if (std::find(scenes.begin(), scenes.end(), file.scene) == scenes.end()) scenes.push_back(file.scene);
  }

  ConvergenceReport report;
  report.title =
      scenes.size() == 1 ? "Convergence of " + scenes[0] : fmt::format("Convergence on {} scenes", scenes.size());
  for (const MeasuredMetric& metric : measuredMetrics()) report.metrics.push_back(metric.shown);
  for (const char* key : kEnvironmentKeys) addDistinct(report.environment, all, key);
  for (const std::string& scene : scenes) {
    std::vector<const RunFile*> runs;
    std::copy_if(all.begin(), all.end(), std::back_inserter(runs),
                 [&](const RunFile* run) { return run->scene == scene; });
    report.scenes.push_back(collectScene(folder, scene, runs));
  }
  return report;
}

}  // namespace wavecrest
