// The scene in the form that one precision's kernels read, and everything that owns its memory.
#pragma once

#include <memory>
#include <vector>

#include "engine/compile/lights.h"
#include "engine/compile/primitives.h"
#include "engine/compile/textures.h"
#include "kernels/extend/bvh.h"
#include "kernels/extend/embree_scene.h"
#include "kernels/extend/small_scene.h"
#include "kernels/stages.h"

namespace wavecrest {

// small: a loop over all primitives, for small scenes. bvh: our own hierarchy, for all others. embree: what bvh is
// measured against, and an independent check of it.
enum class Accel { automatic, embree, small, bvh };
constexpr std::array<std::string_view, 4> kAccelNames{"auto", "embree", "small", "bvh"};

// Scenes of up to this many primitives are faster without a hierarchy (measured: bench/micro, crossover).
constexpr uint32_t kSmallSceneLimit = 96;

// What a scene asks of the kernels, before anything is compiled: Feature bits.
uint32_t sceneFeatures(const Scene& scene);

template <class S>
struct CompiledScene {
  Double3 origin{};  // of all coordinates below, in those of the scene (originOf)
  Primitives<S> primitives;
  std::vector<MaterialRecord> materials;
  std::unique_ptr<PrimitiveTable> primitiveTable;  // if they are few, and in float
  std::unique_ptr<MaterialTable> materialTable;    // if they are few
  Textures textures;
  Lights<S> lights;
  // One of these three.
  std::unique_ptr<SmallScene> small;
  std::unique_ptr<Bvh> bvh;
  std::unique_ptr<EmbreeScene> embree;
  SceneView<S> view;  // into all of the above

  Accel accel() const { return small ? Accel::small : bvh ? Accel::bvh : Accel::embree; }

  CompiledScene() = default;
  CompiledScene(const CompiledScene&) = delete;
  CompiledScene& operator=(const CompiledScene&) = delete;
};

// Builds everything, the hierarchy on all threads of the task arena. Throws SceneError where the scene cannot be
// rendered.
template <class S>
std::unique_ptr<CompiledScene<S>> compileScene(const Scene& scene, Accel accel, bool watertightEmbree = true);

// The camera of a sensor over its full film, relative to `origin`.
CameraView compileCamera(const Sensor& sensor, const FilmSettings& film, const Double3& origin = {});

// Sets the camera's clips where a primitive, in the camera's coordinates, may lie outside of them. Most scenes have
// nothing there, and then rays begin at the lens and need no test.
void setClips(const Sensor& sensor, const std::vector<PrimitiveRecord<double>>& primitives, CameraView& camera);

}  // namespace wavecrest
