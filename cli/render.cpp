// wavecrest render: one scene, one method, images and statistics out.
#include <fmt/core.h>

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "bench/until/longer_time.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "cli/render_messages.h"
#include "cli/render_options.h"
#include "cli/render_outputs.h"
#include "cli/render_ranks.h"
#include "engine/load/load.h"
#include "engine/pilot/finished_plan.h"
#include "engine/plan/render_plan.h"
#include "engine/session/session.h"
#include "engine/session/snapshots.h"
#include "library/option_values.h"
#include "metrics/image/atomic_file.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// The goal of the --until options. Throws UsageError for options that do not go with a goal.
UntilGoal untilGoal(const RenderOptions& options, const RenderSettings& settings, const FilmArea& film) {
  if (!options.snapshotEvery.empty()) {
    throw UsageError(
        "--snapshot-every: not together with --until-ssim or --until-relative-error; expected one of them");
  }
  if (!options.checkpoint.file.empty()) {
    throw UsageError(
        "--checkpoint: not together with --until-ssim or --until-relative-error, whose looks it does not keep; "
        "expected one of them");
  }
  return {options.until, settings, film};
}

enum class Ending { complete, stopped };

// With --resume: restores the session and the outputs from the checkpoint, if there is one, and tells at which
// iteration the render goes on.
void goOn(const std::unique_ptr<Checkpoint>& earlier, const CheckpointOptions& options, const Scene& scene,
          const RenderSettings& settings, ProgressKind kind, Session& session, RenderOutputs& outputs) {
  if (!options.resume) return;
  if (earlier) {
    earlier->restore(scene, settings, session);
    try {
      outputs.goOnFrom(earlier->header().notes, session);
    } catch (const nlohmann::json::exception&) {
      throw InputError(options.file +
                       ": has notes that are none; expected a checkpoint as `render --checkpoint` left it");
    }
  }
  const uint64_t iterations = session.statistics().iterations;
  noteLine(kind, {{"checkpoint", options.file}, {"resumed_from", iterations}},
           options.file + (earlier ? fmt::format(": goes on after {} iterations", iterations)
                                   : ": there is none yet; begins from the start"));
}

// Paths of so many iterations, or the largest number where they are more.
uint64_t pathsOf(uint64_t iterations, const FilmArea& film) {
  constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max();
  const uint64_t pixels = film.pixels.size();
  return iterations > kMost / pixels ? kMost : iterations * pixels;
}

// One render from its options to its files. Under a launcher each process has one, of a share of the render.
class RenderRun {
 public:
  explicit RenderRun(RenderOptions options) : options_(std::move(options)) {}
  // The exit code.
  int run();

 private:
  int runTogether();
  void check();
  void load();
  void build();
  Ending render();
  bool goesOn();
  int end(Ending ending);
  int endAlone(const RanksError& error);
  int write(Ending ending, const Rendered& rendered);
  int endWithoutImage(Ending ending, const RenderStatistics& statistics) const;

  RenderRanks ranks_;
  RenderOptions options_;
  ProgressKind kind_ = ProgressKind::automatic;
  SnapshotSchedule schedule_ = SnapshotSchedule::none();
  OutputNames names_;
  std::optional<InterruptGuard> guard_;
  std::optional<Checkpointing> checkpointing_;
  std::unique_ptr<Checkpoint> earlier_;
  Scene scene_;
  double loadSeconds_ = 0;
  RenderSettings settings_;
  std::optional<UntilGoal> until_;
  std::unique_ptr<Session> session_;
  std::optional<LiveRender> live_;
  std::optional<RenderOutputs> outputs_;
  unsigned firstSnapshot_ = 0;
  std::optional<bool> written_;  // once the outputs of the whole render were tried: whether all are there
};

// Refuses what --dry-run, which shows a plan as text and no image, would ignore. Throws UsageError.
void refuseBesideDryRun(const RenderOptions& options) {
  for (const auto& [option, given] :
       {std::pair("--view", !options.live.view.empty()), std::pair("--tev", !options.live.tev.empty()),
        std::pair("--stats -", options.stats == kStandardStream)}) {
    if (!options.dryRun || !given) continue;
    throw UsageError(fmt::format("--dry-run and {}: nothing is rendered; expected one of them", option));
  }
}

// Checks options and output names before anything takes time, locks the checkpoint, and reads it with --resume.
void RenderRun::check() {
  refuseBesideDryRun(options_);
  schedule_ = parseSnapshotSchedule("--snapshot-every", options_.snapshotEvery);
  kind_ = ranks_.kind(
      quietIf(options_.quiet, static_cast<ProgressKind>(parseChoice("--progress", options_.progress, kProgressNames))));
  if (options_.outputs.empty() && !options_.snapshotEvery.empty()) {
    throw UsageError("--snapshot-every: snapshots of a part are named after its image; expected -o FILE.exr");
  }
  const bool measures = !options_.stats.empty();
  ranks_.adapt(options_);
  settings_.measureStages = measures;
  names_ = {options_.outputs,         options_.stats,    options_.snapshotEvery,
            options_.checkpoint.file, options_.exposure, options_.partial};
  guard_.emplace(ranks_.first() ? messageLine(kind_, "interrupted before anything was rendered; no image was written")
                                : "");
  checkOutputs(names_, {findScene(options_.scene.scene)}, options_.until.reference);
  checkpointing_.emplace(options_.checkpoint);
  earlier_ = checkpointing_->takeEarlier();
  // Removes temporary files of a render that was killed while it tried or wrote its outputs. The lock, which is there
  // before the first checkpoint, keeps other processes from going on with this render at the same time.
  if (options_.checkpoint.file.empty()) return;
  for (const std::string& output : options_.outputs) removeTemporaries(output);
}

// Loads the scene. Only then are all its files known, so outputs are checked against them once more. Where the image
// depends on it, light paths are cut into waves as the checkpoint says.
void RenderRun::load() {
  const auto begin = std::chrono::steady_clock::now();
  scene_ = loadScene(options_.scene, kind_);
  printNotes(scene_, kind_);
  checkOutputs(names_, scene_.files, options_.until.reference);
  loadSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const bool measures = settings_.measureStages;
  settings_ = ranks_.share(settingsOfRender(options_, scene_), scene_, kind_);
  settings_.measureStages = measures;
  if (earlier_) earlier_->cutAlike(settings_);
  if (options_.until.any()) {
    const FilmArea film = filmOutline(scene_.film);
    until_.emplace(untilGoal(options_, settings_, film));
    until_->reserveMemory(settings_, film);
  }
}

// Makes the session, connects viewers and outputs, and goes on from the checkpoint.
void RenderRun::build() {
  session_ = Session::create(scene_, settings_);
  const RenderStatistics statistics = session_->statistics();
  tellPlan(options_, scene_, settings_, kind_, statistics.renderedBy(settings_.method), session_->memoryPlan(),
           session_->film().spreads());
  showChoice(kind_, settings_.method, statistics.choice);
  if (ranks_.several() && statistics.guide) {
    note(kind_, "gpt: each process learns from its own share of the iterations");
  }
  live_.emplace(options_.live, scene_, settings_, kind_, session_);
  outputs_.emplace(names_, scene_, settings_, loadSeconds_, kind_);
  goOn(earlier_, options_.checkpoint, scene_, settings_, kind_, *session_, *outputs_);
  earlier_.reset();
  firstSnapshot_ = outputs_->nextSnapshot(schedule_, *session_);
}

int RenderRun::run() {
  try {
    return runTogether();
  } catch (const SharedFailure&) {
    // The launcher may end those that are not over yet, which have nothing to add.
    if (guard_) guard_->setIdle(false);
    ranks_.finish();
    throw;
  }
}

int RenderRun::runTogether() {
  ranks_.together([this] { check(); });
  ranks_.together([this] { load(); });
  ranks_.cutAlike(settings_);
  if (options_.pin) settings_.placement = ranks_.pinned(settings_.threads, kind_);
  if (options_.dryRun) {
    ranks_.together([this] {
      const DryPlan plan = planWithoutSession(scene_, settings_);
      tellPlan(options_, scene_, settings_, kind_, plan.method, plan.memory, plan.spreads);
      if (ranks_.first()) showPlan(options_, scene_, settings_, plan);
    });
    return ranks_.leave(kExitDone);
  }
  ranks_.together([this] { build(); });
  if (ranks_.several()) {
    firstSnapshot_ = ranks_.agree(renderIdentity(scene_, settings_, *session_), *session_, firstSnapshot_, *outputs_);
  }
  // Renders, with a checkpoint every now and then.
  try {
    const RenderRanks::Watch watch(ranks_, *guard_, *session_, *outputs_);
    std::optional<CheckpointTimer> timer;
    if (!options_.checkpoint.file.empty()) timer.emplace(*guard_, checkpointing_->seconds());
    const Ending ending = render();
    timer.reset();
    if (until_) noteLine(kind_, {{"until", outputs_->until()}}, UntilGoal::describe(outputs_->until()));
    return end(ending);
  } catch (const RanksError& error) {
    return endAlone(error);
  }
}

// Called after an interrupt. A signal to stop ends the render. A pause writes a checkpoint, a save images as well; then
// the session goes on.
bool RenderRun::goesOn() {
  if (guard_->interrupted()) return false;
  const bool save = guard_->takeSaveRequest();
  if (guard_->takePauseRequest()) {
    outputs_->writeCheckpoint(*session_);
    guard_->takePauseRequest();  // of meanwhile: a save that takes longer than its interval must not end all progress
  }
  guard_->takeAttentionRequest();
  ranks_.attend(*session_, save, *outputs_);
  guard_->goOn();
  return true;
}

// Renders to the end or to a signal. Snapshots and requested saves are written on the way.
Ending RenderRun::render() {
  bool stopped = false;
  const auto goOnUnlessStopped = [&] {
    stopped = !goesOn();
    return !stopped;
  };
  std::optional<uint64_t> goalPaths;
  if (const std::optional<uint64_t> iterations = settings_.jointIterations()) {
    // A part of an mlt render has some of the chains, in all iterations. Under a launcher, progress counts the paths of
    // all processes.
    const uint64_t parts = settings_.method == Method::mlt && !ranks_.several() ? settings_.share.parts : 1;
    goalPaths = pathsOf(*iterations, session_->film().area()) / parts;
  }
  {
    // In this block signals interrupt the session, and find none behind it. The end of Progress completes the line on
    // the terminal.
    const SessionWatch watch(*guard_, live_->interruptible(*session_));
    const Progress progress(kind_, *session_, settings_.seconds, goalPaths, ranks_.pathsElsewhere());
    // A goal of quality renders in steps of its own, without snapshots.
    if (until_) {
      do {
        outputs_->setUntil(until_->render(*session_, settings_));
      } while (session_->interrupted() && goOnUnlessStopped() && !until_->over());
    } else {
      renderWithSnapshots(
          *session_, settings_, schedule_,
          [&](unsigned number) {
            live_->look(false);
            ranks_.snapshot(*session_, number, *outputs_);
          },
          goOnUnlessStopped, firstSnapshot_);
    }
  }
  if (until_ && until_->black() && !stopped) {
    throw InputError(
        fmt::format("--until-relative-error: after {} iterations the image is black, which has no relative error; "
                    "expected a scene that the method finds light in, or --spp or --time beside it",
                    session_->statistics().iterations));
  }
  return stopped ? Ending::stopped : Ending::complete;
}

// Checkpoint and outputs are written however the render ended. The checkpoint comes first where others have to be
// waited for: a launcher that ends a render gives it a moment only.
int RenderRun::end(Ending ending) {
  if (ranks_.several()) {
    outputs_->writeCheckpoint(*session_);
    if (ending == Ending::stopped) ranks_.saveShare(*session_, *outputs_);
  }
  int exitCode = ending == Ending::stopped ? kExitInterrupted : kExitDone;
  if (const std::optional<Rendered> whole = ranks_.whole(*session_, *outputs_)) exitCode = write(ending, *whole);
  if (outputs_->failed()) exitCode = kExitInput;
  return ranks_.leave(exitCode);
}

// Where a process is lost, each of the others keeps what it has, unless the outputs of all are there. Only the first
// process knows of those.
int RenderRun::endAlone(const RanksError& error) {
  guard_->watch(nullptr);
  if (written_.value_or(false)) {
    tell("wavecrest: error: {}, after all files were written", error.what());
  } else {
    const std::string file = options_.checkpoint.file.empty() ? ranks_.emergencyFile() : options_.checkpoint.file;
    const bool kept = outputs_->writeCheckpoint(*session_, file);
    tell("wavecrest: error: {}; {}{}", error.what(),
         ranks_.first() && !written_.has_value() ? "no image was written; " : "",
         kept ? file + " keeps what this one has rendered, for `wavecrest merge`" : "this one could save nothing more");
  }
  return guard_->signalled() ? kExitInterrupted : kExitFailure;
}

// The files of the whole render, images from the first whole one on. A part without an image of its own needs no whole
// pass, but paths: its checkpoint is what it is for.
int RenderRun::write(Ending ending, const Rendered& rendered) {
  if (!ranks_.several()) outputs_->writeCheckpoint(*session_);
  const RenderStatistics& statistics = rendered.statistics;
  const bool refuses = !options_.outputs.empty() || statistics.paths == 0;
  if (refuses && !outputs_->hasImage(statistics)) {
    outputs_->writeStats(rendered);
    return endWithoutImage(ending, statistics);
  }
  live_->look(true);
  warnOfLosses(options_, kind_, settings_, statistics);
  outputs_->write(rendered);
  written_ = !outputs_->failed();
  if (!options_.outputs.empty() && !outputs_->failed()) live_->showFile(options_.outputs.front());
  showSummary(options_, settings_, kind_, statistics);
  return ending == Ending::stopped ? kExitInterrupted : kExitDone;
}

// Of a render that has no whole image: nothing takes the place of an image that may be there. The checkpoint keeps what
// has been rendered.
int RenderRun::endWithoutImage(Ending ending, const RenderStatistics& statistics) const {
  const char* const what = options_.outputs.empty() ? "checkpoint" : "image";
  const std::string when =
      statistics.paths == 0 ? "before anything was rendered" : "before one whole pass over the film";
  if (ending == Ending::stopped) {
    tellMessage(kind_, fmt::format("interrupted {}; no {} was written", when, what));
    return kExitInterrupted;
  }
  const double passes =
      static_cast<double>(statistics.paths) / static_cast<double>(session_->film().area().pixels.size());
  tell("wavecrest: error: --time: {} s ended {}; no {} was written; expected {}{}{}",
       roundedUpSeconds(statistics.renderSeconds), when, what,
       longerTime(statistics.renderSeconds, statistics.choice ? statistics.choice->seconds : 0, passes),
       options_.checkpoint.file.empty() ? "" : " with --resume", statistics.paths == 0 ? "" : ", or --partial");
  return kExitInput;
}

}  // namespace

void addRenderCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<RenderOptions>();
  const Command command = program.add(
      "render", "render a scene by one method; mpirun and srun have it share the work of several processes");
  addRenderOptions(command, *options);
  command.run([options, command, &exitCode] {
    // A variable is a default, which chains that ask no sampler ignore.
    const bool asksNoSampler = options->method == "mlt" && (options->mlt == "pssmlt" || options->noDirectPass);
    if (asksNoSampler && command.fromVariable("--sampler")) options->sampler = "auto";
    // A part is a checkpoint; it has an image only where one is asked for.
    if (options->outputs.empty() && options->part.empty()) options->outputs = {stemOf(options->scene) + ".exr"};
    exitCode = RenderRun(*options).run();
  });
}

}  // namespace wavecrest
