#include "engine/pilot/light_picks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/pilot/pilot_paths.h"

namespace wavecrest {
namespace {

constexpr size_t kPickPlaces = 128;
constexpr double kEvenShare = 0.125;
// Of light from infinitely far away, which has no place and fills many directions: paths meet it by chance as well, and
// multiple importance sampling leaves little of its noise to picks.
constexpr double kInfiniteShare = 1.0 / 6;
// Weights in whole parts, so that the last bits, in which instruction sets and precisions differ, do not change picks.
constexpr double kParts = 64;

template <class S>
void setPicks(RenderPlan<S>& plan, const std::vector<double>& shares) {
  plan.lights = withPicks(plan.scene->lights, shares);
  plan.view.lights = plan.lights.records.data();
  plan.view.lightTable = plan.lights.table.data();
}

// The emitters that are not black: those that the scene's own lights are picked from.
template <class S>
std::vector<size_t> litEmitters(const Lights<S>& lights) {
  std::vector<double> picks(lights.emitters, 0);
  for (size_t i = 0; i < lights.records.size(); ++i) {
    picks[lights.emitterOf[i]] += static_cast<double>(lights.records[i].pick);
  }
  std::vector<size_t> lit;
  for (size_t emitter = 0; emitter < picks.size(); ++emitter) {
    if (picks[emitter] > 0) lit.push_back(emitter);
  }
  return lit;
}

// What each path gets from an emitter that is picked always.
template <class S>
std::vector<double> givenBy(size_t emitter, RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                            const std::vector<double>& byChance) {
  const Lights<S>& lights = plan.scene->lights;
  std::vector<double> alone(lights.emitters, 0);
  alone[emitter] = 1;
  setPicks(plan, alone);
  std::vector<double> given = tracePilotPaths(plan, settings, area, kPickPlaces, PilotLight::unweighted);
  const bool infinite = lights.infinite != kNoIndex && lights.emitterOf[lights.infinite] == emitter;
  for (size_t i = 0; i < given.size(); ++i) {
    given[i] = (infinite ? kInfiniteShare : 1) * std::max(given[i] - byChance[i], 0.0);
  }
  return given;
}

}  // namespace

template <class S>
void pickLightsByView(RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const Lights<S>& lights = plan.scene->lights;
  const std::vector<size_t> lit = litEmitters(lights);
  if (lit.size() < 2 || lit.size() > kMostWeighedEmitters) return;
  constexpr size_t kPathsPerPlace = kPilotPaths / kPickPlaces;
  const std::vector<double> byChance = tracePilotPaths(plan, settings, area, kPickPlaces, PilotLight::byChance);
  std::vector<std::vector<double>> given;  // by lit emitter and path
  std::vector<double> all(kPickPlaces, 0);
  for (const size_t emitter : lit) {
    given.push_back(givenBy(emitter, plan, settings, area, byChance));
    for (size_t i = 0; i < kPilotPaths; ++i) all[i / kPathsPerPlace] += given.back()[i] / kPathsPerPlace;
  }
  // Paths that pick e with probability p_e have the second moment sum m_e / p_e, least for p_e as the root of m_e. It
  // is taken over the brightness of the place, halfway between absolute and relative errors.
  std::vector<double> weights;
  double sum = 0;
  for (const std::vector<double>& paths : given) {
    double moment = 0;
    for (size_t i = 0; i < kPilotPaths; ++i) {
      const double here = all[i / kPathsPerPlace];
      if (here > 0) moment += paths[i] * paths[i] / here;
    }
    weights.push_back(std::sqrt(moment));
    sum += weights.back();
  }
  for (double& weight : weights) weight = sum > 0 ? std::round(kParts * weight / sum) : 0;
  // Lit emitters out of view have their part of the even picks, black ones have none.
  const std::vector<double> sharesOfLit = evenedShares(weights, kEvenShare, EvenAmong::all);
  std::vector<double> shares(lights.emitters, 0);
  for (size_t i = 0; i < lit.size(); ++i) shares[lit[i]] = sharesOfLit[i];
  setPicks(plan, shares);
}
template void pickLightsByView(RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template void pickLightsByView(RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
