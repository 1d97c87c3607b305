#include "cli/render_options.h"

#include <fmt/core.h>

#include "cli/commands.h"
#include "engine/methods/method_list.h"
#include "library/option_ranges.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

// What the methods that join paths, merge, learn or walk in chains have of their own.
void addMethodOptions(const Command& command, RenderOptions& options) {
  // Merging, connections and memory.
  command
      .add("--radius", options.radius,
           "first merge radius of ppm, bpm and vcm, relative to the bounding sphere; auto: by view and photons")
      .betweenOrAuto(kRadiusRange);
  command.add("--radius-alpha", options.radiusAlpha, "how slowly the radius shrinks, 0 to 1")
      .showDefault()
      .between(kRadiusAlphaRange);
  command
      .add("--merge-vertices", options.mergeVertices,
           "vcm: camera paths merge at all vertices, as in the study, or at the first that is not purely specular")
      .showDefault();
  command
      .add("--light-paths", options.lightPaths,
           "light paths of an iteration of ppm, bpm or vcm; default: as many as pixels, of ppm and bpm at least 4096")
      .between(kLightPathRange);
  command
      .add("--connection-roulette", options.connectionRoulette,
           "bpt, vcm: join connections below this part of a typical pixel's brightness by chance; 0: join all")
      .showDefault()
      .between(kConnectionRouletteRange);
  command.addFlag("--direct-pass", options.directPass, "ppm: direct light by next event estimation, not from photons");
  command
      .add("--guide", options.guide,
           "gpt: draw directions by the light that comes from there: radiance, or variance to go where that is noisy "
           "too; off: as pt; auto: radiance, or off, whichever trials find better")
      .showDefault();
  command.add("--guide-memory", options.guideMemory, "gpt: memory of what it learns, as 64MiB, which is the default");
  command.add("--memory", options.memory, "budget, as 800M or 2GiB: fewer light paths of ppm, bpm and vcm if need be");
  // Markov chains.
  command.add("--mlt", options.mlt, "what the chains of mlt walk in: pssmlt, mmlt or pathspace; default: mmlt");
  command.add("--chains", options.chains, "Markov chains of mlt").showDefault().between(kChainRange);
  command.add("--bootstrap", options.bootstrap, "independent samples from which chains start")
      .showDefault()
      .between(kBootstrapRange);
  command
      .add("--restart", options.restart,
           "steps before chains start anew; default: such that chains make 16 mutations for each bootstrap sample")
      .between(kRestartRange);
  command.addFlag("--no-direct-pass", options.noDirectPass, "mmlt and pathspace: chains render direct light too");
}

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
  if (mayLearn(settings)) {
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

}  // namespace

void addRenderOptions(const Command& command, RenderOptions& options) {
  addSceneOptions(command, options.scene);
  // Method, end and threads.
  command.add("-m,--method", options.method, "light-transport method: " + methodChoices()).showDefault();
  command.add("--time", options.time, "stop after this much render time: 6s, 100ms, 1h30m");
  command
      .add("--spp", options.spp,
           "stop after N iterations: paths, of mlt mutations, per pixel; default without --time: "
           "the scene's sample_count, or 4")
      .atLeast(1);
  command.add("--threads", options.threads, "worker threads; default: all cores").between(kThreadRange);
  command.addFlag("--pin", options.pin, "bind threads to cores and spread shared memory over their nodes");
  // Samples and paths.
  command.add("--seed", options.seed, "seed of all random numbers").showDefault();
  command
      .add("--sampler", options.sampler,
           "independent, sobol, or auto: sobol for pt, bpt and vcm, but not with --until-relative-error")
      .showDefault();
  command
      .add("--filter-mode", options.filterMode,
           "spread: camera samples add to all pixels that the filter reaches; sample: to one")
      .showDefault();
  command.add("--max-depth", options.maxDepth, "edges of the longest path; -1: unlimited")
      .between(kDepthRange.least, kDepthRange.most, -1);
  command.add("--rr-depth", options.rrDepth, "first vertex where roulette may end a path").between(kRouletteDepthRange);
  command
      .add("--roulette", options.roulette,
           "what decides whether a walk goes on: throughput, albedo, or efficiency: throughput in the method's "
           "proportion, of gpt with a guide what paths have been worth")
      .showDefault();
  // Kernels and intersector.
  command.add("--precision", options.precision, "float or double").showDefault();
  command.add("--isa", options.isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--accel", options.accel, "intersector: auto, small, bvh or embree").showDefault();
  command.add("--instances", options.instances, "of shape groups: auto, expand into copies, or keep").showDefault();
  command.add("--wave", options.wave, "paths per wave").showDefault().between(kWaveRange);
  addMethodOptions(command, options);
  // Snapshots, goals, checkpoints and outputs.
  command.add("--snapshot-every", options.snapshotEvery, "snapshots at this interval, or 'log'");
  command
      .add(
          "--until-relative-error", options.until.relativeError,
          "stop when the image's relative RMSE against its expectation is E or less, with 95 % confidence; not for mlt")
      .between(1e-5, 1.0);
  command.add("--until-ssim", options.until.ssim, "stop when the SSIM against --reference is S").between(1e-9, 1.0);
  command.add("--reference", options.until.reference, "image that --until-ssim compares with");
  addCheckpointOptions(command, options.checkpoint);
  command.add("--part", options.part,
              "I/N: render the I-th of N parts of --spp into --checkpoint; `wavecrest merge` adds them up");
  addLiveOptions(command, options.live);
  command.add("-o,--output", options.outputs, "image file: .exr, .png or .pfm; repeatable; default: SCENE.exr")
      .repeatable();
  command.add("--exposure", options.exposure, "stops by which PNG images are brighter").between(kExposureRange);
  command.addFlag("--partial", options.partial, "write images even before there was a whole pass over the film");
  command.add("--stats", options.stats, "write statistics as JSON; - for stdout");
  command.addFlag("--dry-run", options.dryRun, "print plan, memory and outputs, and render nothing");
  command.add("--progress", options.progress, "auto, bar, jsonl or none").showDefault();
  command.addFlag("--quiet", options.quiet, "neither progress nor notes on stderr; --stats has the notes");
}

RenderSettings settingsOfRender(const RenderOptions& options, const Scene& scene) {
  RenderSettings settings = renderSettings(options, scene);
  // Only long runs of Sobol points are independent, and an error is known after eight. A goal would be far behind.
  if (options.until.relativeError > 0 && options.sampler == "auto") settings.sampler = SamplerKind::independent;
  // A goal ends the render, not the scene's number of samples.
  if (options.spp == 0 && options.until.any()) settings.iterations.reset();
  settings.measureStages = !options.stats.empty();
  return options.part.empty() ? settings : settingsOfPart(options, settings);
}

}  // namespace wavecrest
