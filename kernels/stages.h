// The table of stages: what a pipeline calls, for one instruction set, precision policy and feature set.
//
// Every stage has the same shape: it reads the scene and the state of the pipeline from the context, and turns columns
// of the wave into other columns. A method is a list of these (engine/methods).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "kernels/columns/columns.h"
#include "kernels/columns/filter_spread.h"
#include "kernels/columns/photon_grid.h"
#include "kernels/columns/splat_sums.h"
#include "kernels/columns/wave.h"
#include "kernels/sampling/sampler.h"
#include "kernels/scene_view.h"
#include "kernels/simd/isa.h"
#include "kernels/stage_catalogue.h"

namespace wavecrest {

// How numbers are kept and computed: `doubled` does shading, throughput, densities and MIS weights in double and
// recomputes hit points in double.
enum class Precision { floating, doubled };
constexpr std::array<std::string_view, 2> kPrecisionNames{"float", "double"};

// Bits of a feature set. What a set lacks costs nothing in its kernels.
enum Feature : uint32_t {
  kSpecularBsdfs = 1,    // mirror, conductor, dielectric, rough conductor
  kLayeredBsdfs = 2,     // plastic, rough dielectric, thin dielectric, phong, opacity
  kTextures = 4,         // textures
  kShadingNormals = 8,   // interpolated vertex normals
  kCurvedShapes = 16,    // analytic spheres, as geometry or as lights
  kRareLights = 32,      // spot, directional, environment map
  kBidirectional = 64,   // light paths, connections, merging: the whole MIS recursion
  kNormalMaps = 128,     // bump and normal maps
  kCompoundBsdfs = 256,  // BSDFs made of others, anisotropic and principled ones
  kInstances = 512,      // hits in instances of shape groups
};

// What kernels are instantiated for: feature sets, in the order in which a scene and method try them; the last has all.
// plain: what most scenes are made of but textures and shading normals, which are what makes each vertex dearer
// (kernels/README.md). complete: everything.
enum class Specialization {
  diffuse,
  smooth,
  plain,
  diffuseBidirectional,
  smoothBidirectional,
  plainBidirectional,
  complete
};
constexpr size_t kSpecializationCount = 7;
constexpr std::array<std::string_view, kSpecializationCount> kSpecializationNames{
    "diffuse", "smooth", "plain", "diffuse-bidirectional", "smooth-bidirectional", "plain-bidirectional", "complete"};
constexpr uint32_t kAllFeatures = 1023;
constexpr uint32_t kPlainFeatures = kSpecularBsdfs | kLayeredBsdfs | kCurvedShapes | kRareLights;
constexpr uint32_t kSmoothFeatures = kSpecularBsdfs | kCurvedShapes;
constexpr std::array<uint32_t, kSpecializationCount> kSpecializationFeatures{0,
                                                                             kSmoothFeatures,
                                                                             kPlainFeatures,
                                                                             kBidirectional,
                                                                             kSmoothFeatures | kBidirectional,
                                                                             kPlainFeatures | kBidirectional,
                                                                             kAllFeatures};

constexpr uint32_t featuresOf(Specialization specialization) {
  return kSpecializationFeatures[static_cast<size_t>(specialization)];
}

// float is specialised for every feature set, double for the complete one alone: its users wait for accuracy anyway,
// and each instantiation is paid for in compile time on every instruction set. With WAVECREST_ONLY_COMPLETE_KERNELS
// (CMakeLists.txt) every scene and method runs on the complete kernels.
constexpr bool isCompiled(Precision precision, Specialization specialization) {
  if (specialization == Specialization::complete) return true;
#ifdef WAVECREST_ONLY_COMPLETE_KERNELS
  return false;
#endif
  return precision == Precision::floating;
}

// The first specialisation compiled for the precision that covers these features.
constexpr Specialization chooseSpecialization(uint32_t features, Precision precision) {
  for (size_t i = 0; i < kSpecializationCount; ++i) {
    const auto specialization = static_cast<Specialization>(i);
    if (isCompiled(precision, specialization) && (features & ~featuresOf(specialization)) == 0) return specialization;
  }
  return Specialization::complete;
}

// Which way a sub-path is walked: from the eye, so that the generated direction points to the light's side, or from a
// light.
enum class Walk { camera, light };

// Which strategies share a path, and the constants of their densities (METHODS 5.1). Set once per iteration.
struct MisSettings {
  bool emission = true;         // s = 0: a camera path meets a light
  bool nextEvent = true;        // s = 1
  bool connect = false;         // s >= 2, t >= 2
  bool camera = false;          // t = 1
  bool merge = false;           // vertex merging
  bool mergeWeights = true;     // false: merging makes each path once, and alone
  bool firstMerges = false;     // beside connections: merging only where a camera path can for the first time
  bool powerHeuristic = false;  // where s = 0 and s = 1 are all there is: weights by squares of densities
  double vmWeight = 0;          // a merge in dVC: pi r^2 N_L beside connections, 1 without them; 0: never counts
  double vcWeight = 0;          // connection seen from a merge: 1 / vmWeight beside connections, or 0
  double mergeNorm = 0;         // 1 / (pi r^2 N_L)
  double radius = 0;            // r
  double lightPaths = 0;        // N_L
};

// The rendered rectangle of the film: what contributions of light walks are projected to.
struct FilmWindow {
  uint32_t x0 = 0, y0 = 0, width = 0, height = 0;
};

template <class S>
class LightStore;  // kernels/columns/light_vertices.h
template <class S>
struct PhotonMap;  // kernels/merge/photon_map.h

struct CellTreeView;  // kernels/columns/cell_tree.h
struct GuideView;     // kernels/columns/guide_view.h

struct ChainState;  // kernels/columns/chains.h
template <class S>
struct PathMutations;  // kernels/columns/chain_paths.h
template <class S>
struct WalkEnds;  // kernels/columns/chains.h

struct SurvivalRule;  // kernels/columns/survival.h

struct PathLimits {
  uint32_t maxDepth = 64;      // K: edges of the longest path
  uint32_t rouletteDepth = 5;  // first vertex at which Russian roulette may end a path
};

// Counts that stages keep; summed over waves by the session.
struct StageCounters {
  uint64_t raysClosest = 0, raysShadow = 0, misses = 0, nonFinite = 0;
  uint64_t saturatedSplats = 0;  // too large for the film's sums, which hold their limit instead
  uint64_t connections = 0, merges = 0, lightVertices = 0;
  uint64_t closePairs = 0;   // pairs of vertices too close to be told apart, which are not connected
  uint64_t cutPaths = 0;     // paths that the limit of edges has ended,
  double cutThroughput = 0;  // and what they carried together, in units of a path's beginning

  StageCounters& operator+=(const StageCounters& other) {
    raysClosest += other.raysClosest;
    raysShadow += other.raysShadow;
    misses += other.misses;
    nonFinite += other.nonFinite;
    saturatedSplats += other.saturatedSplats;
    connections += other.connections;
    merges += other.merges;
    lightVertices += other.lightVertices;
    closePairs += other.closePairs;
    cutPaths += other.cutPaths;
    cutThroughput += other.cutThroughput;
    return *this;
  }
};

// From the first to the last, both included.
struct DepthRange {
  uint32_t first = 1, last = ~0u;
};

// What methods with light paths add: light vertices to connect to, and photons to merge with.
template <class S>
struct LightContext {
  LightStore<S>* store = nullptr;  // light vertices of this wave's paths
  DepthRange depths{};             // of those that connectVertices joins
  // Limit for Russian roulette of connections (METHODS 5.9), compared with the largest channel of a contribution. 0: no
  // roulette, all connections are joined.
  S rouletteBelow = 0;
  uint32_t repetition = 0;                // of the stages that join vertices until none is left
  const PhotonMap<S>* photons = nullptr;  // light vertices of the whole iteration, by place
  PhotonGrid<S> grid{};                   // where they are in it, if they are to be merged
};

// What Markov chains add: one chain to a lane.
template <class S>
struct ChainContext {
  ChainState* state = nullptr;
  WalkEnds<S>* ends = nullptr;        // of multiplexed chains: where walks stop to be joined
  PathMutations<S>* paths = nullptr;  // of path space: the paths and what is to change about them
};

// What a walk is told beforehand about the path of each lane, as by Markov chains. Null: the walk draws it.
struct LaneColumns {
  const uint32_t* lightPaths = nullptr;     // lanes in which light paths begin; null: the first ones
  const uint32_t* emissionDepth = nullptr;  // the one depth at which emission counts, of camera walks
  const uint32_t* edges = nullptr;          // of the whole path, of which a walk may be a part
  // Output: the pixel that the path of each lane has chosen, in the film's window. Contributions are then summed by
  // lane and not splatted, and rays of neighbouring lanes are incoherent. Null: StageContext::pixels gives the pixels.
  Column<uint32_t> pixel;
};

// What renders that learn add.
struct LearnedContext {
  const CellTreeView* cells = nullptr;  // of vertices
  const GuideView* guide = nullptr;     // what directions are drawn by
  bool records = false;                 // whether scatter keeps records
};

// What an iteration gives to every stage, and what its method adds.
template <class S>
struct StageContext {
  const SceneView<S>* scene = nullptr;
  const uint32_t* pixels = nullptr;  // raster (y << 16 | x) of each path of the iteration, in the order of waves
  SamplerSettings sampler;
  PathLimits limits;
  const SurvivalRule* survival = nullptr;  // of Russian roulette; none: by throughput
  Walk walk = Walk::camera;
  MisSettings mis;
  uint32_t depth = 0;  // index of the vertex that the stage works on; 0 is the path's origin
  FilmWindow film;
  // Camera paths of an iteration all have the same place in their pixel's filter, and the film spreads their samples
  // (kernels/columns/filter_spread.h).
  bool sharedPlace = false;
  StageCounters* counters = nullptr;
  LightContext<S> light{};
  ChainContext<S> chains{};
  LaneColumns lanes{};
  LearnedContext learned{};

  // Contributions of other light walks are splats.
  bool contributesToLanes() const { return walk == Walk::camera || lanes.pixel != nullptr; }
};

template <class S>
using Stage = void (*)(const StageContext<S>&, Wave<S>&);

// Adds splats [begin, end) of the queue to the sums of their pixels (kernels/splat/add_splats.cpp).
template <class S>
using AddSplats = void (*)(const Splats<S>&, size_t begin, size_t end, const SplatSums&, StageCounters&);

// Adds the samples of one tile and iteration to the sums around it; returns how many were not finite
// (kernels/splat/spread_samples.cpp).
template <class S>
using SpreadSamples = uint64_t (*)(const TileSamples<S>&, const SpreadAxis& x, const SpreadAxis& y, const TileSums&);

// The shared places of `count` iterations from the sampler's on (kernels/splat/spread_samples.cpp).
using FilterPlaces = void (*)(const CameraView&, const SamplerSettings&, size_t count, FilterPlace*);

// The functions of the catalogue for one choice; null where a stage's family is not compiled for the feature set.
template <class S>
struct Stages {
  Isa isa{};
  size_t lanes = 0;
  AddSplats<S> addSplats = nullptr;
  SpreadSamples<S> spreadSamples = nullptr;
  FilterPlaces filterPlaces = nullptr;
#define WAVECREST_STAGE_MEMBER(NAME, ...) Stage<S> NAME = nullptr;
  WAVECREST_STAGE_CATALOGUE(WAVECREST_STAGE_MEMBER)
#undef WAVECREST_STAGE_MEMBER

  // id: of the catalogue.
  constexpr Stage<S> of(StageId id) const {
    switch (id) {
#define WAVECREST_STAGE_CASE(NAME, ...) \
  case StageId::NAME:                   \
    return NAME;
      WAVECREST_STAGE_CATALOGUE(WAVECREST_STAGE_CASE)
#undef WAVECREST_STAGE_CASE
      default:
        return nullptr;
    }
  }
};

// The stages compiled for these choices. The instruction set must be one of availableIsas(), S the storage type of the
// precision (double for `doubled`, float otherwise), and isCompiled(precision, specialization) must hold.
template <class S>
const Stages<S>& findStages(Isa isa, Precision precision, Specialization specialization);

}  // namespace wavecrest
