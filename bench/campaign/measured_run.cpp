#include "bench/campaign/measured_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/campaign/bias.h"
#include "bench/campaign/environment.h"
#include "bench/campaign/render_stats.h"
#include "bench/film_image.h"
#include "bench/machine/machine_watch.h"
#include "engine/scene/scene_error.h"
#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kUnfinished = "unfinished.";

// Where an image lies until its run is done. file: as the record has it.
fs::path unfinishedFile(const fs::path& out, const fs::path& file) {
  return out / file.parent_path() / (kUnfinished + file.filename().string());
}

std::string stemOf(const RunRecord& run) { return fmt::format("{}.{}.{}", run.scene, run.method, run.seed); }

// Removes the images that a run which did not end has left.
void removeUnfinished(const fs::path& out, const RunRecord& run) {
  const std::string prefix = kUnfinished + stemOf(run) + ".";
  for (const fs::directory_entry& entry : fs::directory_iterator(out / "images")) {
    if (entry.path().filename().string().starts_with(prefix)) fs::remove(entry.path());
  }
}

// Takes snapshots of one session: writes the image, measures it and adds a row to the run.
class SnapshotTaker {
 public:
  SnapshotTaker(const RunRequest& request, RunRecord& run, const Session& session)
      : request_(request), run_(run), session_(session) {}

  void take(unsigned number) {
    // The record. An image counts from its first whole pass on.
    const RenderStatistics statistics = session_.statistics();
    if (!statistics.hasWholeImage()) {
      ++leftOut_;
      return;
    }
    paths_ = session_.progressPaths();
    SnapshotRecord& snapshot = run_.snapshots.emplace_back();
    snapshot.number = number;
    snapshot.renderSeconds = statistics.renderSeconds;
    snapshot.iterations = statistics.iterations;
    snapshot.file = (fs::path("images") / fmt::format("{}.{:04}.exr", stemOf(run_), number)).string();
    // The image, with the statistics as attributes. Unless all images are kept, it takes the place of the one before.
    const Image image = filmImage(session_);
    nlohmann::ordered_json stats = this->stats(statistics);
    writeExr(unfinishedFile(request_.out, snapshot.file).string(), image, statsMetadata(stats));
    if (!request_.keepImages && run_.snapshots.size() > 1) {
      SnapshotRecord& before = run_.snapshots[run_.snapshots.size() - 2];
      fs::remove(unfinishedFile(request_.out, before.file));
      before.file.clear();
    }
    // Scores against the reference, and the error without the noise of the reference.
    snapshot.values = measureImage(request_.reference, snapshot.file, image);
    if (request_.halves != nullptr) {
      if (const std::optional<double> mse = unbiasedMse(image, *request_.halves)) snapshot.values[kUnbiasedMse] = *mse;
    }
    // Both clocks are kept, whichever the run is charged by. Runs of counted iterations repeat to the bit, so they keep
    // neither.
    if (!request_.settings.iterations) {
      snapshot.values[kWallSeconds] = statistics.renderWallSeconds;
      snapshot.values[kCpuSeconds] = statistics.cpuSeconds;
    }
  }

  // Whether anything was rendered since the last snapshot.
  bool outdated() const { return run_.snapshots.empty() || session_.progressPaths() != paths_; }

  // The stats object of the run. Stages and snapshots are left out, as the results file has tables for them.
  nlohmann::ordered_json stats(const RenderStatistics& statistics) const {
    const double wall = std::chrono::duration<double>(Clock::now() - begin_).count();
    nlohmann::ordered_json all =
        renderStats(request_.scene, request_.settings, statistics, request_.loadSeconds, wall, {});
    all.erase("stages");
    all.erase("snapshots");
    all["cpu"] = cpuName();
    if (request_.settings.seconds) {
      all["asked_seconds"] = *request_.settings.seconds;
      all["doubts"] = doubtsAbout(machine_.state());
    }
    all["snapshots_left_out"] = leftOut_;
    return all;
  }

 private:
  const RunRequest& request_;
  RunRecord& run_;
  const Session& session_;
  const Clock::time_point begin_ = Clock::now();
  uint64_t paths_ = 0;
  const MachineWatch machine_;
  unsigned leftOut_ = 0;  // snapshots that were due before the first whole image
};

}  // namespace

MetricValues measureImage(const PreparedReference& reference, const std::string& name, Image image) {
  const uint32_t side = std::min(image.width, image.height);
  const ComparedImage test = reference.prepareTest(name, {std::move(image), Encoding::linear, {}});
  MetricValues values;
  for (const Metric& metric : metricList()) {
    // A metric that needs a larger image is skipped.
    if (!metric.byDefault || side < metric.smallestSide) continue;
    for (const Score& score : metric.measure(reference, test, false).scores) {
      values[scoreName(metric, score.name)] = score.value;
    }
  }
  return values;
}

std::optional<RunRecord> measuredRun(const RunRequest& request, const SessionHooks& hooks) {
  RunRecord run{.scene = request.scene.name,
                .method = request.row.empty() ? std::string(toString(request.settings.method)) : request.row,
                .seed = request.settings.seed};
  // Makes the session. A scene that the method cannot render gives a run that is refused.
  std::unique_ptr<Session> session;
  try {
    const IdleScope building(hooks);
    session = Session::create(request.scene, request.settings);
  } catch (const SceneError& error) {
    run.state = RunState::refused;
    run.reason = error.what();
    return run;
  }
  // Renders from snapshot to snapshot. An interrupted run is dropped.
  removeUnfinished(request.out, run);
  SnapshotTaker taker(request, run, *session);
  const auto takeSnapshot = [&](unsigned number) { taker.take(number); };
  unsigned count = 0;
  {
    const WatchScope watch(hooks, *session);
    count = renderWithSnapshots(*session, request.settings, request.schedule, takeSnapshot, hooks.goesOn);
  }
  // A request to save that came too late for the loop above does not end the run.
  const bool stopped = session->interrupted() && !(hooks.goesOn && hooks.goesOn());
  if (stopped) {
    removeUnfinished(request.out, run);
    return std::nullopt;
  }
  // The end of the run is always a snapshot.
  if (taker.outdated()) taker.take(count);
  const RenderStatistics statistics = session->statistics();
  run.stats = taker.stats(statistics).dump();
  if (!statistics.hasWholeImage()) {
    run.state = RunState::refused;
    run.reason = fmt::format("{:.2g} s are too short for one whole image", statistics.renderSeconds);
    return run;
  }
  for (const auto& stage : statistics.stages) run.stages.push_back({stage.name, stage.items, stage.seconds});
  return run;
}

void placeImages(const fs::path& out, const RunRecord& run) {
  for (const SnapshotRecord& snapshot : run.snapshots) {
    if (!snapshot.file.empty()) fs::rename(unfinishedFile(out, snapshot.file), out / snapshot.file);
  }
}

}  // namespace wavecrest
