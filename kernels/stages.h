// The table of stages: what a pipeline calls, for one instruction set, precision policy and feature set.
//
// Every stage has the same shape: it reads the scene and the state of the pipeline from the context, and turns columns
// of the wave into other columns. A method is a list of these (engine/methods).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "kernels/columns/wave.h"
#include "kernels/sampling/sampler.h"
#include "kernels/scene_view.h"
#include "kernels/simd/isa.h"

namespace wavecrest {

// How numbers are kept and computed. Users trade speed for accuracy: `floating` is the default; `doubled` does shading,
// throughput, densities and MIS weights in double and recomputes hit points in double; `fast` replaces divisions and
// square roots by reciprocal estimates with one Newton step.
enum class Precision { floating, doubled, fast };
constexpr std::array<std::string_view, 3> kPrecisionNames{"float", "double", "fast"};

// What a kernel must be able to handle. A scene gets the first specialisation that covers it; the last covers all.
enum class Specialization { diffuse, smooth, general };
constexpr std::array<std::string_view, 3> kSpecializationNames{"diffuse", "smooth", "general"};

// Bits of a feature set. What a set lacks costs nothing in its kernels.
enum Feature : uint32_t {
  kSpecularBsdfs = 1,   // mirror, conductor, dielectric, rough conductor
  kLayeredBsdfs = 2,    // plastic, rough dielectric, thin dielectric, phong, opacity
  kTextures = 4,        // textures, bump and normal maps
  kShadingNormals = 8,  // interpolated vertex normals
  kCurvedShapes = 16,   // analytic spheres, as geometry or as lights
  kRareLights = 32,     // spot, directional, environment map
  kLens = 64,           // thin lens, orthographic, filters other than box
};
constexpr std::array<uint32_t, 3> kSpecializationFeatures{0, kSpecularBsdfs | kCurvedShapes, 127};

constexpr Specialization chooseSpecialization(uint32_t sceneFeatures) {
  for (size_t i = 0; i + 1 < kSpecializationFeatures.size(); ++i) {
    if ((sceneFeatures & ~kSpecializationFeatures[i]) == 0) return static_cast<Specialization>(i);
  }
  return Specialization::general;
}

struct PathLimits {
  uint32_t maxDepth = 64;      // K: edges of the longest path
  uint32_t rouletteDepth = 5;  // first vertex at which Russian roulette may end a path
};

// Counts that stages keep; summed over waves by the session.
struct StageCounters {
  uint64_t raysClosest = 0, raysShadow = 0, misses = 0, nonFinite = 0;
};

template <class S>
struct StageContext {
  const SceneView<S>* scene = nullptr;
  const uint32_t* pixels = nullptr;  // raster (y << 16 | x) of each path of the iteration, in the order of waves
  SamplerSettings sampler;
  PathLimits limits;
  uint32_t depth = 0;  // index of the vertex that the stage works on; 0 is the path's origin
  StageCounters* counters = nullptr;
};

template <class S>
using Stage = void (*)(const StageContext<S>&, Wave<S>&);

template <class S>
struct Stages {
  Isa isa{};
  size_t lanes = 0;
  Stage<S> generateCameraPaths = nullptr;
  Stage<S> extendSmall = nullptr;   // closest hits by the small-scene intersector
  Stage<S> occludeSmall = nullptr;  // visibility by the small-scene intersector
  Stage<S> arrive = nullptr;
  Stage<S> nextEvent = nullptr;
  Stage<S> scatter = nullptr;
};

// The stages compiled for these choices. The instruction set must be one of availableIsas(), and S must be the storage
// type of the precision (double for `doubled`, float otherwise).
template <class S>
const Stages<S>& findStages(Isa isa, Precision precision, Specialization specialization);

}  // namespace wavecrest
