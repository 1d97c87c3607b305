#include "bench/claims/scene_losses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavecrest {
namespace {

constexpr double kSmallestLoss = 1e-9;  // of images that equal the reference
constexpr double kSlopeSpan = 4;        // a slope is measured from a fraction of 1 / 4 of the time to the end

// How far two seeds of one method lie apart, in 95 of 100 pairs of the standard campaign (bench/claims/seed-spread):
// differences of logarithms of losses, and of slopes.
double seedSpread(const std::string& metric) {
  if (metric == "ssim") return std::log(1.05);
  if (metric == "q_mos") return std::log(1.3);
  return std::log(1.4);
}
constexpr double kSlopeSpread = 0.35;

// A score of a snapshot; nothing if it was not measured or is not finite.
std::optional<double> scoreOf(const SnapshotRecord& snapshot, const std::string& metric) {
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

Band lossDifference(const std::string& metric, std::span<const double> a, std::span<const double> b) {
  Band band = differenceBand(a, b);
  if (a.size() == 1 || b.size() == 1) band.halfWidth = seedSpread(metric);
  return band;
}

Band slopeBand(std::span<const double> slopes) {
  Band band = meanBand(slopes);
  if (slopes.size() == 1) band.halfWidth = kSlopeSpread;
  return band;
}

Band scoreBand(const std::string& metric, std::span<const double> scores) {
  Band band = meanBand(scores);
  // The spread is one of log losses. A loss that grows by e^spread moves the score by loss * (e^spread - 1).
  if (scores.size() == 1) band.halfWidth = lossOf(metric, band.mean) * std::expm1(seedSpread(metric));
  return band;
}

std::string SceneLosses::missing(const std::string& method) const {
  // One run with snapshots is enough. A refusal says more than a run that is not there.
  const std::string row = rowOf(method);
  std::string gap = row + " was not measured";
  for (const RunRecord& run : results_.runs) {
    if (run.scene != scene_ || run.method != row) continue;
    if (run.state == RunState::done && !run.snapshots.empty()) return "";
    gap = row + " was refused";
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
  if (scene == nullptr || !scene->noiseFloors.contains(metric)) return std::nullopt;
  return lossOf(metric, scene->noiseFloors.at(metric));
}

std::vector<double> SceneLosses::logTimes(const std::string& method, const std::string& metric, double loss) const {
  const double wanted = std::log(std::max(loss, kSmallestLoss));
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

std::vector<double> SceneLosses::errorSlopes(const std::string& method) const {
  return perSeed(method, [](const RunRecord& run) -> std::optional<double> {
    // The factor 0.999 keeps a snapshot at exactly a quarter of the time.
    const double from = run.snapshots.back().renderSeconds / kSlopeSpan * 0.999;
    // Sums for a straight line through (log time, log error). The error is the root of the mean square.
    double n = 0, sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;
    for (const SnapshotRecord& snapshot : run.snapshots) {
      const std::optional<double> mse = scoreOf(snapshot, kUnbiasedMse);
      if (!mse || *mse <= 0 || snapshot.renderSeconds < from) continue;
      const double x = std::log(snapshot.renderSeconds), y = 0.5 * std::log(*mse);
      n += 1;
      sumX += x;
      sumY += y;
      sumXX += x * x;
      sumXY += x * y;
    }
    // The slope of the least-squares line. It takes two different times.
    const double spread = n * sumXX - sumX * sumX;
    if (n < 2 || !(spread > 0)) return std::nullopt;
    return (n * sumXY - sumX * sumY) / spread;
  });
}

}  // namespace wavecrest
