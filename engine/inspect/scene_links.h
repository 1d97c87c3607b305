// What a scene's lights, surfaces and eye can see of each other, by kind of scattering.
//
// in: a scene. out: which kinds of events follow each other on the first paths walked from the lights and from the eye,
// and three figures that decide whether a strategy is worth its while. Found by walking and not by looking at the
// materials alone: a pool whose surface is out of view shows the eye no specular event, though its water is one.
#pragma once

#include <array>

#include "engine/scene/scene.h"

namespace wavecrest {

// Event kinds of METHODS 8.1: a surface with more than delta lobes scatters diffusely (D), one with delta lobes
// specularly (S); some do both.
enum class EventKind { diffuse, specular };
enum class LightKindOfPath { extended, delta };  // delta: point, spot and directional lights, which no ray meets

struct SceneLinks {
  using ByEvent = std::array<bool, 2>;
  std::array<ByEvent, 2> fromLight{};  // [light kind][event]: the first event of light paths
  std::array<ByEvent, 2> between{};    // [event][event]: neighbours on a path; symmetric
  ByEvent fromEye{};                   // the first event of camera paths
  bool eyeMeetsLight = false;          // an extended light is in view
  bool eyeSeesGlossy = false;          // a surface of narrow lobes alone is in view
  bool onlyGlossyPairs = false;        // two diffuse events in a row are glossy ones, always
  double lightSolidAngle = 0;          // of the smallest extended light from a distance of the scene's radius, sr
  double cameraCoverage = 0;           // share of the vertices of light paths that the lens sees
  double lightCoverage = 0;            // share of the vertices of camera paths that a sampled light reaches
};

// Roughness below which a surface without a wider lobe counts as glossy.
constexpr float kGlossyAlpha = 0.1f;

// Walks some ten thousand paths from fixed random numbers, so the same scene always gives the same links. Throws
// std::runtime_error where the scene cannot be rendered.
SceneLinks findLinks(const Scene& scene);

}  // namespace wavecrest
