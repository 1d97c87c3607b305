// What a user may choose about a render, as plain data.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "engine/compile/compiled_scene.h"
#include "engine/learn/guide.h"
#include "engine/methods/method_list.h"
#include "engine/plan/clock_kind.h"
#include "engine/tasks/placement.h"
#include "kernels/mutate/path_law.h"

namespace wavecrest {

// Edges of the longest path where none is stated: more than paths have, and four numbers of each vertex' random blocks
// still fit in 32 bits. Light vertices keep their depth in a few bits (kMostEdges), chains memory for each vertex
// (kChainDepth). What a limit cuts is counted (StageCounters::cutPaths), but mmlt and pathspace leave longer paths out
// uncounted.
constexpr uint32_t kUnlimitedDepth = 1u << 24, kChainDepth = 64;

// Markov chains. Their number is a setting, not a consequence of threads or waves, so that images depend on neither.
struct MetropolisSettings {
  MetropolisVariant variant = MetropolisVariant::mmlt;
  uint32_t chains = 16384;
  uint32_t bootstrapSamples = 131072;  // independent samples from which chains start, and the image's brightness comes
  std::optional<uint32_t> restartSteps;      // steps before all chains start anew; unless set, epochSteps() says
  double largeStep = 0.3;                    // probability of a step that forgets where the chain is
  uint32_t pathMutations = PathLaw().kinds;  // pathspace: kinds besides large steps (PathLaw)
  bool directPass = true;  // mmlt, pathspace: emitters in view and direct light by path tracing, the rest by chains
};

// What one session renders of an image that several render together; the films of all shares add up to the image
// (Film::add). A share is a run of iterations, RenderSettings::firstIteration and iterations, or with `rounds` several
// (engine/plan/share_iterations.h). A share of mlt is chains part, part + parts, part + 2 parts, ... in all iterations.
// All shares of mlt trace the same bootstrap samples.
struct RenderShare {
  uint32_t part = 0, parts = 1;        // no more than chains
  std::optional<uint64_t> iterations;  // of the whole image; unset: those of the settings, of rounds without end
  bool rounds = false;                 // of shares that are rendered at the same time
};

// Mutations to a bootstrap sample. The error of b falls only with the number of bootstraps, so they get a fixed part of
// a render, however long it is: a sixteenth costs little and is no longer what limits an image
// (engine/chains/README.md).
constexpr uint64_t kMutationsPerBootstrapSample = 16;

// Visits of a chain to one state are summed in a float, which counts no further.
constexpr uint64_t kMostEpochSteps = uint64_t{1} << 24;

// Steps from one bootstrap, of so many samples, to the next. Without samples there are no paths for chains, and the
// first epoch never ends.
inline uint64_t epochSteps(const MetropolisSettings& settings, uint64_t samples) {
  if (samples == 0) return std::numeric_limits<uint64_t>::max();
  if (settings.restartSteps) return *settings.restartSteps;
  return std::clamp<uint64_t>(kMutationsPerBootstrapSample * samples / settings.chains, 1, kMostEpochSteps);
}

// Limits of paths from what a scene file or a user says: depth in edges, -1 for as many as roulette allows; the first
// vertex where roulette may end a path.
inline PathLimits pathLimits(int maxDepth, int rouletteDepth) {
  PathLimits limits;
  limits.maxDepth = maxDepth > 0 ? std::min(static_cast<uint32_t>(maxDepth), kUnlimitedDepth) : kUnlimitedDepth;
  limits.rouletteDepth = static_cast<uint32_t>(rouletteDepth);
  return limits;
}

// What a camera sample adds to: all pixels that the reconstruction filter spreads it to
// (kernels/columns/filter_spread.h), or the one pixel that it was drawn for. Filters that are too wide to be spread are
// sampled; a box is the same by both.
enum class FilterMode { spread, sample };
constexpr std::array<std::string_view, 2> kFilterModeNames{"spread", "sample"};

// What decides whether a walk goes on after a vertex (METHODS 1.5): its throughput, as in the study; the albedo of the
// vertex; or throughput in the proportion that is most efficient for the method. No choice changes a mean.
enum class Roulette { throughput, albedo, efficiency };
constexpr std::array<std::string_view, 3> kRouletteNames{"throughput", "albedo", "efficiency"};
// Where the camera paths of vcm merge: at all vertices with more than delta lobes, as in the study, or at the first of
// them alone (METHODS 5.10).
enum class MergeVertices { all, first };
constexpr std::array<std::string_view, 2> kMergeVerticesNames{"all", "first"};

// The study's radius of the first merges, relative to the bounding sphere's.
constexpr double kFixedRadius = 0.001;

struct RenderSettings {
  Method method = Method::pt;
  MetropolisSettings metropolis;
  RenderShare share;
  std::optional<FilmSettings> film;  // rendered instead of the scene's, with the same aspect ratio
  Precision precision = Precision::floating;
  Isa isa = Isa::scalar;
  Accel accel = Accel::automatic;
  Instancing instancing = Instancing::automatic;
  SamplerKind sampler = SamplerKind::independent;
  bool samplerIsChosen = false;  // what trials decide for has it, whether or not it serves that
  FilterMode filterMode = FilterMode::spread;
  uint64_t seed = 0;
  uint32_t threads = 1;
  uint32_t waveSize = 2048;  // paths
  PathLimits limits;
  Roulette roulette = Roulette::throughput;  // of the walks of every method but mlt, from limits.rouletteDepth on
  // Of the first merges, relative to the bounding sphere's. Unset: what the image needs (engine/pilot/merge_radius.h).
  std::optional<double> radius = kFixedRadius;
  double radiusAlpha = 0.75;                         // how fast the radius shrinks: r_i = r_1 i^((alpha - 1) / 2)
  MergeVertices mergeVertices = MergeVertices::all;  // of vcm
  // lt: as many light walks to a camera walk as the error of either deserves (engine/pilot/walk_balance.h); else one.
  bool balancedWalks = false;
  // bpt, vcm: Russian roulette of connections whose contribution is below this share of a typical pixel's brightness.
  // It saves shadow rays and changes no mean. 0: no roulette. Never used with Accel::small, where a shadow ray costs
  // less than the roulette.
  double connectionRoulette = 0.2;
  // gpt: what its guide is learned for, and the memory of what it learns.
  GuideTarget guide = GuideTarget::radiance;
  uint64_t guideBytes = uint64_t{64} << 20;
  bool directPass = false;      // ppm: direct light by next event estimation, the rest from photons
  uint64_t firstIteration = 0;  // of this session: what came before was rendered by another
  // N_L, the light paths of an iteration. Unset: one per pixel (lightPathsWanted). To be set for methods with a photon
  // map only: bpt traces one light path with each camera path, lt up to four (balancedWalks).
  std::optional<uint64_t> lightPaths;
  std::optional<uint64_t> memoryBytes;           // budget; lowers N_L where that is what fills the memory
  std::optional<uint64_t> mostLightPaths;        // with a budget: N_L at most, even if more would fit
  std::optional<uint64_t> iterations;            // stop after this many,
  std::optional<double> seconds;                 // or after this much render time, whichever comes first,
  ClockKind clock = ClockKind::wall;             // as this clock counts it
  std::optional<Specialization> specialization;  // overrides the scene's own; it must cover the scene
  bool measureStages = false;
  // Work is cut into pieces as for so many threads, however many there are; unset: for those that there are.
  std::optional<uint32_t> piecesForThreads;
  Placement placement;  // of the threads and the memory that they share; images do not depend on it

  const FilmSettings& filmOf(const Scene& scene) const { return film ? *film : scene.film; }
  // Of this session; of shares that are rendered at the same time, of all of them.
  std::optional<uint64_t> jointIterations() const { return share.rounds ? share.iterations : iterations; }
  uint32_t cutForThreads() const { return piecesForThreads.value_or(threads); }
  uint32_t chainsOfShare() const { return (metropolis.chains - share.part + share.parts - 1) / share.parts; }
};

// Sobol points of different runs of so many iterations of the image are scrambled independently, so that what lies
// between runs tells the error of a film. Longer runs are worth little more: of path tracing in cornell-diffuse 256
// iterations to a run have 0.8 of the error that 64 have. A multiple of kIterationsPerWave.
constexpr uint64_t kSobolRun = 64;
static_assert(kSobolRun % kIterationsPerWave == 0);

// The sampler of an iteration of the image, with which all of its light paths are drawn.
inline SamplerSettings samplerOf(const RenderSettings& settings, uint64_t iteration, uint64_t lightPaths = 0) {
  // Seeds of different runs, and of renders whose seeds are any numbers that people type, are different.
  constexpr uint64_t kSeedOfRun = 0x9e3779b97f4a7c15;
  const uint64_t run = settings.sampler == SamplerKind::sobol ? iteration / kSobolRun : 0;
  return {.kind = settings.sampler,
          .seed = settings.seed + run * kSeedOfRun,
          .iteration = iteration,
          .lightPaths = lightPaths};
}

// The same in a render that learns. iteration: of the session, which its blocks count (engine/learn/blocks.h). A guide
// follows from the points of earlier blocks, and later points of their Sobol run complement these: each block has
// scrambles of its own.
inline SamplerSettings ownOfBlock(SamplerSettings sampler, uint64_t iteration) {
  constexpr uint64_t kSeedOfBlock = 0xd1b54a32d192ed03;
  if (sampler.kind != SamplerKind::sobol) return sampler;
  sampler.seed += static_cast<uint64_t>(std::bit_width(iteration)) * kSeedOfBlock;
  return sampler;
}

// What `render` takes where no option says otherwise. Settings as constructed have the study's choices.
inline void takeProgramDefaults(RenderSettings& settings) {
  settings.radius.reset();
  settings.roulette = Roulette::efficiency;
  settings.mergeVertices = MergeVertices::first;
  settings.balancedWalks = true;
  settings.guide = GuideTarget::automatic;
}

// Whether the render learns a guide, or may once trials have decided.
inline bool mayLearn(const RenderSettings& settings) {
  return settings.method == Method::gpt && settings.guide != GuideTarget::off;
}

// Whether trials decide by what an image is rendered (engine/trials/choose_method.h).
inline bool areTried(const RenderSettings& settings) {
  return isChosenByTrials(settings.method) ||
         (settings.method == Method::gpt && settings.guide == GuideTarget::automatic);
}

// The sampler that serves the method best. Sobol points are worth nothing to chains, to light paths that are not joined
// with camera paths, and to directions that a guide draws.
inline SamplerKind bestSampler(Method method) {
  const PathStrategies strategies = strategiesOf(method);
  const bool lightAlone = (strategies.merge || strategies.camera) && !strategies.connect;
  const bool without = lightAlone || method == Method::mlt || method == Method::gpt;
  return without ? SamplerKind::independent : SamplerKind::sobol;
}

// By which method paths are traced: gpt without a guide is path tracing. method: that of the settings, or the one that
// trials chose.
inline Method tracingMethod(const RenderSettings& settings, Method method) {
  return method == Method::gpt && !mayLearn(settings) ? Method::pt : method;
}

// The sampler of settings that name none. What trials choose takes Sobol points where they serve it.
inline SamplerKind bestSampler(const RenderSettings& settings) {
  return areTried(settings) ? SamplerKind::sobol : bestSampler(tracingMethod(settings, settings.method));
}

// Whether the method's walks end by a roulette that can be chosen. Chains walk as far as their strategies say, or by
// throughput.
inline bool hasRouletteChoice(Method method) { return method != Method::mlt; }

// Whether connections of the method are subject to roulette. Those of chains are not: what they carry is what chains
// follow.
inline bool hasConnectionRoulette(Method method) { return method != Method::mlt && strategiesOf(method).connect; }

// Whether the method has RenderSettings::mergeVertices: others merge at all vertices or at the first by what they are.
inline bool choosesMergeVertices(Method method) {
  const PathStrategies strategies = strategiesOf(method);
  return strategies.merge && strategies.connect;
}

// Whether the last bits of the method's images depend on how paths are cut into waves: photons are summed, and pairs of
// vertices joined, in an order that follows from the waves.
inline bool dependsOnWaves(Method method) { return strategiesOf(method).merge || hasConnectionRoulette(method); }

// The settings of one share of what they render. part: from 0 on. Their iterations must be set, and be no fewer than
// parts (of mlt the chains).
RenderSettings settingsOfShare(RenderSettings settings, uint32_t part, uint32_t parts);
// The same of one that is rendered together with the others. Iterations need not be set, nor be as many as parts.
RenderSettings settingsOfJointShare(RenderSettings settings, uint32_t part, uint32_t parts);
// The first iteration of a share, and with part + 1 the end of it.
uint64_t beginOfShare(uint64_t iterations, uint32_t part, uint32_t parts);

// Whether neither light vertices nor chains keep memory for each vertex of a path.
inline bool tracesCameraPathsAlone(Method method) {
  const MethodPage page = entryOf(method).page();
  return page.walk(Walk::light) == nullptr && !page.hasChains();
}

// The settings with the longest path that their method can make, where they ask for longer ones.
inline RenderSettings withinDepthOfMethod(RenderSettings settings) {
  uint32_t& depth = settings.limits.maxDepth;
  if (settings.method == Method::mlt) {
    depth = std::min(depth, kChainDepth);
  } else if (!tracesCameraPathsAlone(settings.method)) {
    depth = std::min(depth, kMostEdges);
  }
  return settings;
}

}  // namespace wavecrest
