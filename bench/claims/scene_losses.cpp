#include "bench/claims/scene_losses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "bench/claims/seed_spread_json.h"
#include "bench/statistics/line_fit.h"

namespace wavecrest {
namespace {

constexpr double kSmallestLoss = 1e-9;  // of images that equal the reference
constexpr double kSlopeSpan = 4;        // a slope is measured over so many times the time

// The slope of the line through logarithms of time and of a loss or error. It takes two different times.
std::optional<double> slopeThrough(const std::vector<LinePoint>& points) {
  const std::optional<LineFit> line = lineThrough(points);
  return line ? std::optional(line->slope) : std::nullopt;
}

// A value of a snapshot; nothing if it was not measured or is not finite.
std::optional<double> valueOf(const SnapshotRecord& snapshot, const std::string& metric) {
  const auto value = snapshot.values.find(metric);
  if (value == snapshot.values.end() || !std::isfinite(value->second)) return std::nullopt;
  return value->second;
}

// The natural logarithm of a loss. The lower bound gives a perfect image one, too.
double logLoss(const std::string& metric, double score) {
  return std::log(std::max(lossOf(metric, score), kSmallestLoss));
}

}  // namespace

// The best possible SSIM is 1, the best possible Q_MOS 100.
double lossOf(const std::string& metric, double score) {
  if (metric == "ssim") return 1 - score;
  if (metric == "q_mos") return 100 - score;
  return score;
}
// lossOf is the identity or a reflection c - x, so it is its own inverse.
double scoreOfLoss(const std::string& metric, double loss) { return lossOf(metric, loss); }

std::string SceneLosses::rowOf(const std::string& method) const {
  if (method == "mlt") return "mlt-pathspace";
  return method == "ppm" && reading_ == PpmReading::nextEvent ? "ppm-direct" : method;
}

// The largest difference of two seeds of the method's row in the standard campaign: of logarithms of losses by the
// metric, or of slopes ("slope"). A row that is not in that campaign gets the largest of all rows, a metric that is not
// in it gets that of RMSE.
double SceneLosses::seedSpread(const std::string& method, const std::string& metric) const {
  static const auto kSpreads = nlohmann::json::parse(kSeedSpreadJson).get<std::map<std::string, nlohmann::json>>();
  const auto of = [&](const nlohmann::json& row) {
    return (row.contains(metric) ? row.at(metric) : row.at("rmse")).get<double>();
  };
  if (const auto row = kSpreads.find(rowOf(method)); row != kSpreads.end()) return of(row->second);
  double most = 0;
  for (const auto& [name, row] : kSpreads) most = std::max(most, of(row));
  return most;
}

// The difference of two seeds has twice the variance of one, so half widths are those of differences over sqrt(2).
Band SceneLosses::lossDifference(const std::string& metric, const std::string& a, const std::string& b) const {
  const std::vector<double> lossesA = logLosses(a, metric), lossesB = logLosses(b, metric);
  Band band = differenceBand(lossesA, lossesB);
  if (lossesA.size() == 1 || lossesB.size() == 1) {
    band.halfWidth = std::hypot(seedSpread(a, metric), seedSpread(b, metric)) / std::numbers::sqrt2;
  }
  return band;
}

Band SceneLosses::slopeBand(const std::string& method) const {
  const std::vector<double> slopes = errorSlopes(method);
  Band band = meanBand(slopes);
  if (slopes.size() == 1) band.halfWidth = seedSpread(method, "slope") / std::numbers::sqrt2;
  return band;
}

Band SceneLosses::scoreBand(const std::string& method, const std::string& metric) const {
  const std::vector<double> values = scores(method, metric);
  Band band = meanBand(values);
  // A loss that grows by e^spread moves the score by loss * (e^spread - 1).
  if (values.size() == 1) {
    band.halfWidth = lossOf(metric, band.mean) * std::expm1(seedSpread(method, metric) / std::numbers::sqrt2);
  }
  return band;
}

std::string SceneLosses::missing(const std::string& method) const {
  // One run with snapshots is enough. A refusal says more than a run that is not there.
  const std::string row = rowOf(method);
  std::string gap = row + " was not measured";
  for (const RunRecord& run : results_.runs) {
    if (run.scene != scene_ || run.method != row) continue;
    if (run.state == RunState::done && !run.snapshots.empty()) return "";
    if (run.state == RunState::refused) gap = row + " was refused";
  }
  return gap;
}

std::vector<const RunRecord*> SceneLosses::runs(const std::string& method) const {
  std::vector<const RunRecord*> found;
  for (const RunRecord& run : results_.runs) {
    if (run.scene == scene_ && run.method == rowOf(method) && !run.snapshots.empty()) found.push_back(&run);
  }
  return found;
}

bool SceneLosses::findUnbiased() const {
  return std::ranges::all_of(results_.runs, [&](const RunRecord& run) {
    const bool counts = run.scene == scene_ && !run.snapshots.empty();
    return !counts || valueOf(run.snapshots.back(), kUnbiasedMse).value_or(0) > 0;
  });
}

std::optional<double> SceneLosses::scoreOf(const SnapshotRecord& snapshot, const std::string& metric) const {
  if (!isUnbiased(metric)) return valueOf(snapshot, metric);
  const std::optional<double> mse = valueOf(snapshot, kUnbiasedMse);
  return mse && *mse > 0 ? std::optional(std::sqrt(*mse)) : std::nullopt;
}

// The finite values of a function over the runs of a method. Runs without one are left out.
std::vector<double> SceneLosses::perSeed(const std::string& method,
                                         const std::function<std::optional<double>(const RunRecord&)>& function) const {
  std::vector<double> values;
  for (const RunRecord* run : runs(method)) {
    const std::optional<double> value = function(*run);
    if (value && std::isfinite(*value)) values.push_back(*value);
  }
  return values;
}

std::vector<double> SceneLosses::scores(const std::string& method, const std::string& metric) const {
  return perSeed(method, [&](const RunRecord& run) { return scoreOf(run.snapshots.back(), metric); });
}

std::vector<double> SceneLosses::logLosses(const std::string& method, const std::string& metric) const {
  std::vector<double> values = scores(method, metric);
  for (double& value : values) value = logLoss(metric, value);
  return values;
}

std::optional<double> SceneLosses::floorLoss(const std::string& metric) const {
  const SceneRecord* scene = results_.findScene(scene_);
  if (scene == nullptr || isUnbiased(metric) || !scene->noiseFloors.contains(metric)) return std::nullopt;
  return lossOf(metric, scene->noiseFloors.at(metric));
}

std::vector<double> SceneLosses::logTimes(const std::string& method, const std::string& metric, double wanted) const {
  return perSeed(method, [&](const RunRecord& run) -> std::optional<double> {
    // Follow the snapshots, skipping those without a score, to the time from which on all are as good as wanted: an
    // image without what a method finds late can be better than the image with its noise.
    std::optional<double> timeBefore, lossBefore, reached;
    for (const SnapshotRecord& snapshot : run.snapshots) {
      const std::optional<double> score = scoreOf(snapshot, metric);
      if (!score || !(snapshot.renderSeconds > 0)) continue;
      const double now = std::log(snapshot.renderSeconds), here = logLoss(metric, *score);
      if (here > wanted) {
        reached.reset();
        timeBefore = now;
        lossBefore = here;
      } else if (!reached && !timeBefore) {
        reached = now;  // the time of the first snapshot is an upper bound
      } else if (!reached) {
        // The logarithm of the loss is interpolated over log time.
        const double part = (*lossBefore - wanted) / (*lossBefore - here);
        reached = *timeBefore + part * (now - *timeBefore);
      }
    }
    // Not as good at the end: the time of the last snapshot.
    return reached ? reached : timeBefore;
  });
}

std::optional<TimeToLoss> SceneLosses::timeToLoss(const std::string& method, const std::string& metric,
                                                  double loss) const {
  std::vector<std::vector<LossPoint>> curves;
  for (const RunRecord* run : runs(method)) {
    std::vector<LossPoint>& points = curves.emplace_back();
    for (const SnapshotRecord& snapshot : run->snapshots) {
      if (const std::optional<double> score = scoreOf(snapshot, metric)) {
        points.push_back({snapshot.renderSeconds, lossOf(metric, *score)});
      }
    }
  }
  return wavecrest::timeToLoss(curves, loss);
}

double SceneLosses::endSeconds(const std::string& method) const {
  return meanOf(perSeed(method, [](const RunRecord& run) { return run.snapshots.back().renderSeconds; })).mean;
}

std::vector<double> SceneLosses::lossSlopes(const std::string& method, const std::string& metric,
                                            double seconds) const {
  constexpr size_t kLeastPoints = 3;
  std::vector<double> slopes;
  for (const RunRecord* run : runs(method)) {
    std::vector<LinePoint> points;
    for (const SnapshotRecord& snapshot : run->snapshots) {
      const double away = snapshot.renderSeconds / seconds;
      const std::optional<double> score = scoreOf(snapshot, metric);
      if (!score || away * kSlopeSpan < 0.999 || away > 1.001 * kSlopeSpan) continue;
      points.push_back({std::log(snapshot.renderSeconds), logLoss(metric, *score)});
    }
    const std::optional<double> slope = points.size() < kLeastPoints ? std::nullopt : slopeThrough(points);
    if (!slope) return {};
    slopes.push_back(*slope);
  }
  return slopes;
}

std::vector<double> SceneLosses::errorSlopes(const std::string& method) const {
  return perSeed(method, [](const RunRecord& run) -> std::optional<double> {
    // The factor 0.999 keeps a snapshot at exactly a quarter of the time. The error is the root of the mean square.
    const double from = run.snapshots.back().renderSeconds / kSlopeSpan * 0.999;
    std::vector<LinePoint> points;
    for (const SnapshotRecord& snapshot : run.snapshots) {
      const std::optional<double> mse = valueOf(snapshot, kUnbiasedMse);
      if (!mse || *mse <= 0 || snapshot.renderSeconds < from) continue;
      points.push_back({std::log(snapshot.renderSeconds), 0.5 * std::log(*mse)});
    }
    return slopeThrough(points);
  });
}

}  // namespace wavecrest
