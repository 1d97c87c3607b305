// The scene in the form that one precision's kernels read, and everything that owns its memory.
#pragma once

#include <memory>
#include <vector>

#include "engine/compile/instances.h"
#include "engine/compile/lights.h"
#include "engine/compile/passages.h"
#include "engine/compile/primitives.h"
#include "engine/compile/textures.h"
#include "kernels/extend/bvh.h"
#include "kernels/extend/embree_scene.h"
#include "kernels/extend/small_scene.h"
#include "kernels/stages.h"

namespace wavecrest {

// Scenes of up to this many primitives are faster without a hierarchy (measured: bench/micro, crossover).
constexpr uint32_t kSmallSceneLimit = 96;

// What a scene asks of the kernels, before anything is compiled: Feature bits. keeps: its instances (instances.h).
uint32_t sceneFeatures(const Scene& scene, bool keeps = false);

// Whether a shape's BSDF depends on the direction of dp/du.
bool hasTangents(const Scene& scene);

template <class S>
struct CompiledScene {
  Double3 origin{};  // of all coordinates below, in those of the scene (originOf)
  BoundingSphere bounds;
  Primitives<S> primitives;
  RecordArray<InstanceRecord<S>> instances;  // if the scene keeps its instances
  std::vector<MaterialRecord> materials;
  std::vector<CompoundRecord> compounds;           // of each material, if one is a compound BSDF
  std::vector<PassageRecord> passages;             // of each material, if light goes straight on through one
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
std::unique_ptr<CompiledScene<S>> compileScene(const Scene& scene, Accel accel, bool watertightEmbree = true,
                                               Instancing instancing = Instancing::automatic);

// Around the points outside of the scene's bounds that rays may start from, relative to `origin` as all else: the eye,
// and lights that have a place. Lights beyond farthestLight radii of the scene count as if they were there:
// intersectors widen boxes in proportion, and so few of such a light's paths meet the scene that what slips through is
// lost in noise.
constexpr double kFarthestLight = 1024;
Box rayOrigins(const Scene& scene, const BoundingSphere& bounds, const double (&eye)[3], const Double3& origin,
               double farthestLight = kFarthestLight);

class SceneGeometry;

// The camera of a sensor over its full film, relative to `origin`.
CameraView compileCamera(const Sensor& sensor, const FilmSettings& film, const Double3& origin = {});

// The camera with another film of the same aspect ratio. Clips stay.
CameraView withFilm(const CameraView& camera, const Sensor& sensor, const FilmSettings& film, const Double3& origin);

// Sets the camera's clips where a primitive, in the camera's coordinates, may lie outside of them. Most scenes have
// nothing there, and then rays begin at the lens and need no test. Of spheres in instances their boxes count.
// bounds: of the geometry, in any precision.
void setClips(const Sensor& sensor, const SceneGeometry& geometry, const BoundingSphere& bounds, CameraView& camera);

}  // namespace wavecrest
