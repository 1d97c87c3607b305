#include "engine/waves/photon_iterations.h"

#include "engine/plan/memory_plan.h"
#include "engine/tasks/thread_pins.h"

namespace wavecrest {

template <class S>
PhotonIterations<S>::PhotonIterations(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels,
                                      size_t cameraPieces)
    : lightWaves_(piecesOf(plan.memory.lightPaths, settings.waveSize)),
      slots_(iterationsAtOnce(settings, pixels)),
      buildSteps_(PhotonMap<S>::buildSteps(lightWaves_)) {
  const size_t count = lightStores(settings, pixels, lightWaves_);
  stores_.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    stores_.push_back(std::make_unique<LightStore<S>>(settings.waveSize, plan.needs, plan.lightUse));
    LightStore<S>& store = *stores_.back();
    // All stores lie in one arena and take equal parts of it.
    if (i == 0) memory_ = Arena(count * store.arenaBytes(plan.memory.verticesPerWave));
    store.reserve(plan.memory.verticesPerWave, memory_);
  }
  for (Slot& slot : slots_) slot.stores.resize(lightWaves_);
  // The tables of the map are one step, and the others are the map's own.
  for (const Stretch<S>& stretch : plan.pipeline.stretches) {
    phases_.push_back({&stretch, 0, stretch.pass(Walk::light) != nullptr ? lightWaves_ : cameraPieces});
    if (!stretch.fold) continue;
    phases_.push_back({});
    for (size_t step = 0; step < buildSteps_.size(); ++step)
      phases_.push_back({nullptr, step + 1, buildSteps_[step].tasks});
  }
}

template <class S>
Schedule PhotonIterations<S>::schedule() const {
  Schedule schedule;
  for (const Phase& phase : phases_) schedule.tasks.push_back(phase.tasks);
  // Light waves of all iterations take the stores in turn. The first `ahead` waves of iteration i reuse stores of
  // iteration i - atOnce - 1, and the other waves reuse stores of iteration i - atOnce. Camera passes read the stores
  // and the map of their iteration. A pixel's samples are added in order.
  const size_t atOnce = slots_.size(), light = 0, map = 1, camera = phases_.size() - 1;
  schedule.waits = {{.phase = light, .on = camera, .earlier = atOnce, .ahead = stores_.size() - atOnce * lightWaves_},
                    {.phase = light, .on = camera, .earlier = atOnce + 1},
                    {.phase = map, .on = camera, .earlier = atOnce},
                    {.phase = camera, .on = camera, .earlier = 1, .sameTask = true}};
  return schedule;
}

template <class S>
void PhotonIterations<S>::buildMap(const ScheduledTask& task, const PhotonGrid<S>& grid, const Placement& placement) {
  Slot& slot = slots_[task.iteration % slots_.size()];
  if (const size_t step = phases_[task.phase].step; step != 0) {
    (slot.map.*buildSteps_[step - 1].run)(task.index);
    return;
  }
  // The first step binds the map to the stores of the iteration and makes the tables. All threads read the tables, so
  // their pages are spread over the nodes.
  for (size_t wave = 0; wave < lightWaves_; ++wave) slot.stores[wave] = &storeOf(task.iteration, wave);
  const SpreadMemory spread(placement);
  slot.map.prepare(slot.stores, grid);
}

template <class S>
size_t PhotonIterations<S>::storeBytes() const {
  size_t bytes = 0;
  for (const auto& store : stores_) bytes += store->bytes();
  return bytes;
}

template <class S>
size_t PhotonIterations<S>::mapBytes() const {
  size_t bytes = 0;
  for (const Slot& slot : slots_) bytes += slot.map.bytes();
  return bytes;
}

template class PhotonIterations<float>;
template class PhotonIterations<double>;

}  // namespace wavecrest
