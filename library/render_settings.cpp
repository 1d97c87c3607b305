#include "library/render_settings.h"

#include <fmt/core.h>

#include <algorithm>
#include <thread>

#include "library/errors.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

MetropolisSettings chosenChains(const api::RenderOptions& options) {
  MetropolisSettings settings;
  if (!options.mlt.empty()) {
    settings.variant = static_cast<MetropolisVariant>(parseChoice("--mlt", options.mlt, kMetropolisVariantNames));
  }
  settings.chains = options.chains;
  settings.directPass = !options.noDirectPass;
  settings.bootstrapSamples = options.bootstrap;
  if (options.restart != 0) settings.restartSteps = options.restart;
  return settings;
}

}  // namespace

RenderSettings renderSettings(const api::RenderOptions& options, const Scene& scene) {
  RenderSettings settings;
  settings.method = parseMethodOption("--method", options.method);
  settings.sampler = parseSamplerOption("--sampler", options.sampler);
  settings.filterMode = static_cast<FilterMode>(parseChoice("--filter-mode", options.filterMode, kFilterModeNames));
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.instancing = static_cast<Instancing>(parseChoice("--instances", options.instances, kInstancingNames));
  settings.isa = parseIsaOption(options.isa);
  settings.seed = options.seed;
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.waveSize = options.wave;
  settings.metropolis = chosenChains(options);
  settings.radius = options.radius;
  settings.radiusAlpha = options.radiusAlpha;
  settings.connectionRoulette = options.connectionRoulette;
  if (options.lightPaths != 0) {
    if (!strategiesOf(settings.method).merge) {
      throw UsageError(fmt::format("--light-paths: {} has one light path per camera path; expected ppm, bpm or vcm",
                                   toString(settings.method)));
    }
    settings.lightPaths = options.lightPaths;
  }
  settings.directPass = options.directPass;
  if (settings.directPass && settings.method != Method::ppm) {
    throw UsageError(fmt::format("--direct-pass: is for ppm, not for {}", toString(settings.method)));
  }
  settings.limits = pathLimits(options.maxDepth != 0 ? options.maxDepth : scene.defaults.maxDepth,
                               options.rrDepth != 0 ? options.rrDepth : scene.defaults.rrDepth);
  if (settings.method == Method::mlt && options.maxDepth > static_cast<int>(kChainDepth)) {
    throw UsageError(fmt::format("--max-depth {}: chains have memory for {} edges; expected that or less",
                                 options.maxDepth, kChainDepth));
  }
  if (options.spp != 0) settings.iterations = options.spp;
  if (!options.time.empty()) settings.seconds = parseDuration("--time", options.time);
  if (!settings.iterations && !settings.seconds) settings.iterations = scene.defaults.sampleCount;
  if (!options.memory.empty()) settings.memoryBytes = parseMemory("--memory", options.memory);
  return settings;
}

}  // namespace wavecrest
