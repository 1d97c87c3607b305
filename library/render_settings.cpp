#include "library/render_settings.h"

#include <fmt/core.h>

#include <optional>
#include <string_view>

#include "engine/tasks/processors.h"
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

// Whether a variant of mlt can leave direct light to path tracing.
bool canLeaveDirectLight(MetropolisVariant variant) { return !pageOf(Method::mlt, variant).directLight.empty(); }

// An option that only some methods have.
struct MethodOption {
  const char* name;
  bool given;           // with another value than the default, which fits every method
  bool (*has)(Method);  // whether the option is the method's
  const char* wrong;    // about any other method
};

// Refuses options that the method would ignore. Throws UsageError.
void refuseOptionsOfOtherMethods(const api::RenderOptions& options, Method method) {
  const api::RenderOptions byDefault;
  const auto isMlt = [](Method one) { return one == Method::mlt; };
  const auto isPpm = [](Method one) { return one == Method::ppm; };
  const auto isGpt = [](Method one) { return one == Method::gpt; };
  constexpr const char* kNoGuide = "learns no guide";
  constexpr const char* kNoChains = "has no Markov chains";
  const bool otherMlt = chosenChains(options).variant != chosenChains(byDefault).variant;
  const MethodOption all[] = {
      {"--radius", options.radius != byDefault.radius, mergesPaths, "does not merge"},
      {"--radius-alpha", options.radiusAlpha != byDefault.radiusAlpha, mergesPaths, "does not merge"},
      {"--merge-vertices", options.mergeVertices != byDefault.mergeVertices, choosesMergeVertices,
       "has no choice of where to merge"},
      {"--light-paths", options.lightPaths != 0, mergesPaths, "traces no photons to merge with"},
      {"--direct-pass", options.directPass, isPpm, "has no such choice"},
      {"--connection-roulette", options.connectionRoulette != byDefault.connectionRoulette, hasConnectionRoulette,
       "has no roulette of connections"},
      {"--roulette", options.roulette != byDefault.roulette, hasRouletteChoice, "has no such choice"},
      {"--guide", options.guide != byDefault.guide, isGpt, kNoGuide},
      {"--guide-memory", !options.guideMemory.empty(), isGpt, kNoGuide},
      {"--mlt", otherMlt, isMlt, kNoChains},
      {"--chains", options.chains != byDefault.chains, isMlt, kNoChains},
      {"--bootstrap", options.bootstrap != byDefault.bootstrap, isMlt, kNoChains},
      {"--restart", options.restart != 0, isMlt, kNoChains},
      {"--no-direct-pass", options.noDirectPass, isMlt, kNoChains},
  };
  for (const MethodOption& option : all) {
    if (!option.given || option.has(method)) continue;
    throw UsageError(
        fmt::format("{}: {} {}; expected {}", option.name, toString(method), option.wrong, methodsWith(option.has)));
  }
}

// Refuses what the variant of mlt would ignore. Throws UsageError.
void refuseOptionsOfOtherVariants(const api::RenderOptions& options, const RenderSettings& settings,
                                  const Scene& scene) {
  const MetropolisSettings& chains = settings.metropolis;
  const std::string_view variant = kMetropolisVariantNames[static_cast<size_t>(chains.variant)];
  if (!canLeaveDirectLight(chains.variant) && !chains.directPass) {
    throw UsageError(fmt::format("--no-direct-pass: {} has no direct pass; expected --mlt mmlt or pathspace", variant));
  }
  // What the scene says fits every variant.
  const bool otherDepth = options.rrDepth != 0 && options.rrDepth != scene.defaults.rrDepth;
  if (otherDepth && chains.variant != MetropolisVariant::pssmlt) {
    throw UsageError(fmt::format("--rr-depth: {} ends no walk by roulette; expected --mlt pssmlt", variant));
  }
  // Chains draw numbers of their own, and choose one pixel each. Only the direct pass has a sampler and a filter mode.
  const bool direct = canLeaveDirectLight(chains.variant) && chains.directPass;
  if (!direct && settings.sampler != SamplerKind::independent) {
    throw UsageError(fmt::format("--sampler {}: is for the direct pass, which these chains do without; expected {}",
                                 options.sampler, toString(SamplerKind::independent)));
  }
  if (!direct && settings.filterMode != RenderSettings().filterMode) {
    throw UsageError(fmt::format("--filter-mode {}: is for the direct pass, which these chains do without; expected {}",
                                 options.filterMode, api::RenderOptions().filterMode));
  }
}

// Refuses numbers outside of their ranges. Where 0 leaves a number to the scene or the machine, 0 is none of them.
// Throws UsageError.
void refuseNumbersOutOfRange(const api::RenderOptions& options) {
  const auto unlessZero = [](const char* name, auto number, const auto& range, const char* also = "") {
    if (number != 0) requireInRange(name, number, range, also);
  };
  unlessZero("--threads", options.threads, kThreadRange);
  if (options.maxDepth != -1) unlessZero("--max-depth", options.maxDepth, kDepthRange, ", or -1");
  unlessZero("--rr-depth", options.rrDepth, kRouletteDepthRange);
  requireInRange("--wave", options.wave, kWaveRange);
  unlessZero("--radius", options.radius, kRadiusRange, ", or 0");
  requireInRange("--radius-alpha", options.radiusAlpha, kRadiusAlphaRange);
  unlessZero("--light-paths", options.lightPaths, kLightPathRange);
  requireInRange("--connection-roulette", options.connectionRoulette, kConnectionRouletteRange);
  requireInRange("--chains", options.chains, kChainRange);
  requireInRange("--bootstrap", options.bootstrap, kBootstrapRange);
  unlessZero("--restart", options.restart, kRestartRange);
}

// The settings of these options, whichever method has them.
RenderSettings settingsOfAnyMethod(const api::RenderOptions& options, const Scene& scene) {
  refuseNumbersOutOfRange(options);
  RenderSettings settings;
  settings.method = parseMethodOption("--method", options.method);
  settings.filterMode = static_cast<FilterMode>(parseChoice("--filter-mode", options.filterMode, kFilterModeNames));
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.instancing = static_cast<Instancing>(parseChoice("--instances", options.instances, kInstancingNames));
  settings.isa = parseIsaOption(options.isa);
  settings.seed = options.seed;
  settings.threads = threadsOrAll(options.threads);
  settings.waveSize = options.wave;
  settings.measureStages = options.measureStages;
  settings.metropolis = chosenChains(options);
  settings.radius = options.radius != 0 ? std::optional(options.radius) : std::nullopt;
  settings.radiusAlpha = options.radiusAlpha;
  settings.roulette = static_cast<Roulette>(parseChoice("--roulette", options.roulette, kRouletteNames));
  settings.mergeVertices =
      static_cast<MergeVertices>(parseChoice("--merge-vertices", options.mergeVertices, kMergeVerticesNames));
  settings.balancedWalks = true;
  settings.connectionRoulette = options.connectionRoulette;
  settings.guide = static_cast<GuideTarget>(parseChoice("--guide", options.guide, kGuideTargetNames));
  const std::optional<SamplerKind> sampler = parseSamplerOrAuto("--sampler", options.sampler);
  settings.samplerIsChosen = sampler.has_value();
  settings.sampler = sampler.value_or(bestSampler(settings));
  if (!options.guideMemory.empty() && settings.guide == GuideTarget::off) {
    throw UsageError("--guide-memory: --guide off learns no guide; expected only one of them");
  }
  if (!options.guideMemory.empty()) settings.guideBytes = parseMemory("--guide-memory", options.guideMemory);
  if (options.lightPaths != 0) settings.lightPaths = options.lightPaths;
  settings.directPass = options.directPass;
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

}  // namespace

RenderSettings renderSettings(const api::RenderOptions& options, const Scene& scene) {
  RenderSettings settings = settingsOfAnyMethod(options, scene);
  refuseOptionsOfOtherMethods(options, settings.method);
  if (settings.method == Method::mlt) refuseOptionsOfOtherVariants(options, settings, scene);
  return settings;
}

RenderSettings inspectionSettings(const api::RenderOptions& options, const Scene& scene) {
  if (options.lightPaths != 0) {
    throw UsageError("--light-paths: not every method of an inspection merges; expected none");
  }
  return settingsOfAnyMethod(options, scene);
}

}  // namespace wavecrest
