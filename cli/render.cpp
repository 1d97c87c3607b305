// wavecrest render: one scene, one method, images and statistics out.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/checkpointing.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/live_render.h"
#include "cli/messages.h"
#include "cli/pinning.h"
#include "cli/progress.h"
#include "cli/render_outputs.h"
#include "cli/scene_options.h"
#include "cli/until_goal.h"
#include "engine/load/load.h"
#include "engine/plan/render_plan.h"
#include "engine/session/session.h"
#include "engine/session/snapshots.h"
#include "library/option_values.h"
#include "library/render_settings.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image_io.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// The library's options of a render, and those that only the command line has.
struct RenderOptions : api::RenderOptions {
  SceneOptions scene;
  std::string snapshotEvery, stats, progress = "auto";
  std::vector<std::string> outputs;
  bool dryRun = false, pin = false;
  CheckpointOptions checkpoint;
  UntilRequest until;
  LiveOptions live;
};

// The engine's settings: what the options leave open comes from the scene and the machine. Stages are timed only where
// statistics are written.
RenderSettings resolved(const RenderOptions& options, const Scene& scene) {
  RenderSettings settings = renderSettings(options, scene);
  // A goal ends the render, not the scene's number of samples.
  if (options.spp == 0 && options.until.any()) settings.iterations.reset();
  settings.measureStages = !options.stats.empty();
  return settings;
}

// Makes the session. A memory budget that is too small is a UsageError of --memory.
std::unique_ptr<Session> createSession(const Scene& scene, const RenderSettings& settings) {
  try {
    return Session::create(scene, settings);
  } catch (const MemoryBudgetError& error) {
    throw UsageError(fmt::format("--memory: {}", error.what()));
  }
}

// One line: the parts in MB, their sum, and the light paths where there are any.
std::string describe(const MemoryPlan& plan) {
  const MemoryUse& use = plan.use;
  std::string text;
  const auto add = [&](const char* name, size_t bytes) {
    if (bytes != 0) text += fmt::format("{} {:.1f} MB, ", name, static_cast<double>(bytes) / 1e6);
  };
  add("scene", use.scene);
  add("waves", use.waves);
  add("film", use.film);
  add("splats", use.splats);
  add("light vertices", use.lightVertices);
  add("photon map", use.photonMap);
  add("chains", use.chains);
  add("image", use.image);
  text += fmt::format("together {:.1f} MB", static_cast<double>(use.total()) / 1e6);
  if (plan.lightPaths != 0) text += fmt::format("; {} light paths in each iteration", plan.lightPaths);
  return text;
}

// Warns, before the render, of settings that the render cannot follow or that blur the image.
void warnOfLimits(ProgressKind kind, const RenderSettings& settings) {
  if (settings.precision == Precision::fast && settings.accel != Accel::embree) {
    warn(kind, "--precision fast is float's but for --accel embree");
  }
  // The merge radius, relative to the scene's radius.
  if (!strategiesOf(settings.method).merge) return;
  if (settings.radius < kSmallestRadius) {
    warn(kind,
         fmt::format("--radius {:g} is below what positions resolve; {:g} is used", settings.radius, kSmallestRadius));
  } else if (settings.radius >= 0.5) {
    warn(kind,
         fmt::format("--radius {:g} blurs over the whole scene; expected a small part of its radius", settings.radius));
  }
}

// Warns where samples add to one pixel each although --filter-mode asks to spread them, because the scene's filter is
// too wide.
void warnOfFilter(ProgressKind kind, const Scene& scene, const RenderSettings& settings, const Session& session) {
  const bool spreads = session.film().spreads();
  if (scene.film.filter == ReconstructionFilter::box || settings.filterMode != FilterMode::spread || spreads) return;
  if (settings.method == Method::mlt) return;  // chains choose one pixel each
  warn(kind,
       fmt::format("the scene's filter reaches further than {} pixels: samples add to one pixel each", kWidestSpread));
}

// Warns of what the image lacks: pixels without samples, samples that were not finite, clamped splats, and paths that
// were cut.
void warnOfLosses(ProgressKind kind, const RenderSettings& settings, const RenderStatistics& statistics) {
  const StageCounters& counters = statistics.counters;
  if (statistics.iterations == 0 && settings.method != Method::mlt) {  // which has no samples of pixels
    warn(kind, "the render ended before all pixels had a sample; those without are black");
  }
  if (counters.nonFinite != 0) {
    warn(kind, fmt::format("{} samples were not finite and count as black", counters.nonFinite));
  }
  if (counters.saturatedSplats != 0) {
    warn(kind, fmt::format("{} splats were too large for the film's sums", counters.saturatedSplats));
  }
  // A limit of depth that was asked for needs no warning. cutThroughput is in units of what a path begins with.
  if (counters.cutPaths != 0 && settings.limits.maxDepth == kUnlimitedDepth) {
    const double paths = static_cast<double>(statistics.paths + statistics.lightPaths);
    warn(kind,
         fmt::format("{} paths were cut after {} edges; they carried {:.2g} of what all began with", counters.cutPaths,
                     withinDepthOfMethod(settings).limits.maxDepth, counters.cutThroughput / paths));
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

// The memory plan as a line of --progress jsonl.
nlohmann::ordered_json toJson(const MemoryPlan& plan) {
  const MemoryUse& use = plan.use;
  return {{"memory",
           {{"scene_bytes", use.scene},
            {"wave_bytes", use.waves},
            {"film_bytes", use.film},
            {"splat_bytes", use.splats},
            {"light_vertex_bytes", use.lightVertices},
            {"photon_map_bytes", use.photonMap},
            {"chain_bytes", use.chains},
            {"image_bytes", use.image},
            {"total_bytes", use.total()},
            {"light_paths", plan.lightPaths}}}};
}

// What is shown after a render: warnings, and one line with its outputs, its iterations and its speed.
void showSummary(const RenderOptions& options, const RenderSettings& settings, ProgressKind kind,
                 const Session& session) {
  const RenderStatistics statistics = session.statistics();
  warnOfLosses(kind, settings, statistics);
  std::string files;
  for (const std::string& output : options.outputs) files += (files.empty() ? "" : ", ") + output;
  // The speed of lt is that of its light paths.
  const uint64_t paths = settings.method == Method::lt ? statistics.lightPaths : statistics.paths;
  const double seconds = statistics.renderSeconds;
  const double perSecond = seconds > 0 ? static_cast<double>(paths) / seconds : 0;
  noteLine(kind,
           {{"outputs", options.outputs},
            {"iterations", statistics.iterations},
            {"render_seconds", seconds},
            {"paths_per_second", perSecond}},
           fmt::format("{}: {} spp in {:.1f} s, {:.2f} M paths/s",
                       files.empty() ? "no -o, so the image was not kept" : files, statistics.iterations, seconds,
                       perSecond * 1e-6));
}

// What --dry-run prints on stdout: scene, kernels, end, memory and outputs of the render.
void showPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings,
              const Session& session) {
  const RenderStatistics statistics = session.statistics();
  fmt::print("scene    {}, {}x{} pixels, scene_hash {:016x}\n", scene.name, session.film().area().width,
             session.film().area().height, scene.hash);
  fmt::print("method   {}, {} kernels on {}, {} intersector, {} threads\n", toString(settings.method),
             kSpecializationNames[static_cast<size_t>(statistics.specialization)], toString(statistics.isa),
             kAccelNames[static_cast<size_t>(statistics.accel)], settings.threads);
  std::vector<std::string> ends;
  if (settings.iterations) ends.push_back(fmt::format("after {} spp", *settings.iterations));
  if (settings.seconds) ends.push_back(fmt::format("after {:g} s", *settings.seconds));
  if (options.until.ssim > 0) ends.push_back(fmt::format("once SSIM is {:g}", options.until.ssim));
  if (options.until.relativeError > 0) {
    ends.push_back(fmt::format("once the relative error is {:g}", options.until.relativeError));
  }
  fmt::print("ends     {}\n", fmt::join(ends, " or "));
  fmt::print("memory   {}\n", describe(session.memoryPlan()));
  // Memory that writing an EXR takes besides the plan.
  const auto isExr = [](const std::string& output) { return output.ends_with(".exr"); };
  if (std::any_of(options.outputs.begin(), options.outputs.end(), isExr)) {
    // The file is written block by block and is never in memory as a whole.
    const size_t bytes = exrWritingBytes(session.film().area().width, session.film().area().height);
    fmt::print("         and {:.1f} MB for the blocks of an EXR while they are compressed\n",
               static_cast<double>(bytes) / 1e6);
  }
  for (const std::string& output : options.outputs) fmt::print("writes   {}\n", output);
  if (!options.checkpoint.file.empty()) fmt::print("writes   {}\n", options.checkpoint.file);
  if (!options.stats.empty()) fmt::print("writes   {}\n", options.stats);
  if (options.outputs.empty()) fmt::print("writes   no image: there is no -o\n");
}

enum class Ending { complete, stopped, stoppedBeforeAnyPath };

// With --resume: restores the session and the outputs from the checkpoint, if there is one, and tells at which
// iteration the render goes on.
void goOn(const std::unique_ptr<Checkpoint>& earlier, const CheckpointOptions& options, const Scene& scene,
          const RenderSettings& settings, ProgressKind kind, Session& session, RenderOutputs& outputs) {
  if (!options.resume) return;
  if (earlier) {
    earlier->restore(scene, settings, session);
    outputs.goOnFrom(earlier->notes(), session);
  }
  const uint64_t iterations = session.statistics().iterations;
  noteLine(kind, {{"checkpoint", options.file}, {"resumed_from", iterations}},
           options.file + (earlier ? fmt::format(": goes on after {} iterations", iterations)
                                   : ": there is none yet; begins from the start"));
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
    if (save && session.statistics().paths > 0) outputs.write(session);
    guard.goOn();
    return true;
  };
  // From here on signals interrupt the session.
  guard.watch(&live.interruptible(session));
  std::optional<uint64_t> goalPaths;
  if (settings.iterations) goalPaths = *settings.iterations * session.film().area().pixels.size();
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
  // Signals find no session from here on. An image is worth saving if it has any path.
  guard.watch(nullptr);
  if (!stopped) return Ending::complete;
  return session.statistics().paths > 0 ? Ending::stopped : Ending::stoppedBeforeAnyPath;
}

int runRender(const RenderOptions& options) {
  // Checks options and output names before anything takes time.
  const SnapshotSchedule schedule = parseSnapshotSchedule("--snapshot-every", options.snapshotEvery);
  const auto kind = static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames));
  const OutputNames names{options.outputs, options.stats, options.snapshotEvery, options.checkpoint.file};
  const std::string nothing = "wavecrest: interrupted before anything was rendered; no image was written";
  InterruptGuard guard(nothing);
  checkOutputs(names, {findScene(options.scene.scene)});
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
  checkOutputs(names, scene.files);
  const double loadSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Makes the session. Where the image depends on it, light paths are cut into waves as the checkpoint says.
  RenderSettings settings = resolved(options, scene);
  if (earlier) earlier->cutAlike(settings);
  if (options.pin) settings.placement = pinnedPlacement(settings.threads, kind);
  std::unique_ptr<Session> session = createSession(scene, settings);
  // The memory plan is shown with --memory and for photon maps, whose size depends on the number of light paths.
  if (settings.memoryBytes || session->memoryPlan().use.photonMap > 0) {
    noteLine(kind, toJson(session->memoryPlan()), "memory: " + describe(session->memoryPlan()));
  }
  warnOfLimits(kind, settings);
  warnOfFilter(kind, scene, settings, *session);
  if (options.until.relativeError > 0 && strategiesOf(settings.method).merge) {
    warn(kind, "--until-relative-error leaves out the bias of merging, which falls with --radius and with time");
  }
  std::optional<UntilGoal> until;
  if (options.until.any()) until.emplace(untilGoal(options, settings, session->film().area()));
  if (options.dryRun) {
    showPlan(options, scene, settings, *session);
    return kExitDone;
  }
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
  // Without any path there is nothing to write. Else checkpoint and outputs are written, however the render ended.
  if (ending == Ending::stoppedBeforeAnyPath) {
    tell("{}", nothing);
    return kExitInterrupted;
  }
  live.look(true);
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
  addSceneOptions(command, options->scene);
  // Method, end and threads.
  command.add("-m,--method", options->method, "light-transport method").showDefault();
  command.add("--time", options->time, "stop after this much render time: 6s, 2m, 1h30m");
  command
      .add("--spp", options->spp,
           "stop after N iterations: paths, of mlt mutations, per pixel; default without --time: "
           "the scene's sample_count, or 4")
      .atLeast(1);
  command.add("--threads", options->threads, "worker threads; default: all cores").between(1, 4096);
  command.addFlag("--pin", options->pin, "bind threads to cores and spread shared memory over their nodes");
  // Samples and paths.
  command.add("--seed", options->seed, "seed of all random numbers").showDefault();
  command.add("--sampler", options->sampler, "independent or sobol").showDefault();
  command
      .add("--filter-mode", options->filterMode,
           "spread: camera samples add to all pixels that the filter reaches; sample: to one")
      .showDefault();
  command.add("--max-depth", options->maxDepth, "edges of the longest path; -1: unlimited")
      .between(1, kUnlimitedDepth, -1);
  command.add("--rr-depth", options->rrDepth, "first vertex where roulette may end a path")
      .between(1, std::numeric_limits<int>::max());
  // Kernels and intersector.
  command.add("--precision", options->precision, "float, double, or fast: float with Embree's faster tests")
      .showDefault();
  command.add("--isa", options->isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--accel", options->accel, "intersector: auto, small, bvh or embree").showDefault();
  command.add("--instances", options->instances, "of shape groups: auto, expand into copies, or keep").showDefault();
  command.add("--wave", options->wave, "paths per wave").showDefault().between(16, 1 << 20);
  // Merging, connections and memory.
  command.add("--radius", options->radius, "first merge radius of ppm, bpm and vcm, relative to the bounding sphere")
      .showDefault()
      .between(1e-9, 10.0);
  command.add("--radius-alpha", options->radiusAlpha, "how slowly the radius shrinks, 0 to 1")
      .showDefault()
      .between(0.0, 1.0);
  command
      .add("--light-paths", options->lightPaths,
           "light paths of an iteration of ppm, bpm or vcm; default: as many as pixels")
      .between(1, int64_t{1} << 32);
  command
      .add("--connection-roulette", options->connectionRoulette,
           "bpt, vcm: join connections below this part of a typical pixel's brightness by chance; 0: join all")
      .showDefault()
      .between(0.0, 100.0);
  command.addFlag("--direct-pass", options->directPass, "ppm: direct light by next event estimation, not from photons");
  command.add("--memory", options->memory, "budget, as 800M or 2GiB: fewer light paths of ppm, bpm and vcm if need be");
  // Markov chains.
  command.add("--mlt", options->mlt, "what the chains of mlt walk in: pssmlt, mmlt or pathspace; default: mmlt");
  command.add("--chains", options->chains, "Markov chains of mlt").showDefault().between(1, 1 << 24);
  command.add("--bootstrap", options->bootstrap, "independent samples from which chains start")
      .showDefault()
      .between(1, 1 << 28);
  command.add("--restart", options->restart, "steps before chains start anew; default: 16 mutations to a sample")
      .between(1, 1 << 28);
  command.addFlag("--no-direct-pass", options->noDirectPass, "mmlt and pathspace: chains render direct light too");
  // Snapshots, goals, checkpoints and outputs.
  command.add("--snapshot-every", options->snapshotEvery, "snapshots at this interval, or 'log'");
  command
      .add(
          "--until-relative-error", options->until.relativeError,
          "stop when the image's relative RMSE against its expectation is E or less, with 95 % confidence; not for mlt")
      .between(1e-5, 1.0);
  command.add("--until-ssim", options->until.ssim, "stop when the SSIM against --reference is S").between(1e-9, 1.0);
  command.add("--reference", options->until.reference, "image that --until-ssim compares with");
  addCheckpointOptions(command, options->checkpoint);
  addLiveOptions(command, options->live);
  command.add("-o,--output", options->outputs, "image file: .exr, .png or .pfm; repeatable").repeatable();
  command.add("--stats", options->stats, "write statistics as JSON; - for stdout");
  command.addFlag("--dry-run", options->dryRun, "print plan, memory and outputs, and render nothing");
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  command.run([options, &exitCode] { exitCode = runRender(*options); });
}

}  // namespace wavecrest
