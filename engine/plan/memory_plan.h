// The memory that a render will take, before it is taken.
//
// in: a render's plan, and what a few waves of its light paths left behind. out: bytes by what they are for, and how
// many light paths an iteration may have so that all of it fits the settings' budget. Waves, film, splats, image and
// the compiled scene are known exactly. Light vertices depend on where light paths go: those of the pilot stand for
// all. Fewer light paths leave nothing out of the image: weights, densities and splats follow their number
// (METHODS 5.1). What a session really holds is reported in the same form (Session::statistics), so the two can be
// compared.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/plan/render_plan.h"

namespace wavecrest {

// The exact parts, for sessions and for plans.
template <class S>
size_t sceneBytes(const CompiledScene<S>& scene);
// Of these the records and attributes of primitives, and the hierarchy.
template <class S>
size_t primitiveBytes(const CompiledScene<S>& scene);
// Of one wave's columns.
size_t waveBytes(size_t bytesPerPath, size_t waveSize);

// With a photon map: how many light stores a session has for `waves` light waves an iteration, besides one per thread
// where their vertices are connected. These are as many for each iteration under way; where there is one, some more,
// into which threads without work trace light paths of the next.
size_t lightStores(const RenderSettings& settings, size_t pixels, size_t waves);

// What the first light paths of iteration 0 left behind (engine/pilot/light_walks.h).
struct LightPilot {
  size_t paths = 0, stored = 0;
  size_t room = 0;  // of the largest store: of all vertices, and of those that it might have stored at last
  // Splats that are finite and not black, and the sum of their exponents: integers, which no order of sums changes.
  int64_t splats = 0, exponents = 0;
  std::vector<std::array<float, 3>> photons{};  // of methods with a photon map: where the stored vertices are
};

// What a session with this plan and these settings will hold. area: its list of pixels may be empty. pilot: of a method
// whose light paths are not those of chains. Throws MemoryBudgetError where it does not fit the settings' budget.
template <class S>
MemoryPlan planMemory(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                      const LightPilot& pilot);

}  // namespace wavecrest
