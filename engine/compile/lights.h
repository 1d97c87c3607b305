// Emitters to light records and the table from which lights are picked.
#pragma once

#include <vector>

#include "engine/compile/primitives.h"
#include "engine/compile/textures.h"

namespace wavecrest {

template <class S>
struct Lights {
  std::vector<LightRecord<S>> records;
  std::vector<AliasEntry> table;  // over records
  Environment environment;        // of the envmap emitter, if there is one
  uint32_t infinite = kNoIndex;   // the constant or environment emitter
};

// Each emitting primitive becomes a light of its own, so that picking a light by power also picks the place on a mesh
// by area. Sets `light` of the emitting primitives. Throws SceneError, with the emitter's file and line, for
// more than one infinite light. Bounds and primitives are relative to `origin`, and so are the lights.
template <class S>
Lights<S> compileLights(const Scene& scene, const BoundingSphere& bounds, Primitives<S>& primitives,
                        const Double3& origin = {});

// Gives each textured light a texture of its own in the coordinates of its primitive, which is what sampling a light
// knows; appended to the textures. Throws SceneError for a textured sphere.
template <class S>
void bindLightTextures(const Scene& scene, const Primitives<S>& primitives, Lights<S>& lights, Textures& textures);

// Entries such that picking one uniformly and keeping it with its probability, else taking its alias, yields each index
// in proportion to its weight (Vose 1991). Weights must be >= 0 with a positive sum.
std::vector<AliasEntry> makeAliasTable(const std::vector<double>& weights);

}  // namespace wavecrest
