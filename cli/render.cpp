// wavecrest render: one scene, one method, images and statistics out.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/pinning.h"
#include "cli/progress.h"
#include "cli/render_messages.h"
#include "cli/render_options.h"
#include "cli/render_outputs.h"
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

// The share of a render that --part asks for. Throws UsageError where there is none.
RenderSettings settingsOfPart(const RenderOptions& options, const RenderSettings& settings) {
  const auto [part, parts] = parsePart("--part", options.part);
  if (options.checkpoint.file.empty()) {
    throw UsageError("--part: its result is a checkpoint; expected --checkpoint FILE");
  }
  if (!settings.iterations) throw UsageError("--part: a part of how many iterations is not known; expected --spp N");
  const bool mlt = settings.method == Method::mlt;
  if (mlt && !options.outputs.empty()) {
    throw UsageError("--part: some of the chains of mlt make no image; expected no -o, but `wavecrest merge -o`");
  }
  if (settings.method == Method::gpt && settings.guide != GuideTarget::off) {
    throw UsageError(
        "--part: gpt draws directions by what all earlier iterations have learned, and a part has only its "
        "own; expected another method, or --guide off");
  }
  const uint64_t most = mlt ? settings.metropolis.chains : *settings.iterations;
  if (parts > most) {
    throw UsageError(fmt::format("--part {}: there are {} {}; expected no more parts than that", options.part, most,
                                 mlt ? "chains" : "iterations"));
  }
  return settingsOfShare(settings, part - 1, parts);
}

// The engine's settings: what the options leave open comes from the scene and the machine. Stages are timed only where
// statistics are written.
RenderSettings resolved(const RenderOptions& options, const Scene& scene) {
  RenderSettings settings = renderSettings(options, scene);
  // A goal ends the render, not the scene's number of samples.
  if (options.spp == 0 && options.until.any()) settings.iterations.reset();
  settings.measureStages = !options.stats.empty();
  return options.part.empty() ? settings : settingsOfPart(options, settings);
}

// What `make` makes: a session or a plan. A memory budget that is too small is a UsageError of --memory.
template <class Make>
auto withinMemory(Make make) {
  try {
    return make();
  } catch (const MemoryBudgetError& error) {
    throw UsageError(fmt::format("--memory: {}", error.what()));
  }
}

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

// Before a render: the memory plan, with --memory and for photon maps, whose size depends on the number of light paths,
// and warnings of settings. spreads: the film.
void tellPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, ProgressKind kind,
              const MemoryPlan& memory, bool spreads) {
  if (settings.memoryBytes || memory.use.photonMap > 0) showMemory(kind, memory);
  warnOfLimits(kind, settings);
  warnOfFilter(kind, scene, settings, spreads);
  if (options.until.relativeError > 0 && strategiesOf(settings.method).merge) {
    warn(kind, "--until-relative-error leaves out the bias of merging, which falls with --radius and with time");
  }
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

// Renders to the end or to a signal. Snapshots and requested saves are written on the way.
Ending render(Session& session, const RenderSettings& settings, const SnapshotSchedule& schedule,
              std::optional<UntilGoal>& until, ProgressKind kind, InterruptGuard& guard, RenderOutputs& outputs,
              LiveRender& live) {
  bool stopped = false;
  // Called after an interrupt. A signal to stop ends the render. A pause writes a checkpoint, a save images as well;
  // then the session goes on.
  const auto goesOn = [&] {
    stopped = guard.interrupted();
    if (stopped) return false;
    const bool save = guard.takeSaveRequest();
    if (guard.takePauseRequest() || save) outputs.writeCheckpoint(session);
    if (save && outputs.hasImage(session)) {
      outputs.save(session);
    } else if (save) {
      noteLine(kind, {{"left_out", "save"}}, "not saved, as there was no whole pass over the film yet");
    }
    guard.goOn();
    return true;
  };
  // From here on signals interrupt the session.
  guard.watch(&live.interruptible(session));
  std::optional<uint64_t> goalPaths;
  if (settings.iterations) {
    // Of mlt a part has some of the chains of all iterations.
    const uint64_t parts = settings.method == Method::mlt ? settings.share.parts : 1;
    goalPaths = pathsOf(*settings.iterations, session.film().area()) / parts;
  }
  {
    // Progress lives in a block of its own: its end completes the line on the terminal.
    const Progress progress(kind, session, settings.seconds, goalPaths);
    // A goal of quality renders in steps of its own, without snapshots.
    if (until) {
      do {
        outputs.setUntil(until->render(session, settings));
      } while (session.interrupted() && goesOn());
    } else {
      renderWithSnapshots(
          session, settings, schedule,
          [&](unsigned number) {
            live.look(false);
            outputs.writeSnapshot(session, number);
          },
          goesOn, outputs.nextSnapshot(schedule, session));
    }
  }
  // Signals find no session from here on.
  guard.watch(nullptr);
  return stopped ? Ending::stopped : Ending::complete;
}

// The end of a render that has no whole image: nothing takes the place of an image that may be there. The checkpoint
// keeps what has been rendered.
int endWithoutImage(Ending ending, const Session& session, const CheckpointOptions& checkpoint,
                    RenderOutputs& outputs) {
  outputs.writeCheckpoint(session);
  outputs.writeStats(session);
  const RenderStatistics statistics = session.statistics();
  const std::string when =
      statistics.paths == 0 ? "before anything was rendered" : "before one whole pass over the film";
  if (ending == Ending::stopped) {
    tell("wavecrest: interrupted {}; no image was written", when);
    return kExitInterrupted;
  }
  // A pass takes about as much longer as pixels are missing.
  std::string longer = "a longer time";
  if (statistics.paths > 0) {
    const double passes =
        static_cast<double>(statistics.paths) / static_cast<double>(session.film().area().pixels.size());
    longer = fmt::format("more than {:.1g} s", statistics.renderSeconds / std::min(passes, 1.0));
  }
  tell("wavecrest: error: --time: {:.2g} s ended {}; no image was written; expected {}{}{}", statistics.renderSeconds,
       when, longer, checkpoint.file.empty() ? "" : " with --resume", statistics.paths == 0 ? "" : ", or --partial");
  return kExitInput;
}

// Where the image goes without -o: SCENE.exr in the working directory.
std::string defaultOutput(const std::string& scene) {
  return scene == kStandardStream ? "stdin.exr" : findScene(scene).stem().string() + ".exr";
}

int runRender(const RenderOptions& options) {
  // Checks options and output names before anything takes time.
  const SnapshotSchedule schedule = parseSnapshotSchedule("--snapshot-every", options.snapshotEvery);
  const ProgressKind kind =
      quietIf(options.quiet, static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames)));
  if (options.outputs.empty() && !options.snapshotEvery.empty()) {
    throw UsageError("--snapshot-every: snapshots of a part are named after its image; expected -o FILE.exr");
  }
  const OutputNames names{options.outputs,         options.stats,    options.snapshotEvery,
                          options.checkpoint.file, options.exposure, options.partial};
  const std::string nothing = "wavecrest: interrupted before anything was rendered; no image was written";
  InterruptGuard guard(nothing);
  checkOutputs(names, {findScene(options.scene.scene)}, options.until.reference);
  // Locks the checkpoint, and reads it with --resume.
  Checkpointing checkpointing(options.checkpoint);
  std::unique_ptr<Checkpoint> earlier = checkpointing.takeEarlier();
  // Removes temporary files of a render that was killed while it wrote its images. The lock keeps other processes from
  // going on with this render at the same time.
  if (earlier) {
    for (const std::string& output : options.outputs) removeTemporaries(output);
  }
  // Loads the scene. Only then are all its files known, so outputs are checked against them once more.
  const auto begin = std::chrono::steady_clock::now();
  const Scene scene = loadScene(options.scene, kind);
  printNotes(scene, kind);
  checkOutputs(names, scene.files, options.until.reference);
  const double loadSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Makes the session, or only plans it. Where the image depends on it, light paths are cut into waves as the
  // checkpoint says.
  RenderSettings settings = resolved(options, scene);
  if (earlier) earlier->cutAlike(settings);
  if (options.pin) settings.placement = pinnedPlacement(settings.threads, kind);
  std::optional<UntilGoal> until;
  if (options.until.any()) until.emplace(untilGoal(options, settings, filmOutline(scene.film)));
  if (options.dryRun) {
    const DryPlan plan = withinMemory([&] { return planWithoutSession(scene, settings); });
    tellPlan(options, scene, settings, kind, plan.memory, plan.spreads);
    showPlan(options, scene, settings, plan);
    return kExitDone;
  }
  std::unique_ptr<Session> session = withinMemory([&] { return Session::create(scene, settings); });
  tellPlan(options, scene, settings, kind, session->memoryPlan(), session->film().spreads());
  // Connects viewers and outputs, and goes on from the checkpoint.
  LiveRender live(options.live, scene, settings, kind, session);
  RenderOutputs outputs(names, scene, settings, loadSeconds, kind);
  goOn(earlier, options.checkpoint, scene, settings, kind, *session, outputs);
  earlier.reset();
  // Renders, with a checkpoint every now and then.
  std::optional<CheckpointTimer> timer;
  if (!options.checkpoint.file.empty()) timer.emplace(guard, checkpointing.seconds());
  const Ending ending = render(*session, settings, schedule, until, kind, guard, outputs, live);
  timer.reset();
  if (until) noteLine(kind, {{"until", outputs.until()}}, UntilGoal::describe(outputs.until()));
  // Checkpoint and outputs are written however the render ended, images from the first whole one on. A part without an
  // image of its own needs no whole pass: its checkpoint is what it is for.
  const bool refuses = !options.outputs.empty() || (ending == Ending::stopped && session->statistics().paths == 0);
  if (refuses && !outputs.hasImage(*session)) return endWithoutImage(ending, *session, options.checkpoint, outputs);
  live.look(true);
  warnOfLosses(kind, settings, session->statistics());
  outputs.writeCheckpoint(*session);
  outputs.write(*session);
  if (!options.outputs.empty() && !outputs.failed()) live.showFile(options.outputs.front());
  showSummary(options, settings, kind, *session);
  if (outputs.failed()) return kExitInput;
  return ending == Ending::stopped ? kExitInterrupted : kExitDone;
}

}  // namespace

void addRenderCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<RenderOptions>();
  const Command command = program.add("render", "render a scene by one method");
  addRenderOptions(command, *options);
  command.run([options, &exitCode] {
    // A part is a checkpoint; it has an image only where one is asked for.
    if (options->outputs.empty() && options->part.empty()) options->outputs = {defaultOutput(options->scene.scene)};
    exitCode = runRender(*options);
  });
}

}  // namespace wavecrest
