// The plan of a render: everything that is decided before its first wave.
//
// in: a scene and the user's settings. out: the scene compiled for the precision's storage type, the kernels of the
// instruction set and specialisation, the method's pipeline over them, and which columns its waves need. A session
// renders by it; measurements that need single waves or single stages make one of their own.
#pragma once

#include <algorithm>
#include <memory>

#include "engine/film/film.h"
#include "engine/plan/memory_use.h"
#include "engine/plan/merge_radius.h"
#include "engine/plan/path_laws.h"
#include "engine/plan/pipeline.h"
#include "engine/plan/render_settings.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

template <class S>
struct RenderPlan {
  std::shared_ptr<const CompiledScene<S>> scene;  // shared with other plans
  SceneView<S> view;                              // of the scene, with the film and the lights of this plan
  PickedLights<S> lights;  // empty unless picks differ from the scene's (engine/pilot/light_picks.h)
  Specialization specialization{};
  ColumnNeeds needs;
  LightVertexUse lightUse;
  Isa isa{};
  const Stages<S>* stages = nullptr;
  Pipeline<S> pipeline;
  PathLaws pathLaws;  // of chains in path space
  // What pilots decide (engine/pilot/finished_plan.h).
  MemoryPlan memory;
  MergeRadius mergeRadius;        // of methods that merge
  S connectionRouletteBelow = 0;  // StageContext::rouletteBelow
  double typicalBrightness = 0;   // of a pixel, where a render learns

  Accel accel() const { return scene->accel(); }
};

// S is the storage type of settings.precision. compiled: the scene as another plan of the same precision, intersector
// and instancing has it; compiled here unless given. Throws std::runtime_error where the scene cannot be rendered.
template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings,
                         std::shared_ptr<const CompiledScene<S>> compiled = nullptr);

// Whether chains leave direct light to a pass of its own. False without chains.
template <class S>
bool hasDirectPass(const RenderPlan<S>& plan, const RenderSettings& settings) {
  return plan.pipeline.directPass && settings.metropolis.directPass;
}

// Whether camera samples are spread over the filter's footprint. Those of Markov chains are not.
template <class S>
bool spreadsSamples(const RenderPlan<S>& plan, const RenderSettings& settings);

// Bits of Feature that the kernels must have for the scene and the settings' method.
uint32_t featuresNeeded(const Scene& scene, const RenderSettings& settings);

// The kernels that the settings' own choice, or else the scene and method, lead to. Throws std::runtime_error where the
// choice does not cover the scene.
Specialization specializationFor(const Scene& scene, const RenderSettings& settings);

// The intersector that the scene was compiled for.
template <class S>
Intersector<S> chooseIntersector(const Stages<S>& stages, const CompiledScene<S>& scene);

// A pass's switches with the constants of an iteration's densities (METHODS 5.1, 6.1): N_L light paths, and one camera
// path per pixel.
MisSettings misSettings(MisSettings strategies, const MergeRadius& radius, size_t lightPaths, uint64_t iteration);

// The number of items, pixels or chains, that one task takes: `most`, or fewer if that would leave some of the threads
// without a task. Images do not depend on it. Too few tasks leave threads idle at the end of a phase. Too small tasks
// leave lanes idle and repeat the fixed cost of each stage: below `least` there are only as many as threads need.
constexpr size_t kLeastPiece = 128;
uint32_t pieceSize(size_t items, uint32_t threads, uint32_t most, uint32_t least = kLeastPiece);
// How many iterations with a photon map may be under way at once: more than one where those of a film of so many pixels
// have few pieces of light and camera paths for each thread. Each takes light stores and a map of its own.
size_t iterationsAtOnce(const RenderSettings& settings, size_t pixels);
// How many pieces of a size some items make, and what the one of this index has.
inline size_t piecesOf(size_t items, size_t size) { return (items + size - 1) / size; }
inline size_t itemsOfPiece(size_t index, size_t items, size_t size) { return std::min(size, items - index * size); }

// The light paths that an iteration has, if memory allows: those of the settings, or one per pixel. Methods that do
// nothing but merge have kLeastLightPaths at least: on a film of a few pixels they would find no photon.
constexpr size_t kLeastLightPaths = 4096;
size_t lightPathsWanted(const RenderSettings& settings, size_t pixels);

// The settings with waves cut by pieceSize, for a method whose waves are pieces of work. pixels: of the rendered part
// of the film. Where samples are spread, a wave has room for a tile.
RenderSettings withPieces(const RenderSettings& settings, const FilmSettings& film, size_t pixels);

// The rectangle of the film that is rendered: its crop window, or all of it.
FilmArea filmArea(const FilmSettings& film);
// The same without its list of pixels.
FilmArea filmOutline(const FilmSettings& film);

}  // namespace wavecrest
