#include "engine/waves/light_picks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/waves/pilot_paths.h"

namespace wavecrest {
namespace {

constexpr size_t kPickPlaces = 128;
constexpr double kEvenShare = 0.125;
// Of light from infinitely far away, which has no place and fills many directions: paths meet it by chance as well, and
// multiple importance sampling leaves little of its noise to picks.
constexpr double kInfiniteShare = 0.25;
// Weights in whole parts: instruction sets and precisions differ in the last bits of what they find, and are to make
// the same choices all the same.
constexpr double kParts = 64;

// What an emitter gives to each place if it alone is picked.
template <class S>
std::vector<double> givenBy(size_t emitter, RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                            const std::vector<double>& byChance) {
  Lights<S>& lights = plan.scene->lights;
  std::vector<double> alone(lights.emitters, 0);
  alone[emitter] = 1;
  setPicks(lights, alone);
  std::vector<double> given = brightnessOfPlaces(plan, settings, area, kPickPlaces, PilotLight::unweighted);
  const bool infinite = lights.infinite != kNoIndex && lights.emitterOf[lights.infinite] == emitter;
  for (size_t place = 0; place < kPickPlaces; ++place) {
    given[place] = (infinite ? kInfiniteShare : 1) * std::max(given[place] - byChance[place], 0.0);
  }
  return given;
}

}  // namespace

template <class S>
void pickLightsByView(RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  Lights<S>& lights = plan.scene->lights;
  if (lights.emitters < 2 || lights.emitters > kMostWeighedEmitters) return;
  const std::vector<double> byChance = brightnessOfPlaces(plan, settings, area, kPickPlaces, PilotLight::byChance);
  std::vector<std::vector<double>> given;  // by emitter and place
  std::vector<double> all(kPickPlaces, 0);
  for (size_t emitter = 0; emitter < lights.emitters; ++emitter) {
    given.push_back(givenBy(emitter, plan, settings, area, byChance));
    for (size_t place = 0; place < kPickPlaces; ++place) all[place] += given.back()[place];
  }
  std::vector<double> weights;
  double sum = 0;
  for (const std::vector<double>& places : given) {
    double squares = 0;
    for (size_t place = 0; place < kPickPlaces; ++place) {
      if (all[place] > 0) squares += std::pow(places[place] / all[place], 2);
    }
    weights.push_back(std::sqrt(squares));
    sum += weights.back();
  }
  for (double& weight : weights) weight = sum > 0 ? std::round(kParts * weight / sum) : 0;
  setPicks(lights, evenedShares(weights, kEvenShare));
}
template void pickLightsByView(RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template void pickLightsByView(RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
