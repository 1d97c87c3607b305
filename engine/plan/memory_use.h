// The memory of a render by what it is for, and what was planned of it (memory_plan.h).
#pragma once

#include <cstddef>
#include <stdexcept>

namespace wavecrest {

struct MemoryUse {
  size_t scene = 0;          // primitives, attributes, materials, textures, lights, and the hierarchy
  size_t waves = 0;          // columns of one wave per thread
  size_t film = 0;           // list of the pixels, and their sums
  size_t splats = 0;         // sums of t = 1, in at most kSplatFilms films; with more threads also a queue of each
  size_t lightVertices = 0;  // of a wave per thread where they are connected, and with a photon map of all waves
  size_t photonMap = 0;
  size_t learned = 0;  // what a guide holds at most; pages that it has not reached yet take no memory
  size_t chains = 0;   // state of the Markov chains, and the bootstrap samples from which they start
  size_t image = 0;    // the film resolved to floats, and what that takes on the way; while it is written or looked at

  size_t total() const { return scene + waves + film + splats + lightVertices + photonMap + learned + chains + image; }
};

struct MemoryPlan {
  size_t bytesPerPath = 0;  // of the columns of a wave
  MemoryUse use;
  size_t lightPaths = 0;       // N_L: of each iteration
  size_t verticesPerWave = 0;  // room that the light vertices of a wave need
  size_t partnerVertices = 0;  // the same in a thread's own store, of those that a wave of camera paths is joined with
  size_t photons = 0;          // with a photon map: about how many light vertices an iteration has
  double splatScale = 1;       // of the film's sums (kernels/columns/splat_sums.h)
};

// The budget is too small even for the least that a render can do with.
struct MemoryBudgetError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wavecrest
