// The iterations under way of a method with a photon map: their light stores, their maps, and the phases that an
// iteration consists of.
//
// in: the light vertices that a session's light passes leave in the stores. out: a photon map for the camera passes.
// Iterations take the stores in turn, and so the maps: an iteration may begin as soon as no camera pass reads what it
// writes, which is what the schedule says.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/plan/render_plan.h"
#include "engine/tasks/schedule.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"

namespace wavecrest {

template <class S>
class PhotonIterations {
 public:
  // A phase of an iteration's schedule: a stretch of the page, or a step of the fold behind one.
  struct Phase {
    const Stretch<S>* stretch = nullptr;  // null: a step
    size_t step = 0, tasks = 1;
  };

  // None: of a method without a photon map.
  PhotonIterations() = default;
  // pixels: of the film. cameraPieces: of an iteration's camera walks. The plan must outlive it.
  PhotonIterations(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels, size_t cameraPieces);

  LightStore<S>& storeOf(uint64_t iteration, size_t lightWave) {
    return *stores_[(iteration * lightWaves_ + lightWave) % stores_.size()];
  }
  // Of an iteration whose map has been built. nullptr without a photon map.
  const PhotonMap<S>* mapOf(uint64_t iteration) const {
    return slots_.empty() ? nullptr : &slots_[iteration % slots_.size()].map;
  }
  // The stores that this map is of, by light wave.
  std::span<LightStore<S>* const> mappedStores(uint64_t iteration) const {
    return slots_[iteration % slots_.size()].stores;
  }

  // The page's stretches and folds, in order.
  const std::vector<Phase>& phases() const { return phases_; }
  // The same as a schedule, with what phases wait for.
  Schedule schedule() const;
  // A task of a step of the map. grid: of the iteration's search radius.
  void buildMap(const ScheduledTask& task, const PhotonGrid<S>& grid, const Placement& placement);

  size_t storeBytes() const;
  size_t mapBytes() const;

 private:
  struct Slot {
    PhotonMap<S> map;
    std::vector<LightStore<S>*> stores;
  };

  size_t lightWaves_ = 0;
  Arena memory_;
  std::vector<std::unique_ptr<LightStore<S>>> stores_;  // lightStores() of the memory plan
  std::vector<Slot> slots_;                             // iterationsAtOnce()
  std::vector<typename PhotonMap<S>::BuildStep> buildSteps_;
  std::vector<Phase> phases_;
};

}  // namespace wavecrest
