// How the samples of a traced wave reach the film.
#pragma once

#include <array>
#include <span>

#include "engine/film/film.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// Adds one sample for each path of the wave, spread by the filter if the film spreads; the wave then has whole tiles,
// and its paths have been generated with StageContext::sharedPlace. sampler: of the wave's first iteration. Returns how
// many samples were not finite.
template <class S>
uint64_t addSamples(Film& film, const RenderPlan<S>& plan, const SamplerSettings& sampler, const Wave<S>& wave) {
  if (!film.spreads()) return film.add(wave);
  std::array<FilterPlace, kIterationsPerWave> places;
  const std::span<FilterPlace> used(places.data(), size_t{1} << wave.iterationBits);
  plan.stages->filterPlaces(plan.view.camera, sampler, used.size(), used.data());
  return film.spread(wave, used, plan.stages->spreadSamples);
}

}  // namespace wavecrest
