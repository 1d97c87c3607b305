// The memory that a render will take, before it is taken.
//
// in: a scene and settings. out: bytes by what they are for. Waves, film, splats and the compiled scene are known
// exactly. Light vertices depend on where light paths go: the first wave's are made and counted, and stand for all.
// What a session really holds is reported in the same form (Session::statistics), so the two can be compared.
#pragma once

#include <cstddef>

#include "engine/render_plan.h"

namespace wavecrest {

struct MemoryUse {
  size_t scene = 0;          // primitives, attributes, materials, textures and lights, without the intersector
  size_t waves = 0;          // columns of one wave per thread
  size_t film = 0;           // sums of the pixels
  size_t splats = 0;         // sums of t = 1, per thread
  size_t lightVertices = 0;  // of a wave per thread, or with a photon map of all waves
  size_t photonMap = 0;

  size_t total() const { return scene + waves + film + splats + lightVertices + photonMap; }
};

// The exact parts, for sessions and for plans.
template <class S>
size_t sceneBytes(const CompiledScene<S>& scene);
size_t filmBytes(size_t pixels);
size_t splatBytes(size_t pixels);  // of one worker
// Of one wave's columns.
size_t waveBytes(size_t bytesPerPath, size_t waveSize);

struct MemoryPlan {
  size_t bytesPerPath = 0;  // of the columns of a wave
  MemoryUse use;
};

// What a session with these settings will hold. Compiles the scene and walks one wave of light paths. Throws
// std::runtime_error where the method cannot render the scene.
MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings);

}  // namespace wavecrest
