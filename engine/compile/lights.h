// Emitters to light records and the table from which lights are picked.
#pragma once

#include <optional>
#include <vector>

#include "engine/compile/primitives.h"
#include "engine/compile/textures.h"

namespace wavecrest {

template <class S>
struct Lights {
  std::vector<LightRecord<S>> records;
  std::vector<AliasEntry> table;  // over records
  // Of each record its emitter, counted from 0, and its share of that emitter's picks.
  std::vector<uint32_t> emitterOf;
  std::vector<double> withinEmitter;
  size_t emitters = 0;
  Environment environment;       // of the envmap emitter, if there is one
  uint32_t infinite = kNoIndex;  // the constant or environment emitter
};

// Each emitting primitive becomes a light of its own, so that picking a light by power also picks the place on a mesh
// by area. Sets `light` of the emitting primitives. Throws SceneError, with the emitter's file and line, for
// more than one infinite light. Bounds and primitives are relative to `origin`, and so are the lights.
template <class S>
Lights<S> compileLights(const Scene& scene, const BoundingSphere& bounds, Primitives<S>& primitives,
                        const Double3& origin = {});

// Where a light's paths begin, in the scene's coordinates, of those that begin at a point.
std::optional<Double3> positionOf(const Emitter& emitter);

// Light records with their picks, and the table that they are picked from.
template <class S>
struct PickedLights {
  std::vector<LightRecord<S>> records;
  std::vector<AliasEntry> table;
};
// The lights with these picks of emitters: shares that are at least 0 and add up to 1.
template <class S>
PickedLights<S> withPicks(const Lights<S>& lights, const std::vector<double>& shares);
// Shares of which the part `even`, 0 to 1, is divided equally, among all or among those whose weight is not 0; the rest
// is in proportion to `weights`, at least 0. If all weights are 0, all shares are equal.
enum class EvenAmong { all, lit };
std::vector<double> evenedShares(const std::vector<double>& weights, double even, EvenAmong among);

// Gives each textured light a texture of its own in the coordinates of its primitive, which is what sampling a light
// knows; appended to the textures. Throws SceneError for a textured sphere.
template <class S>
void bindLightTextures(const Scene& scene, const Primitives<S>& primitives, Lights<S>& lights, Textures& textures);

}  // namespace wavecrest
