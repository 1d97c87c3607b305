// The radius of the first merges, where the settings leave it to the image.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/plan/merge_radius.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// Pixels, and light paths of an iteration, of the films that the constants of METHODS 6.5 are fitted to.
constexpr double kUsualFilm = 256 * 192;

// A point where a camera path merges first.
struct MergePlace {
  std::array<float, 3> position{};
  double pixel = 0;  // the side of the square that a pixel covers on the surface
  double lobes = 1;  // how many times as many photons its BSDF takes for the noise that a diffuse one has
};

// Traces camera paths of pixels spread over the whole film, whatever its crop, until they can merge. Depends on the
// scene, the film's size and the limits of paths alone.
template <class S>
std::vector<MergePlace> findMergePlaces(const RenderPlan<S>& plan, const RenderSettings& settings);

struct PhotonDensity {
  double perArea = 0;  // photons: the harmonic mean over places, as noise is that of the mean of the reciprocals
  double lobes = 1;    // of MergePlace, the mean over what photons lie apart by
};

// Of the places, if each of the positions stands for so many photons. 0 where there are too few positions, or no
// places.
PhotonDensity photonDensity(std::span<const MergePlace> places, std::span<const std::array<float, 3>> positions,
                            double photonsPerPosition);

// The plan's radius with `pixel` and `photonsPerArea`, and with the first radius by METHODS 6.5 where the settings
// leave it to the image. Of a method that merges, whose plan.memory is complete.
template <class S>
MergeRadius chosenRadius(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
