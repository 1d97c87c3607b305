// wavecrest reference: a scene's reference image, from two independent halves.
#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/campaign/reference_agreement.h"
#include "bench/campaign/render_reference.h"
#include "bench/results/noise_floors.h"
#include "bench/statistics/chains_mislead.h"
#include "bench/until/film_error.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "cli/render_messages.h"
#include "cli/scene_options.h"
#include "engine/inspect/path_classes.h"
#include "engine/plan/render_settings.h"
#include "engine/session/session.h"
#include "engine/tasks/processors.h"
#include "library/option_ranges.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// The goal where no other is asked for.
constexpr double kDefaultRelativeError = 0.01;

// The options as written on the command line; 0 or empty: not given.
struct ReferenceOptions {
  SceneOptions scene;
  std::string method = "auto", time, sampler = "independent", precision = "float", isa = "auto", output;
  double relativeError = 0, radius = kReferenceRadius;
  std::string larger, agreeWith, compact;
  uint64_t spp = 0, seed = 0;
  uint32_t threads = 0;
  std::string progress = "auto";
  bool quiet = false;
};

// One line for each look at the goal. On a terminal it overwrites the line before, until end().
class AdvanceLine {
 public:
  explicit AdvanceLine(ProgressKind kind)
      : kind_(kind),
        overwrites_(kind == ProgressKind::bar || (kind == ProgressKind::automatic && isatty(STDERR_FILENO) != 0)) {}
  ~AdvanceLine() { end(); }
  AdvanceLine(const AdvanceLine&) = delete;
  AdvanceLine& operator=(const AdvanceLine&) = delete;

  void show(const ReferenceInfo& info) {
    if (!showsProgress(kind_)) return;
    if (kind_ == ProgressKind::jsonl) {
      tell(R"({{"render_seconds":{:.3f},"iterations":{},"relative_error":{:.6g}}})", info.renderSeconds,
           info.iterations, info.relativeError);
      return;
    }
    writeStderr(fmt::format("{}{:8.1f} s  {:8} iterations of each half  relative error {:.4f}{}",
                            overwrites_ ? "\r" : "", info.renderSeconds, info.iterations, info.relativeError,
                            overwrites_ ? " " : "\n"));
    open_ = overwrites_;
  }
  // Ends the line, so that other output begins a new one.
  void end() {
    if (open_) writeStderr("\n");
    open_ = false;
  }

 private:
  const ProgressKind kind_;
  const bool overwrites_;
  bool open_ = false;
};

// The method that was named, or the one that suits the scene's path classes (METHODS 8.3).
ReferenceChoice chosenMethod(const ReferenceOptions& options, const Scene& scene) {
  if (options.method == "auto") return classifyPaths(scene).reference;
  return {.method = parseMethodOption("--method", options.method), .biased = false, .reason = "asked for"};
}

// Settings of both halves. settings.seed becomes a seed for each of them (referenceSeed).
RenderSettings settingsFor(const ReferenceOptions& options, const Scene& scene, Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.sampler = parseSamplerOption("--sampler", options.sampler);
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.isa = parseIsaOption(options.isa);
  settings.seed = options.seed;
  settings.threads = threadsOrAll(options.threads);
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  if (options.radius != kReferenceRadius && !mergesPaths(method)) {
    throw UsageError(
        fmt::format("--radius: {} does not merge; expected {}", toString(method), methodsWith(mergesPaths)));
  }
  settings.radius = options.radius;
  settings.roulette = Roulette::efficiency;  // another roulette has the same limit, so any reference can go on
  return settings;
}

// All goals that were asked for. The first that is reached ends the render.
ReferenceGoal goalOf(const ReferenceOptions& options) {
  ReferenceGoal goal;
  if (options.relativeError > 0) goal.relativeError = options.relativeError;
  if (!options.time.empty()) goal.seconds = parseDuration("--time", options.time);
  if (options.spp != 0) goal.iterations = options.spp;
  if (goal.relativeError || goal.seconds || goal.iterations) return goal;
  if (options.larger.empty()) {
    goal.relativeError = kDefaultRelativeError;
  } else {
    goal.iterations = 1;  // what the larger one has is enough
  }
  return goal;
}

// The reference of --agree-with, which has to be comparable with one of the scene. Null where the option was not given.
std::unique_ptr<const Reference> otherReference(const ReferenceOptions& options, const Scene& scene) {
  if (options.agreeWith.empty()) return nullptr;
  auto other = std::make_unique<const Reference>(readReference(options.agreeWith));
  const uint32_t width = scene.film.imageWidth(), height = scene.film.imageHeight();
  if (other->mean.width != width || other->mean.height != height) {
    throw InputError(fmt::format("{}: is {}x{} pixels; expected {}x{}", options.agreeWith, other->mean.width,
                                 other->mean.height, width, height));
  }
  try {
    compareReferences(*other, *other);  // has the same needs as the comparison with what will be rendered
  } catch (const ReferenceComparisonError& error) {
    throw InputError(fmt::format("{}: {}", options.agreeWith, error.what()));
  }
  return other;
}

// Prints how good the reference is.
void showReference(const std::string& output, const Reference& reference, ProgressKind kind) {
  printOut("{}: {} iterations of each half, {:.1f} s, relative error {:.5f}\n", output, reference.info.iterations,
           reference.info.renderSeconds, reference.info.relativeError);
  for (const auto& [name, value] : reference.noiseFloors) printOut("noise floor {:8} {:.6g}\n", name, value);
  if (reference.info.isBiased()) {
    printOut("biased by merging within {:g} of the scene's radius; compare it with one of half of that\n",
             reference.info.radius);
  }
  if (reference.info.method == toString(Method::mlt)) warn(kind, fmt::format("{}: {}", output, kChainsMislead));
  for (const std::string& floor : unmetFloors(reference.noiseFloors)) {
    warn(kind, fmt::format("{}: {}; render it for longer", output, floor));
  }
}

int runReference(const ReferenceOptions& options) {
  // Checks options and file names before anything takes time.
  const std::filesystem::path scenePath = findScene(options.scene.scene);
  const std::string output = options.output.empty() ? stemOf(options.scene) + ".reference.exr" : options.output;
  FileCheck files;
  files.input("the scene", scenePath);
  files.reference("-o", output);
  if (!options.compact.empty()) files.reference("--compact", options.compact);
  if (!options.agreeWith.empty()) files.input("--agree-with", options.agreeWith);
  if (!options.larger.empty()) files.input("--from", options.larger);
  const ReferenceGoal goal = goalOf(options);
  const ProgressKind kind =
      quietIf(options.quiet, static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames)));
  // Loads the scene and chooses the method.
  InterruptGuard guard(messageLine(kind, "interrupted while loading; " + output + " is as it was"));
  const Scene scene = loadScene(options.scene, kind);
  printNotes(scene, kind);
  for (const std::string& file : scene.files) files.input("the scene", file);
  ReferenceChoice method = chosenMethod(options, scene);
  RenderSettings settings = settingsFor(options, scene, method.method);
  // A reference says by what it was rendered, and so whether it is biased.
  if (isChosenByTrials(method.method)) {
    settings.method = Session::create(scene, settings)->statistics().renderedBy(method.method);
    method = {.method = settings.method, .biased = false, .reason = "chosen by the trials of " + options.method};
  }
  const std::unique_ptr<const Reference> other = otherReference(options, scene);
  noteLine(kind, {{"method", toString(method.method)}, {"reason", method.reason}},
           fmt::format("{} by {}: {}", scene.name, toString(method.method), method.reason));
  warnOfLimits(kind, settings);

  // SIGUSR1 interrupts one half. The request waits in saveNow until both halves have the same number of iterations, as
  // only then can the reference be saved.
  bool saveNow = false;
  AdvanceLine line(kind);
  const ReferenceHooks hooks{.session = {.watch = [&](Session* session) { guard.watch(session); },
                                         .goesOn =
                                             [&] {
                                               if (guard.interrupted()) return false;
                                               saveNow |= guard.takeSaveRequest();
                                               guard.goOn();
                                               return !guard.interrupted();
                                             },
                                         .idle = [&](bool idle) { guard.setIdle(idle); }},
                             .stopped = [&] { return guard.interrupted(); },
                             .saveNow = [&] { return std::exchange(saveNow, false) || guard.takeSaveRequest(); },
                             .advance = [&](const ReferenceInfo& info) { line.show(info); }};
  if (!options.larger.empty()) beginReference(scene, settings, options.larger, output);
  // Renders both halves. renderReference writes the file, also after a signal.
  const Reference reference = renderReference(scene, settings, method.reason, goal, output, hooks);
  line.end();
  if (reference.info.iterations == 0) {
    tellMessage(kind, "interrupted before anything was rendered; no reference was written");
    return kExitInterrupted;
  }
  if (!goal.seconds && !goal.iterations && isBlack(reference.mean.pixels) && !guard.interrupted()) {
    throw InputError(
        fmt::format("{}: is black after {} iterations of each half, so its relative error is not known; expected a "
                    "scene that the method finds light in, or --time or --spp",
                    output, reference.info.iterations));
  }
  if (!options.compact.empty() && !guard.interrupted()) writeCompactReference(options.compact, reference);
  showReference(output, reference, kind);
  // Checks it against another reference of the scene.
  if (other && !guard.interrupted()) {
    const Agreement agreement = compareReferences(reference, *other);
    printOut("{} and {} {}\n", output, options.agreeWith, agreement.describe());
    if (!agreement.agrees()) {
      tellFailedCheck(kind, fmt::format("{} and {} are of different truths", output, options.agreeWith));
      return kExitCheck;
    }
  }
  return guard.interrupted() ? kExitInterrupted : kExitDone;
}

}  // namespace

void addReferenceCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<ReferenceOptions>();
  const Command command = program.add("reference", "render a scene's reference image, or go on with it");
  addSceneOptions(command, options->scene);
  // Method and goals.
  command.add("-m,--method", options->method, "auto: by the scene's classes of paths; or a method").showDefault();
  command
      .add("--until-relative-error", options->relativeError,
           "stop when a pixel is off by this share of the brightness around it, in the mean, after 8 iterations at "
           "least; 0.01 if nothing else is asked for")
      .between(1e-9, 1.0);
  command.add("--time", options->time, "stop after this much render time in all: 10m, 6h");
  command.add("--spp", options->spp, "stop after N iterations of each half").atLeast(1);
  // Settings.
  command.add("--threads", options->threads, "worker threads; default: all cores").between(kThreadRange);
  command.add("--seed", options->seed, "seed of both halves, which differ in its high word").between(0, 0xffffffff);
  command.add("--sampler", options->sampler, "independent or sobol").showDefault();
  command.add("--precision", options->precision, "float or double").showDefault();
  command.add("--isa", options->isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--radius", options->radius, "first merge radius of ppm, bpm and vcm")
      .showDefault()
      .between(kRadiusRange);
  // Outputs and checks.
  command.add("-o,--output", options->output, "EXR file; default: SCENE.reference.exr; goes on if it exists");
  command.add("--from", options->larger,
              "begin with a reference of the same scene of a multiple of the size, whose pixels are averaged: exact "
              "with a box filter");
  command.add("--compact", options->compact,
              "EXR file: the same in half floats, a seventh of the size; to measure against, not to go on with");
  command.add("--agree-with", options->agreeWith,
              "another reference of the scene: fail with exit code 4 where a z-test says that they differ in truth");
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  command.addFlag("--quiet", options->quiet, "print the result only: neither progress nor notes");
  command.run([options, command, &exitCode] {
    // The variable's auto is for `render`.
    if (options->sampler == "auto" && command.fromVariable("--sampler")) options->sampler = ReferenceOptions().sampler;
    exitCode = runReference(*options);
  });
}

}  // namespace wavecrest
