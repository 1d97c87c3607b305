#include "bench/report/collect_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/claims/explanations.h"
#include "bench/claims/judge_claims.h"
#include "bench/image_attributes.h"
#include "bench/report/final_images.h"
#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/series_facts.h"
#include "bench/report/shown_metrics.h"
#include "bench/results/noise_floors.h"
#include "bench/whole_number.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Runs of one scene and method: one for each seed.
using Group = std::vector<const RunRecord*>;

// The metrics that any snapshot was measured by, in the order of the metric list.
std::vector<const Metric*> measuredMetrics(const CampaignResults& results) {
  std::vector<const Metric*> metrics;
  for (const Metric& metric : metricList()) {
    const std::string key = scoreName(metric, metric.score);
    const bool occurs = std::any_of(results.runs.begin(), results.runs.end(), [&](const RunRecord& run) {
      return std::any_of(run.snapshots.begin(), run.snapshots.end(),
                         [&](const SnapshotRecord& snapshot) { return snapshot.values.contains(key); });
    });
    if (occurs) metrics.push_back(&metric);
  }
  return metrics;
}

// The value under a key; NaN if it was not measured.
double valueOf(const MetricValues& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

// One snapshot: the scores of the metrics shown, and all other scores as further ones.
ReportPoint pointOf(const SnapshotRecord& snapshot, const std::vector<ReportMetric>& metrics) {
  ReportPoint point{
      .number = snapshot.number, .seconds = snapshot.renderSeconds, .iterations = snapshot.iterations, .values = {}};
  for (const ReportMetric& metric : metrics) point.values.push_back(valueOf(snapshot.values, metric.key));
  for (const auto& [name, value] : snapshot.values) {
    const bool shown = std::any_of(metrics.begin(), metrics.end(),
                                   [&name = name](const ReportMetric& metric) { return metric.key == name; });
    if (!shown) point.further.push_back({name, value});
  }
  return point;
}

// The bias rows of a method, at the mean time of the snapshots that they are about.
std::vector<ReportBias> biasOf(const CampaignResults& results, const Group& group) {
  std::vector<ReportBias> biases;
  for (const BiasRecord& record : results.biases) {
    if (record.scene != group[0]->scene || record.method != group[0]->method) continue;
    double seconds = 0, count = 0;
    for (const RunRecord* run : group) {
      for (const SnapshotRecord& snapshot : run->snapshots) {
        if (snapshot.number != record.number) continue;
        seconds += snapshot.renderSeconds;
        ++count;
      }
    }
    if (count == 0) continue;
    biases.push_back({.seconds = seconds / count,
                      .seeds = record.seeds,
                      .meanSquareError = record.meanSquareError,
                      .variance = record.variance,
                      .bias2 = record.biasSquared});
  }
  std::sort(biases.begin(), biases.end(),
            [](const ReportBias& a, const ReportBias& b) { return a.seconds < b.seconds; });
  return biases;
}

// One series from the runs of one scene and method.
ReportSeries seriesOf(const CampaignResults& results, const Group& group, const std::vector<ReportMetric>& metrics) {
  ReportSeries series;
  series.label = group[0]->method;
  series.method = methodId(series.label);
  std::vector<nlohmann::json> stats;
  for (const RunRecord* run : group) {
    ReportRun shown{.seed = run->seed, .points = {}};
    for (const SnapshotRecord& snapshot : run->snapshots) shown.points.push_back(pointOf(snapshot, metrics));
    series.runs.push_back(std::move(shown));
    for (const StageRecord& stage : run->stages)
      addStage(series.stages, {.name = stage.name, .items = stage.items, .seconds = stage.seconds});
    // Stats that are not a JSON object are skipped: the report needs only the measurements.
    nlohmann::json object = nlohmann::json::parse(run->stats, nullptr, false);
    if (object.is_object()) stats.push_back(std::move(object));
  }
  // Pointers are taken once the vector of stats no longer grows.
  std::vector<const nlohmann::json*> objects;
  objects.reserve(stats.size());
  for (const nlohmann::json& object : stats) objects.push_back(&object);
  if (!objects.empty()) addSeriesFacts(series, objects);
  series.bias = biasOf(results, group);
  return series;
}

// The finished runs of a scene by method, in the order of the first run of each method.
std::vector<Group> groupByMethod(const CampaignResults& results, const std::string& scene) {
  std::vector<Group> groups;
  for (const RunRecord& run : results.runs) {
    if (run.scene != scene || run.state != RunState::done) continue;
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& known) { return known[0]->method == run.method; });
    if (group == groups.end()) {
      groups.push_back({&run});
    } else {
      group->push_back(&run);
    }
  }
  return groups;
}

// One row for each class, one column for each method, both in the order of the records.
std::vector<ReportPathClass> pathClassesOf(const SceneRecord& scene) {
  std::vector<ReportPathClass> classes;
  for (const PathClassRecord& record : scene.pathClasses) {
    auto row = std::find_if(classes.begin(), classes.end(),
                            [&](const ReportPathClass& known) { return known.name == record.pathClass; });
    if (row == classes.end()) row = classes.insert(classes.end(), {.name = record.pathClass, .verdicts = {}});
    row->verdicts.push_back({record.method, record.verdict});
  }
  return classes;
}

// The images of a series: of the first run whose last image is there, as far as they are files; empty without one.
std::vector<TimedImage> imagesOf(const Group& group) {
  std::vector<TimedImage> images;
  for (const RunRecord* run : group) {
    if (run->snapshots.empty() || !fs::is_regular_file(run->snapshots.back().file)) continue;
    for (const SnapshotRecord& snapshot : run->snapshots) {
      if (fs::is_regular_file(snapshot.file)) images.push_back({snapshot.renderSeconds, snapshot.file});
    }
    break;
  }
  return images;
}

// Adds the methods that cannot render the scene, each once with its reason.
void addRefusals(ReportScene& scene, const CampaignResults& results) {
  for (const RunRecord& run : results.runs) {
    if (run.scene != scene.name || run.state != RunState::refused) continue;
    const bool known = std::any_of(scene.refusals.begin(), scene.refusals.end(),
                                   [&](const NamedValue& refusal) { return refusal.name == run.method; });
    if (!known) scene.refusals.push_back({run.method, run.reason});
  }
}

// What a reference says of itself, as bench/campaign/reference_file.h writes it: ", two halves by bpt, off by 0.8 %".
std::string originOf(const Metadata& metadata) {
  std::string text;
  const std::string method = attributeOf(metadata, "method");
  if (!method.empty()) text += fmt::format(", two halves by {}", method);
  const auto number = [&](const char* key) { return wholeNumber<double>(attributeOf(metadata, key)).value_or(0); };
  // A reference with a merge radius is biased. Files of earlier versions have the radius, but no word of the bias.
  if (number("radius") > 0) text += ", biased by its merge radius";
  const double error = number("relative_error");
  if (error > 0) text += fmt::format(", off by about {} % of a sample's value", formatSignificant(100 * error, 2));
  return text;
}

// The least relMSE that any run of the scene ended with.
std::optional<double> bestRelmse(const CampaignResults& results, const std::string& scene) {
  std::optional<double> best;
  for (const RunRecord& run : results.runs) {
    if (run.scene != scene || run.snapshots.empty()) continue;
    const double value = valueOf(run.snapshots.back().values, "relmse");
    if (std::isfinite(value)) best = std::min(best.value_or(value), value);
  }
  return best;
}

// The shortest and the longest time that runs of a scene were asked to take; 0 where none says. They differ where a
// campaign that is made longer was stopped on its way.
std::pair<double, double> askedSeconds(const CampaignResults& results, const std::string& scene) {
  double shortest = 0, longest = 0;
  for (const RunRecord& run : results.runs) {
    if (run.scene != scene || run.state != RunState::done) continue;
    const nlohmann::json stats = nlohmann::json::parse(run.stats, nullptr, false);
    const double asked = stats.is_object() ? stats.value("asked_seconds", 0.0) : 0;
    if (!(asked > 0)) continue;
    shortest = longest > 0 ? std::min(shortest, asked) : asked;
    longest = std::max(longest, asked);
  }
  return {shortest, longest};
}

// Which runs of a scene something disturbed, and by what; empty if none was.
std::string disturbedRuns(const CampaignResults& results, const std::string& scene) {
  constexpr size_t kMostNamed = 3;
  size_t runs = 0, disturbed = 0;
  std::string named;
  for (const RunRecord& run : results.runs) {
    if (run.scene != scene || run.state != RunState::done) continue;
    ++runs;
    const nlohmann::json stats = nlohmann::json::parse(run.stats, nullptr, false);
    const auto doubts = stats.is_object() ? stats.find("doubts") : stats.end();
    if (doubts == stats.end() || !doubts->is_array() || doubts->empty() || !doubts->front().is_string()) continue;
    if (++disturbed > kMostNamed) continue;
    named += fmt::format("{}{} seed {} ({})", named.empty() ? "" : ", ", run.method, run.seed,
                         doubts->front().get<std::string>());
  }
  if (disturbed == 0) return "";
  if (disturbed > kMostNamed) named += ", ...";
  return fmt::format("{}: {} of {} runs were disturbed: {}.", scene, disturbed, runs, named);
}

// One scene with its series, and with its images as far as the files exist. Adds remarks to the report.
ReportScene collectScene(const CampaignResults& results, const SceneRecord& record, ConvergenceReport& report) {
  ReportScene scene;
  scene.name = record.name;
  scene.width = record.width;
  scene.height = record.height;
  scene.referenceOrigin = fs::path(record.referenceFile).filename().string();
  // Noise floors of the metrics shown.
  for (const ReportMetric& metric : report.metrics) {
    const double floor = valueOf(record.noiseFloors, metric.key);
    scene.noiseFloors.push_back(std::isfinite(floor) ? std::optional(floor) : std::nullopt);
  }
  // One series for each method.
  std::vector<std::vector<TimedImage>> images;
  for (const Group& group : groupByMethod(results, record.name)) {
    scene.series.push_back(seriesOf(results, group, report.metrics));
    images.push_back(imagesOf(group));
  }
  scene.pathClasses = pathClassesOf(record);
  // Warn where the noise of the reference is too large to measure against.
  for (const std::string& floor : unmetFloors(record.noiseFloors, bestRelmse(results, record.name))) {
    report.remarks.push_back(fmt::format("{}: the reference is noisy: {}.", record.name, floor));
  }
  if (const auto [shortest, longest] = askedSeconds(results, record.name); longest > shortest) {
    report.remarks.push_back(fmt::format("{}: runs of {} and of {} stand side by side; go on with the campaign.",
                                         record.name, formatSeconds(shortest), formatSeconds(longest)));
  }
  addChainsRemark(report.remarks, scene);
  if (const std::string remark = disturbedRuns(results, record.name); !remark.empty()) report.remarks.push_back(remark);
  addRefusals(scene, results);
  // Measurements come from the results file. Pictures need the image files.
  if (!fs::is_regular_file(record.referenceFile)) {
    report.remarks.push_back(fmt::format("{}: no pictures, as {} is not there.", record.name, record.referenceFile));
    return scene;
  }
  const PreparedReference reference(record.referenceFile, readImage(record.referenceFile));
  scene.referenceOrigin += originOf(reference.image().file.metadata);
  addImages(scene, reference, images);
  const auto missing = std::ranges::count_if(images, [](const auto& ofSeries) { return ofSeries.empty(); });
  if (missing > 0)
    report.remarks.push_back(fmt::format("{}: the images of {} methods are not there.", record.name, missing));
  return scene;
}

std::string profileOf(const CampaignResults& results) {
  const auto profile = results.campaign.find("profile");
  return profile != results.campaign.end() ? profile->second : "";
}

// A stored claim with its source and explanation, which are in bench/claims and not in results files. Explanations
// speak of the results of one campaign each.
ReportClaim shownClaim(const ClaimRecord& record, std::string_view profile, std::string_view commit) {
  ReportClaim shown{.scene = record.scene,
                    .statement = record.statement,
                    .verdict = record.verdict,
                    .figure = record.figure,
                    .evidence = record.evidence};
  const Claim* claim = findStudyClaim(record.id);
  if (claim == nullptr) return shown;
  shown.id = claim->id;
  shown.source = claim->source;
  // An explanation is shown where the claim does not hold or is open.
  const bool open =
      record.verdict != toString(ClaimVerdict::holds) && record.verdict != toString(ClaimVerdict::notJudged);
  const Explanation* explanation = open ? findExplanation(claim->id, record.verdict, profile) : nullptr;
  if (explanation == nullptr) return shown;
  shown.explainedHere = isOf(*explanation, profile, commit);
  if (!shown.explainedHere) {
    shown.explanation = fmt::format("In the {} campaign of commit {}: ", explanation->profile, explanation->commit);
  }
  shown.explanation += explanation->text;
  return shown;
}

// The crops that the campaign was asked for, of this scene.
std::vector<PictureCrop> cropsOf(const CampaignResults& results, const std::string& scene) {
  std::vector<PictureCrop> crops;
  const auto options = results.campaign.find("options");
  if (options == results.campaign.end()) return crops;
  const auto parsed = nlohmann::json::parse(options->second, nullptr, false);
  if (!parsed.is_object()) return crops;
  for (const auto& word : parsed.value("--crop", nlohmann::json::array())) {
    const auto crop = word.is_string() ? parseSceneCrop(word.get<std::string>()) : std::nullopt;
    if (crop && crop->scene == scene) crops.push_back(crop->crop);
  }
  return crops;
}

std::string titleOf(const CampaignResults& results) {
  std::string title = results.scenes.size() == 1 ? "Convergence of " + results.scenes[0].name
                                                 : fmt::format("Convergence on {} scenes", results.scenes.size());
  if (const std::string profile = profileOf(results); !profile.empty()) title += ", profile " + profile;
  return title;
}

}  // namespace

ConvergenceReport collectCampaign(const CampaignResults& results) {
  ConvergenceReport report;
  report.title = titleOf(results);
  for (const Metric* metric : measuredMetrics(results)) report.metrics.push_back(shownMetric(*metric));
  for (const SceneRecord& scene : results.scenes) {
    report.scenes.push_back(collectScene(results, scene, report));
    report.scenes.back().crops = cropsOf(results, scene.name);
  }
  // A scene whose runs are still to come has nothing to show.
  std::erase_if(report.scenes, [](const ReportScene& scene) { return scene.series.empty() && scene.refusals.empty(); });
  const std::string profile = profileOf(results);
  const auto commit = results.campaign.find("commit");
  for (const ClaimRecord& claim : results.claims) {
    report.claims.push_back(shownClaim(claim, profile, commit == results.campaign.end() ? "" : commit->second));
  }
  for (const auto& [key, value] : results.campaign) report.environment.push_back({key, value});
  return report;
}

}  // namespace wavecrest
