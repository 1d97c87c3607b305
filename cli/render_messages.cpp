#include "cli/render_messages.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/campaign/render_stats.h"
#include "cli/messages.h"
#include "engine/scene/hash_text.h"
#include "library/inspection_json.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

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
  add("guide", use.learned);
  add("chains", use.chains);
  add("image", use.image);
  text += fmt::format("together {:.1f} MB", static_cast<double>(use.total()) / 1e6);
  if (plan.lightPaths != 0) text += fmt::format("; {} light paths in each iteration", plan.lightPaths);
  return text;
}

// The memory plan as a line of --progress jsonl.
nlohmann::ordered_json toJson(const MemoryPlan& plan) {
  nlohmann::ordered_json memory = memoryJson(plan.use);
  memory["light_paths"] = plan.lightPaths;
  return {{"memory", memory}};
}

// Where samples add to one pixel each although --filter-mode asks to spread them, because the scene's filter is too
// wide.
void warnOfFilter(ProgressKind kind, const Scene& scene, const RenderSettings& settings, bool spreads) {
  if (scene.film.filter == ReconstructionFilter::box || settings.filterMode != FilterMode::spread || spreads) return;
  if (settings.method == Method::mlt) return;  // chains choose one pixel each
  warn(kind,
       fmt::format("the scene's filter reaches further than {} pixels: samples add to one pixel each", kWidestSpread));
}

}  // namespace

void warnOfLimits(ProgressKind kind, const RenderSettings& settings) {
  // The longest path, of the scene: --max-depth is refused where it is more than the method can follow.
  const uint32_t asked = settings.limits.maxDepth, used = withinDepthOfMethod(settings).limits.maxDepth;
  if (used < asked && asked != kUnlimitedDepth) {
    warn(kind, fmt::format("the scene's max_depth of {} is more than {} can follow; {} is used", asked,
                           toString(settings.method), used));
  }
  // The merge radius, relative to the scene's radius.
  if (!strategiesOf(settings.method).merge || !settings.radius) return;
  if (*settings.radius >= 0.5) {
    warn(kind, fmt::format("--radius {:g} blurs over the whole scene; expected a small part of its radius",
                           *settings.radius));
  }
}

void tellPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, ProgressKind kind,
              Method method, const MemoryPlan& memory, bool spreads) {
  if (settings.memoryBytes || memory.use.photonMap > 0) noteLine(kind, toJson(memory), "memory: " + describe(memory));
  warnOfLimits(kind, settings);
  warnOfFilter(kind, scene, settings, spreads);
  if (options.until.relativeError > 0 && strategiesOf(method).merge) {
    warn(kind, "--until-relative-error leaves out the bias of merging, which falls with --radius and with time");
  }
}

void showChoice(ProgressKind kind, Method method, const std::optional<MethodChoice>& choice) {
  if (!choice) return;
  const auto chosen = std::ranges::find(choice->trials, choice->method, &MethodTrial::method);
  const double least = chosen == choice->trials.end() ? 0 : chosen->inefficiency();
  const uint64_t longest = std::ranges::max(choice->trials, {}, &MethodTrial::iterations).iterations;
  std::vector<std::string> trials;
  for (const MethodTrial& trial : choice->trials) {
    const double over = least > 0 ? trial.inefficiency() / least : 1;
    trials.push_back(fmt::format("{} {:.2f}{}", toString(trial.method), over,
                                 trial.iterations < longest ? " (left out early)" : ""));
  }
  noteLine(kind, {{"choice", choiceJson(*choice)}},
           fmt::format("{}: renders by {}; work for the same error, over its own: {}", toString(method),
                       choice->method == method ? "a guide" : toString(choice->method), fmt::join(trials, ", ")));
}

void showPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, const DryPlan& plan) {
  const uint32_t width = scene.film.imageWidth(), height = scene.film.imageHeight();
  printOut("scene    {}, {}x{} pixels, scene_hash {}\n", scene.name, width, height, hashText(scene.hash));
  printOut("method   {}, {} kernels on {}, {} intersector, {} threads\n", toString(settings.method),
           kSpecializationNames[static_cast<size_t>(plan.specialization)], toString(plan.isa),
           kAccelNames[static_cast<size_t>(plan.accel)], settings.threads);
  std::vector<std::string> ends;
  if (const std::optional<uint64_t> iterations = settings.jointIterations()) {
    ends.push_back(fmt::format("after {} spp", *iterations));
  }
  if (settings.seconds) ends.push_back(fmt::format("after {:g} s", *settings.seconds));
  if (options.until.ssim > 0) ends.push_back(fmt::format("once SSIM is {:g}", options.until.ssim));
  if (options.until.relativeError > 0) {
    ends.push_back(fmt::format("once the relative error is {:g}", options.until.relativeError));
  }
  printOut("ends     {}\n", fmt::join(ends, " or "));
  if (const std::optional<MergeRadius>& radius = plan.mergeRadius) {
    printOut("merging  first within {:.4g} of the scene's radius: {:.4g} in its units, {:.2f} pixels, {:.2f} photons\n",
             radius->first, radius->at(0), radius->inPixels(), radius->photonsPerSearch());
  }
  printOut("memory   {}{}\n", describe(plan.memory),
           plan.method == settings.method ? "" : fmt::format("; of {}, if trials choose it", toString(plan.method)));
  if (options.until.relativeError > 0) {
    printOut("         and {:.1f} MB for the films that tell the error\n",
             static_cast<double>(FilmErrorWatch::bytesFor(size_t{width} * height)) / 1e6);
  }
  // Memory that writing an EXR takes besides the plan.
  const auto isExr = [](const std::string& output) { return extensionOf(output) == ".exr"; };
  if (!options.snapshotEvery.empty() || std::any_of(options.outputs.begin(), options.outputs.end(), isExr)) {
    // The file is written block by block and is never in memory as a whole.
    const size_t bytes = exrWritingBytes(width, height);
    printOut("         and {:.1f} MB for the blocks of an EXR while they are compressed\n",
             static_cast<double>(bytes) / 1e6);
  }
  for (const std::string& output : options.outputs) printOut("writes   {}\n", output);
  if (!options.checkpoint.file.empty()) printOut("writes   {}\n", options.checkpoint.file);
  if (!options.stats.empty()) printOut("writes   {}\n", options.stats);
}

// Pixels without samples, samples that were not finite, clamped splats, and paths that
// were cut.
void warnOfLosses(const RenderOptions& options, ProgressKind kind, const RenderSettings& settings,
                  const RenderStatistics& statistics) {
  const StageCounters& counters = statistics.counters;
  if (!statistics.hasWholeImage() && !options.outputs.empty()) {
    warn(kind, "--partial: there was no whole pass over the film; pixels without a sample are black");
  }
  if (counters.nonFinite != 0) {
    warn(kind, fmt::format("{} samples were not finite and count as black", counters.nonFinite));
  }
  if (counters.saturatedSplats != 0) {
    warn(kind, fmt::format("{} splats were too large for the film's sums", counters.saturatedSplats));
  }
  // A limit of depth that was asked for needs no warning. cutThroughput is in units of what a path begins with.
  const uint32_t depth = withinDepthOfMethod(settings).limits.maxDepth;
  if (counters.cutPaths != 0 && (depth < settings.limits.maxDepth || depth == kUnlimitedDepth)) {
    const double paths = static_cast<double>(statistics.paths + statistics.lightPaths);
    warn(kind, fmt::format("{} paths were cut after {} edges; they carried {:.2g} of what all began with",
                           counters.cutPaths, depth, counters.cutThroughput / paths));
  }
}

void showSummary(const RenderOptions& options, const RenderSettings& settings, ProgressKind kind,
                 const RenderStatistics& statistics) {
  std::string files;
  for (const std::string& output : options.outputs) files += (files.empty() ? "" : ", ") + output;
  if (files.empty()) files = options.checkpoint.file;
  // The speed of lt is that of its light paths.
  const uint64_t paths =
      statistics.renderedBy(settings.method) == Method::lt ? statistics.lightPaths : statistics.paths;
  const double seconds = statistics.renderSeconds;
  const double perSecond = seconds > 0 ? static_cast<double>(paths) / seconds : 0;
  noteLine(
      kind,
      {{"outputs", options.outputs},
       {"iterations", statistics.iterations},
       {"render_seconds", seconds},
       {"paths_per_second", perSecond}},
      fmt::format("{}: {} spp in {:.1f} s, {:.2f} M paths/s", files, statistics.iterations, seconds, perSecond * 1e-6));
}

}  // namespace wavecrest
