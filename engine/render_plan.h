// The plan of a render: everything that is decided before its first wave.
//
// in: a scene and the user's settings. out: the scene compiled for the precision's storage type, the kernels of the
// instruction set and specialisation, the method's pipeline over them, and which columns its waves need. A session
// renders by it; measurements that need single waves or single stages make one of their own.
#pragma once

#include <memory>

#include "engine/film.h"
#include "engine/render_settings.h"

namespace wavecrest {

template <class S>
struct RenderPlan {
  std::unique_ptr<CompiledScene<S>> scene;
  Specialization specialization{};
  ColumnNeeds needs;
  Isa isa{};
  Pipeline<S> pipeline;

  Accel accel() const { return scene->small != nullptr ? Accel::small : Accel::embree; }
};

// S is the storage type of settings.precision. Throws std::runtime_error where the scene cannot be rendered.
template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings);

// Constants of an iteration's densities (METHODS 5.1, 6.1): one light path per pixel of the rendered rectangle.
MisSettings misSettings(MisSettings strategies, const RenderSettings& settings, double sceneRadius, size_t pixels,
                        uint64_t iteration);

// The rectangle of the film that is rendered: its crop window, or all of it.
FilmArea filmArea(const FilmSettings& film);

}  // namespace wavecrest
