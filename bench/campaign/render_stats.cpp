#include "bench/campaign/render_stats.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/enumerator_name.h"
#include "bench/image_attributes.h"
#include "bench/machine/machine_record.h"
#include "bench/stats_rates.h"
#include "engine/plan/render_plan.h"
#include "engine/scene/hash_text.h"
#include "engine/version.h"

namespace wavecrest {
namespace {

// The largest resident set of the process so far. Linux counts it in KiB.
uint64_t peakMemoryBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

// The part of the stats that only mlt has: its settings, brightness b, and acceptance of each kind of mutation.
// restart: 0 where the number of bootstraps decides.
nlohmann::ordered_json chainStats(const RenderSettings& settings, const ChainStatistics& chains) {
  const ChainCounters& counters = chains.counters;
  // Accepted over proposed; 0 where nothing was proposed.
  const auto share = [](uint64_t part, uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  // Chains that rejected many proposals in a row.
  nlohmann::ordered_json stuck = nlohmann::ordered_json::array();
  for (const StuckChain& chain : chains.stuck) {
    stuck.push_back(
        {{"chain", chain.chain}, {"rejections", chain.rejections}, {"edges", chain.edges}, {"pixel", chain.pixel}});
  }
  nlohmann::ordered_json stats = {
      {"mlt", enumeratorName(kMetropolisVariantNames, settings.metropolis.variant)},
      {"chains", settings.metropolis.chains},
      {"bootstrap", settings.metropolis.bootstrapSamples},
      {"restart", settings.metropolis.restartSteps.value_or(0)},
      {"direct_pass", settings.metropolis.directPass && settings.metropolis.variant != MetropolisVariant::pssmlt},
      {"direct_paths", chains.directPaths},
      {"chain_bytes", chains.bytes},
      {"bootstrap_epochs", chains.epochs},
      {"bootstrap_largest_share", chains.largestShare},
      {"b", chains.brightness},
      {"b_error", chains.brightnessError},
      {"b_pooled", chains.pooledBrightness},
      {"b_pooled_error", chains.pooledError},
      {"dark_proposals", counters.dark},
      {"longest_rejection", counters.longestRejection},
      {"stuck_runs", counters.stuck},
      {"stuck_chains", stuck},
  };
  // Steps and acceptance by kind of mutation, in the order of Mutation. All variants make large steps. Path space makes
  // no small steps, the others nothing else.
  constexpr std::array<const char*, kMutationKinds> kNames{"large", "small",       "bidirectional",
                                                           "lens",  "multi_chain", "caustic"};
  for (size_t kind = 0; kind < kMutationKinds; ++kind) {
    const uint64_t proposed = counters.proposed[kind];
    const std::string name = kNames[kind];
    const bool pathSpace = settings.metropolis.variant == MetropolisVariant::pathspace;
    if (kind != 0 && pathSpace == (kind == static_cast<size_t>(Mutation::small))) continue;
    stats[name + "_steps"] = proposed;
    stats[name + "_acceptance"] = share(counters.accepted[kind], proposed);
  }
  return stats;
}

// Light paths of an iteration, of a method that merges: as many as wanted, or as memory holds.
uint64_t lightPathsTraced(const RenderSettings& settings, const RenderStatistics& statistics, uint64_t pixels) {
  const uint64_t wanted = lightPathsWanted(settings, pixels);
  if (!settings.memoryBytes || statistics.iterations == 0) return wanted;
  return std::min(wanted, statistics.lightPaths / statistics.iterations);
}

// Adds the keys that some methods, or parts of an image, have.
void addMethodStats(const Scene& scene, const RenderSettings& settings, const RenderStatistics& statistics,
                    nlohmann::ordered_json& stats) {
  if (statistics.choice) stats["choice"] = choiceJson(*statistics.choice);
  const Method method = statistics.renderedBy(settings.method);
  if (strategiesOf(method).merge) {
    const uint64_t pixels = uint64_t{scene.film.imageWidth()} * scene.film.imageHeight();
    stats.update({{"radius_choice", settings.radius ? "fixed" : "auto"},
                  {"radius_alpha", settings.radiusAlpha},
                  {"light_paths_per_iteration", lightPathsTraced(settings, statistics, pixels)}});
    if (statistics.mergeRadius) stats.update(mergeRadiusJson(*statistics.mergeRadius));
    if (method == Method::ppm) stats["direct_pass"] = settings.directPass;
    if (choosesMergeVertices(method)) {
      stats["merge_vertices"] = enumeratorName(kMergeVerticesNames, settings.mergeVertices);
    }
  }
  // What a share of an image is of it.
  if (settings.share.parts > 1) {
    stats["part"] = std::to_string(settings.share.part + 1) + "/" + std::to_string(settings.share.parts);
    stats["first_iteration"] = settings.firstIteration;
  }
  if (hasRouletteChoice(method)) stats["roulette"] = enumeratorName(kRouletteNames, settings.roulette);
  if (hasConnectionRoulette(method)) stats["connection_roulette"] = settings.connectionRoulette;
  if (settings.method == Method::gpt) stats["guide"] = guideJson(settings, statistics);
  if (statistics.chains) stats.update(chainStats(settings, *statistics.chains));
}

}  // namespace

nlohmann::ordered_json renderStats(const Scene& scene, const RenderSettings& settings,
                                   const RenderStatistics& statistics, double loadSeconds, double wallSeconds,
                                   const std::vector<SnapshotRecord>& snapshots) {
  const double seconds = statistics.renderSeconds;
  // Stages and snapshots are arrays of objects.
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const auto& stage : statistics.stages) {
    stages.push_back({{"name", stage.name}, {"items", stage.items}, {"seconds", stage.seconds}});
  }
  nlohmann::ordered_json snapshotRows = nlohmann::ordered_json::array();
  for (const SnapshotRecord& snapshot : snapshots) {
    snapshotRows.push_back({{"index", snapshot.number},
                            {"render_seconds", snapshot.renderSeconds},
                            {"iterations", snapshot.iterations},
                            {"file", snapshot.file}});
  }
  // Scalars of every render. The two rates have their place here and are set from the others below.
  nlohmann::ordered_json stats = {
      {"version", kVersion},
      {"commit", kCommit},
      {"scene", scene.name},
      {"scene_hash", hashText(scene.hash)},
      {"method", std::string(toString(settings.method))},
      {"seed", settings.seed},
      {"sampler", std::string(toString(statistics.sampler))},
      {"filter_mode", enumeratorName(kFilterModeNames, statistics.filterMode)},
      {"max_depth", withinDepthOfMethod(settings).limits.maxDepth},
      {"rr_depth", settings.limits.rouletteDepth},
      {"width", scene.film.imageWidth()},
      {"height", scene.film.imageHeight()},
      {"threads", settings.threads},
      {"isa", std::string(toString(statistics.isa))},
      {"precision", enumeratorName(kPrecisionNames, settings.precision)},
      {"accel", enumeratorName(kAccelNames, statistics.accel)},
      {"wave", settings.waveSize},
      {"specialization", enumeratorName(kSpecializationNames, statistics.specialization)},
      {"iterations", statistics.iterations},
      {"camera_paths", statistics.paths},
      {"light_paths", statistics.lightPaths},
      {"mutations", statistics.chains ? statistics.chains->mutations : 0},
      {"rays_closest", statistics.counters.raysClosest},
      {"rays_shadow", statistics.counters.raysShadow},
      {"connections", statistics.counters.connections},
      {"merges", statistics.counters.merges},
      {"load_seconds", loadSeconds},
      {"build_seconds", statistics.buildSeconds},
      {"render_seconds", seconds},
      {"clock", enumeratorName(kClockNames, settings.clock)},
      {"render_wall_seconds", statistics.renderWallSeconds},
      {"wall_seconds", wallSeconds},
      {"cpu_seconds", statistics.cpuSeconds},
      {"paths_per_second", 0.0},
      {"rays_per_second", 0.0},
      {"bytes_per_path", statistics.bytesPerPath},
      {"light_bytes", statistics.memory.lightVertices + statistics.memory.photonMap},
      {"peak_memory_bytes", peakMemoryBytes()},
      {"nonfinite_samples", statistics.counters.nonFinite},
      {"saturated_splats", statistics.counters.saturatedSplats},
      {"close_pairs", statistics.counters.closePairs},
      {"paths_cut", statistics.counters.cutPaths},
      {"throughput_cut", statistics.counters.cutThroughput},
      {"cut_energy", statistics.counters.cutThroughput},  // the same, by the name that scripts know
      {"machine", toJson(machineRecord())},
      {"pinned", {{"cpus", settings.placement.cpus}, {"nodes", settings.placement.nodes}}},
      {"stages", stages},
      {"snapshots", snapshotRows},
  };
  addMethodStats(scene, settings, statistics, stats);
  setRates(stats);
  return stats;
}

namespace {

using Json = nlohmann::ordered_json;

Json decision(const char* setting, Json value, const std::string& why) {
  return {{"setting", setting}, {"value", std::move(value)}, {"why", why}};
}

// What trials found: the work of each candidate for the same error, over that of the chosen one.
std::string whyChosen(const MethodChoice& choice) {
  const auto chosen = std::ranges::find(choice.trials, choice.method, &MethodTrial::method);
  const double least = chosen == choice.trials.end() ? 0 : chosen->inefficiency();
  if (!(least > 0)) return "trials found no error to compare methods by";
  std::vector<std::string> trials;
  for (const MethodTrial& trial : choice.trials) {
    trials.push_back(fmt::format("{} {:.2f}", toString(trial.method), trial.inefficiency() / least));
  }
  return fmt::format("work for the same error in trials, over its own: {}", fmt::join(trials, ", "));
}

std::string whySampler(Method method, SamplerKind sampler) {
  if (sampler != bestSampler(method)) return "the error of independent samples is known after fewer iterations";
  const char* const gain = sampler == SamplerKind::sobol ? "lower the noise of" : "are worth nothing to";
  return fmt::format("Sobol points {} {}", gain, toString(method));
}

// Light paths of an iteration, of a method that merges.
Json photonsDecision(const RenderSettings& settings, const RenderStatistics& statistics, uint64_t pixels) {
  const uint64_t wanted = lightPathsWanted(settings, pixels);
  const uint64_t traced = lightPathsTraced(settings, statistics, pixels);
  if (traced < wanted) {
    return decision("light_paths", traced, fmt::format("memory holds no more; {} without a budget", wanted));
  }
  return decision("light_paths", wanted,
                  wanted > pixels ? "more than pixels, as so few photons would hardly be found" : "as many as pixels");
}

}  // namespace

Json decisionsJson(const Scene& scene, const RenderSettings& settings, const RenderStatistics& statistics) {
  Json all = Json::array();
  const Method method = statistics.renderedBy(settings.method);
  if (statistics.choice) {
    // Trials of gpt are about its guide.
    const bool ofGuide = settings.method == Method::gpt;
    const GuideTarget guide = method == Method::gpt ? GuideTarget::radiance : GuideTarget::off;
    const std::string name(ofGuide ? enumeratorName(kGuideTargetNames, guide) : toString(method));
    all.push_back(decision(ofGuide ? "guide" : "method", name, whyChosen(*statistics.choice)));
  }
  if (!settings.samplerIsChosen) {
    const std::string name(toString(statistics.sampler));
    const Method traced = tracingMethod(settings, method);
    all.push_back(decision("sampler", name, whySampler(traced, statistics.sampler)));
  }
  const uint64_t pixels = uint64_t{scene.film.imageWidth()} * scene.film.imageHeight();
  const bool merges = strategiesOf(method).merge;
  if (merges &&
      (!settings.lightPaths || lightPathsTraced(settings, statistics, pixels) < lightPathsWanted(settings, pixels))) {
    all.push_back(photonsDecision(settings, statistics, pixels));
  }
  if (merges && !settings.radius && statistics.mergeRadius) {
    const MergeRadius& radius = *statistics.mergeRadius;
    all.push_back(decision("radius", radius.first,
                           fmt::format("by the view and the light paths: {:.3g} pixels and {:.3g} photons in a search "
                                       "where camera paths first merge",
                                       radius.inPixels(), radius.photonsPerSearch())));
  }
  // Light tracing has a whole number of light walks to each camera walk.
  if (method == Method::lt && settings.balancedWalks && statistics.paths > 0) {
    const auto walks = static_cast<uint64_t>(
        std::llround(static_cast<double>(statistics.lightPaths) / static_cast<double>(statistics.paths)));
    all.push_back(decision("light_paths", walks * pixels,
                           fmt::format("{} to a camera path, by the error and the work of either", walks)));
  }
  return all;
}

nlohmann::ordered_json choiceJson(const MethodChoice& choice) {
  nlohmann::ordered_json trials = nlohmann::ordered_json::array();
  for (const MethodTrial& trial : choice.trials) {
    trials.push_back({{"method", std::string(toString(trial.method))},
                      {"iterations", trial.iterations},
                      {"variance", trial.variance},
                      {"missed", trial.missed},
                      {"cost", trial.cost},
                      {"inefficiency", trial.inefficiency()}});
  }
  return {{"method", std::string(toString(choice.method))}, {"seconds", choice.seconds}, {"trials", trials}};
}

nlohmann::ordered_json guideJson(const RenderSettings& settings, const RenderStatistics& statistics) {
  nlohmann::ordered_json guide{{"target", enumeratorName(kGuideTargetNames, settings.guide)}};
  if (!statistics.guide) return guide;
  const GuideStatistics& learned = *statistics.guide;
  guide.update({{"blocks", learned.folds},
                {"cells", learned.cells},
                {"taught_cells", learned.taught},
                {"records", learned.records},
                {"guided_share", learned.guidedShare},
                {"saturated_sums", learned.saturated},
                {"bytes", learned.bytes}});
  return guide;
}

nlohmann::ordered_json mergeRadiusJson(const MergeRadius& radius) {
  return {{"radius", radius.first},
          {"radius_units", radius.at(0)},
          {"radius_pixels", radius.inPixels()},
          {"photons_per_search", radius.photonsPerSearch()}};
}

Metadata statsMetadata(const nlohmann::ordered_json& stats) {
  Metadata out;
  for (const auto& [key, value] : stats.items()) {
    // Arrays and objects are left out, but for the target of a guide, which makes another series of a method.
    if (key == "guide" && value.is_object()) out[attributeName("guide.target")] = value.at("target").get<std::string>();
    if (value.is_primitive()) out[attributeName(key)] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return out;
}

}  // namespace wavecrest
