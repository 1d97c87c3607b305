#include "library/render_settings.h"

#include <fmt/core.h>

#include <algorithm>
#include <thread>

#include "cli/commands.h"
#include "cli/option_values.h"

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
  const std::optional<Method> method = parseMethod(options.method);
  if (!method)
    throw UsageError(fmt::format("--method {}: unknown; expected one of {}", options.method, methodChoices()));
  settings.method = *method;
  const std::optional<SamplerKind> sampler = parseSamplerKind(options.sampler);
  if (!sampler) throw UsageError(fmt::format("--sampler {}: expected independent or sobol", options.sampler));
  settings.sampler = *sampler;
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.isa = parseIsaOption(options.isa);
  settings.seed = options.seed;
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.waveSize = options.wave;
  settings.metropolis = chosenChains(options);
  settings.radius = options.radius;
  settings.radiusAlpha = options.radiusAlpha;
  settings.limits = pathLimits(options.maxDepth != 0 ? options.maxDepth : scene.defaults.maxDepth,
                               options.rrDepth != 0 ? options.rrDepth : scene.defaults.rrDepth);
  if (options.spp != 0) settings.iterations = options.spp;
  if (!options.time.empty()) settings.seconds = parseDuration(options.time);
  if (!settings.iterations && !settings.seconds) settings.iterations = scene.defaults.sampleCount;
  if (!options.memory.empty()) settings.memoryBytes = parseMemory(options.memory);
  return settings;
}

}  // namespace wavecrest
