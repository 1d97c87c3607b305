#include "bench/campaign/measured_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/campaign/bias.h"
#include "bench/campaign/render_stats.h"
#include "bench/checkpoint/checkpoint.h"
#include "bench/film_image.h"
#include "bench/machine/machine_record.h"
#include "bench/machine/machine_watch.h"
#include "bench/results/snapshot_notes.h"
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

// How often a checkpoint of the run is written while it is rendered, in seconds of wall time.
constexpr double kCheckpointEvery = 60;

// What earlier processes have measured of a run, as the notes of its checkpoint.
struct RunSoFar {
  std::vector<SnapshotRecord> snapshots = {};
  uint64_t paths = 0;    // of the render at the last of them
  unsigned leftOut = 0;  // snapshots that were due before the first whole image
  std::vector<std::string> doubts = {};
};

// What the scores and times of earlier snapshots depend on, besides what a checkpoint is of: those of the rest have to
// go with them. References differ in their noise floors.
nlohmann::ordered_json conditionsOf(const RunRequest& request) {
  nlohmann::ordered_json conditions = {{"snapshots", request.schedule.text()}};
  if (request.halves != nullptr) conditions["noise_floors"] = request.halves->noiseFloors;
  if (!request.settings.iterations) {
    conditions["clock"] = kClockNames[static_cast<size_t>(request.settings.clock)];
    conditions["threads"] = request.settings.threads;
    conditions["cpu"] = machineRecord().cpu;
  }
  return conditions;
}

nlohmann::ordered_json notesOf(const RunRequest& request, const RunSoFar& run) {
  return {{"conditions", conditionsOf(request)},
          {"snapshots", snapshotNotes(run.snapshots)},
          {"paths", run.paths},
          {"snapshots_left_out", run.leftOut},
          {"doubts", run.doubts}};
}

// Throws nlohmann::json::exception where the notes are of something else, CheckpointError where they are of a run under
// other conditions.
RunSoFar runOfNotes(const RunRequest& request, const nlohmann::ordered_json& notes) {
  const nlohmann::ordered_json conditions = conditionsOf(request);
  for (const auto& [name, value] : conditions.items()) {
    if (notes.at("conditions").at(name).dump() == value.dump()) continue;  // which are the same for NaN
    throw CheckpointError(fmt::format("{}: its run had other {}", request.checkpoint.string(), name));
  }
  return {.snapshots = snapshotsOfNotes(notes.at("snapshots")),
          .paths = notes.at("paths").get<uint64_t>(),
          .leftOut = notes.at("snapshots_left_out").get<unsigned>(),
          .doubts = notes.at("doubts").get<std::vector<std::string>>()};
}

// Takes snapshots of one session: writes the image, measures it and adds a row to the run.
class SnapshotTaker {
 public:
  SnapshotTaker(const RunRequest& request, const RenderSettings& settings, RunRecord& run, const Session& session)
      : request_(request), settings_(settings), run_(run), session_(session) {}

  // Resumes a run. next: the number of the first snapshot that is due now; earlier ones from that number on are taken
  // again. A snapshot whose image file is gone keeps its scores.
  void resume(RunSoFar earlier, unsigned next) {
    leftOut_ = earlier.leftOut;
    earlierDoubts_ = std::move(earlier.doubts);
    for (SnapshotRecord& snapshot : earlier.snapshots) {
      if (snapshot.number >= next) break;
      const bool isThere = !snapshot.file.empty() && (fs::exists(request_.out / snapshot.file) ||
                                                      fs::exists(unfinishedFile(request_.out, snapshot.file)));
      if (!isThere) snapshot.file.clear();
      run_.snapshots.push_back(std::move(snapshot));
    }
    if (run_.snapshots.size() == earlier.snapshots.size()) {
      paths_ = earlier.paths;
      return;
    }
    // The end of a shorter run may have been the image of a snapshot that was due before it.
    const unsigned taken = run_.snapshots.empty() ? leftOut_ : run_.snapshots.back().number + 1;
    if (taken < next) take(next - 1);
  }

  void takeAndSave(unsigned number) {
    take(number);
    if (std::chrono::duration<double>(Clock::now() - saved_).count() >= kCheckpointEvery) save();
  }

  // Writes a checkpoint of the run, if one is asked for.
  void save() {
    if (request_.checkpoint.empty()) return;
    writeCheckpoint(
        request_.checkpoint.string(), request_.scene, settings_, session_,
        notesOf(request_, {.snapshots = run_.snapshots, .paths = paths_, .leftOut = leftOut_, .doubts = doubts()}));
    saved_ = Clock::now();
  }

  void take(unsigned number) {
    // An image counts from its first whole pass on. One that has not changed since the last snapshot is not measured
    // again.
    const RenderStatistics statistics = session_.statistics();
    if (!statistics.hasWholeImage()) {
      ++leftOut_;
      return;
    }
    if (!run_.snapshots.empty() && statistics.paths == paths_) return;
    paths_ = statistics.paths;
    // The record. Its number is the last of those that are due within the run and have this image.
    const double seconds = std::min(statistics.renderSeconds, settings_.seconds.value_or(statistics.renderSeconds));
    SnapshotRecord& snapshot = run_.snapshots.emplace_back();
    snapshot.number = std::max(number + 1, request_.schedule.firstAfter(seconds, statistics.iterations)) - 1;
    // At the end of the run it is at least the count of those that are due before: one iteration may go past the last
    // of them and the end. What is due at the end is not before it, whatever rounding says.
    if (settings_.seconds && statistics.renderSeconds >= *settings_.seconds) {
      const unsigned before = request_.schedule.firstAfter(*settings_.seconds * (1 - 1e-9), 0);
      snapshot.number = std::max(snapshot.number, before);
    }
    snapshot.renderSeconds = statistics.renderSeconds;
    snapshot.iterations = statistics.iterations;
    snapshot.file = (fs::path("images") / fmt::format("{}.{:04}.exr", stemOf(run_), snapshot.number)).string();
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

  // The stats object of the run. Stages and snapshots are left out, as the results file has tables for them, and the
  // peak of memory, which is that of all runs of the process so far.
  nlohmann::ordered_json stats(const RenderStatistics& statistics) const {
    const double wall = std::chrono::duration<double>(Clock::now() - begin_).count();
    nlohmann::ordered_json all =
        renderStats(request_.scene, request_.settings, statistics, request_.loadSeconds, wall, {});
    all.erase("stages");
    all.erase("snapshots");
    all.erase("peak_memory_bytes");
    all["cpu"] = machineRecord().cpu;
    if (request_.settings.seconds) {
      all["asked_seconds"] = *request_.settings.seconds;
      all["doubts"] = doubts();
    }
    all["snapshots_left_out"] = leftOut_;
    return all;
  }

 private:
  // What disturbed this process, and those before.
  std::vector<std::string> doubts() const {
    std::vector<std::string> all = earlierDoubts_;
    for (const std::string& doubt : doubtsAbout(machine_.state())) {
      if (std::find(all.begin(), all.end(), doubt) == all.end()) all.push_back(doubt);
    }
    return all;
  }

  const RunRequest& request_;
  const RenderSettings& settings_;
  RunRecord& run_;
  const Session& session_;
  const Clock::time_point begin_ = Clock::now();
  uint64_t paths_ = 0;
  const MachineWatch machine_;
  unsigned leftOut_ = 0;
  std::vector<std::string> earlierDoubts_;
  Clock::time_point saved_ = Clock::now();
};

// A run's session, and what earlier processes have measured if it resumes a checkpoint.
struct BegunRun {
  std::unique_ptr<Session> session;
  std::optional<RunSoFar> earlier = {};
};

// Resumes the run's checkpoint, or begins anew where there is none or it is of another run. settings: light paths are
// cut into waves as in the checkpoint.
BegunRun beginRun(const RunRequest& request, RenderSettings& settings) {
  const auto anew = [&](const std::string& why) {
    if (request.say) request.say(why + "; the run is rendered anew");
    settings = request.settings;
  };
  if (!request.checkpoint.empty() && fs::exists(request.checkpoint)) {
    try {
      const Checkpoint checkpoint(request.checkpoint.string());
      checkpoint.cutAlike(settings);
      std::unique_ptr<Session> session = Session::create(request.scene, settings);
      checkpoint.restore(request.scene, settings, *session);
      return {.session = std::move(session), .earlier = runOfNotes(request, checkpoint.header().notes)};
    } catch (const CheckpointError& error) {
      anew(error.what());
    } catch (const ImageError& error) {
      anew(error.what());
    } catch (const nlohmann::json::exception&) {
      anew(request.checkpoint.string() + ": has notes that are none");
    }
  }
  return {.session = Session::create(request.scene, settings)};
}

// Whether a run has all of its time or iterations.
bool isOver(const Session& session, const RenderSettings& settings) {
  return (settings.seconds && session.progressSeconds() >= *settings.seconds) ||
         (settings.iterations && session.statistics().iterations >= *settings.iterations);
}

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
  RenderSettings settings = request.settings;
  BegunRun begun;
  try {
    const IdleScope building(hooks);
    begun = beginRun(request, settings);
  } catch (const SceneError& error) {
    run.state = RunState::refused;
    run.reason = error.what();
    return run;
  }
  // Renders from snapshot to snapshot, beginning with the first that is due after what there is.
  const std::unique_ptr<Session> session = std::move(begun.session);
  SnapshotTaker taker(request, settings, run, *session);
  unsigned count = 0;
  if (begun.earlier) {
    const RenderStatistics statistics = session->statistics();
    count = request.schedule.firstAfter(statistics.renderSeconds, statistics.iterations);
    taker.resume(std::move(*begun.earlier), count);
  } else {
    removeUnfinished(request.out, run);
  }
  const auto takeSnapshot = [&](unsigned number) { taker.takeAndSave(number); };
  {
    const WatchScope watch(hooks, *session);
    count = renderWithSnapshots(*session, settings, request.schedule, takeSnapshot, hooks.goesOn, count);
  }
  // A request to save that came too late for the loop above does not end the run. A request to stop does not drop one
  // that is over.
  const bool stopped = session->interrupted() && !isOver(*session, settings) && !(hooks.goesOn && hooks.goesOn());
  if (stopped) {
    taker.save();
    if (request.checkpoint.empty()) removeUnfinished(request.out, run);
    return std::nullopt;
  }
  // The end of the run is always a snapshot.
  taker.take(count);
  taker.save();
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
    if (snapshot.file.empty()) continue;
    // Images that a resumed run had already when it was stored have their final names.
    const fs::path unfinished = unfinishedFile(out, snapshot.file), placed = out / snapshot.file;
    if (fs::exists(unfinished) || !fs::exists(placed)) fs::rename(unfinished, placed);
  }
}

}  // namespace wavecrest
