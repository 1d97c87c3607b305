// The plan of a render: everything that is decided before its first wave.
//
// in: a scene and the user's settings. out: the scene compiled for the precision's storage type, the kernels of the
// instruction set and specialisation, the method's pipeline over them, and which columns its waves need. A session
// renders by it; measurements that need single waves or single stages make one of their own.
#pragma once

#include <memory>

#include "engine/chains/path_law.h"
#include "engine/film.h"
#include "engine/render_settings.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

template <class S>
struct RenderPlan {
  std::unique_ptr<CompiledScene<S>> scene;
  Specialization specialization{};
  ColumnNeeds needs;
  LightVertexUse lightUse;
  Isa isa{};
  Pipeline<S> pipeline;
  PathLaws pathLaws;  // of chains in path space

  Accel accel() const { return scene->accel(); }
};

// S is the storage type of settings.precision. Throws std::runtime_error where the scene cannot be rendered.
template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings);

// The kernels that the settings' own choice, or else the scene and method, lead to. Throws std::runtime_error where the
// choice does not cover the scene.
Specialization specializationFor(const Scene& scene, const RenderSettings& settings);

// The intersector of a scene that was compiled for this structure.
template <class S>
Intersector<S> chooseIntersector(const Stages<S>& stages, Accel accel);

// A pass's switches with the constants of an iteration's densities (METHODS 5.1, 6.1): N_L light paths, and one camera
// path per pixel.
MisSettings misSettings(MisSettings strategies, const RenderSettings& settings, double sceneRadius, size_t lightPaths,
                        uint64_t iteration);

// The rectangle of the film that is rendered: its crop window, or all of it.
FilmArea filmArea(const FilmSettings& film);

}  // namespace wavecrest
