// The memory that a render will take, before it is taken.
//
// in: a scene and settings. out: bytes by what they are for, and how many light paths an iteration may have so that all
// of it fits the settings' budget. Waves, film, splats, image and the compiled scene are known exactly. Light vertices
// depend on where light paths go: those of a few waves are made and counted, and stand for all. Fewer light paths leave
// nothing out of the image: weights, densities and splats follow their number (METHODS 5.1). What a session really
// holds is reported in the same form (Session::statistics), so the two can be compared.
#pragma once

#include <cstddef>
#include <stdexcept>

#include "engine/plan/render_plan.h"

namespace wavecrest {

struct MemoryUse {
  size_t scene = 0;          // primitives, attributes, materials, textures, lights, and the hierarchy
  size_t waves = 0;          // columns of one wave per thread
  size_t film = 0;           // list of the pixels, and their sums
  size_t splats = 0;         // sums of t = 1, in at most kSplatFilms films
  size_t lightVertices = 0;  // of a wave per thread, or with a photon map of all waves
  size_t photonMap = 0;
  size_t chains = 0;  // state of the Markov chains
  size_t image = 0;   // the film resolved to floats, and what that takes on the way; while it is written or looked at

  size_t total() const { return scene + waves + film + splats + lightVertices + photonMap + chains + image; }
};

// The exact parts, for sessions and for plans.
template <class S>
size_t sceneBytes(const CompiledScene<S>& scene);
// Of these the records and attributes of primitives, and the hierarchy.
template <class S>
size_t primitiveBytes(const CompiledScene<S>& scene);
// Of one wave's columns.
size_t waveBytes(size_t bytesPerPath, size_t waveSize);

// With a photon map: how many light stores a session has for `waves` light waves an iteration. These are as many for
// each iteration under way; where there is one, some more, into which threads without work trace light paths of the
// next.
size_t lightStores(const RenderSettings& settings, size_t pixels, size_t waves);

struct MemoryPlan {
  size_t bytesPerPath = 0;  // of the columns of a wave
  MemoryUse use;
  size_t lightPaths = 0;       // N_L: of each iteration
  size_t verticesPerWave = 0;  // room that the light vertices of a wave need
  size_t photons = 0;          // with a photon map: about how many light vertices an iteration has
  double splatScale = 1;       // of the film's sums (kernels/columns/splat_sums.h)
};

// The budget is too small even for the least that a render can do with.
struct MemoryBudgetError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What a session with these settings will hold. Compiles the scene and walks a few waves of light paths. Throws
// std::runtime_error where the method cannot render the scene, MemoryBudgetError where it does not fit the budget.
MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings);
// The same of a plan that has been made.
template <class S>
MemoryPlan planMemory(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
