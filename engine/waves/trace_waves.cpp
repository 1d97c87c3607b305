// One wave of a session: its light and camera passes, the light vertices that it is joined with, the photon map.
#include <algorithm>
#include <bit>
#include <span>

#include "engine/plan/survival.h"
#include "engine/session/add_samples.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/tasks/ticks.h"
#include "engine/waves/wave_session_class.h"

namespace wavecrest {

template <class S>
SamplerSettings WaveSession<S>::samplerAt(uint64_t iteration, uint64_t lightPaths) const {
  const SamplerSettings sampler = samplerOf(settings_, numbers_.number(iteration), lightPaths);
  return learner_.learns() ? ownOfBlock(sampler, iteration) : sampler;
}

template <class S>
void WaveSession<S>::tracePass(const Pass<S>& pass, uint64_t iteration, LightStore<S>* light, Worker& worker) {
  const FlushToZero flushToZero;
  const FilmArea& area = film_.area();
  // Weights, the merging radius and random numbers are those of the iteration in the image.
  const uint64_t number = numbers_.number(iteration);
  const MisSettings mis = misSettings(pass.strategies, plan_.mergeRadius, plan_.memory.lightPaths, number);
  const std::optional<SurvivalRule> rule = survivalRule(settings_, pass.walk);
  StageContext<S> context{.scene = &plan_.view,
                          .pixels = area.pixels.data(),
                          .sampler = samplerAt(iteration, plan_.memory.lightPaths),
                          .limits = settings_.limits,
                          .survival = pointerTo(rule),
                          .mis = mis,
                          .film = area.window(),
                          .sharedPlace = film_.spreads(),
                          .counters = &worker.counters,
                          .light = {.store = light,
                                    .rouletteBelow = plan_.connectionRouletteBelow,
                                    .photons = photons_.mapOf(iteration),
                                    .grid = photonGrid(mis.radius)}};
  if (learner_.learns()) {
    learner_.prepare(context, iteration);
    worker.wave.directions.size = 0;
  }
  auto& tallies = pass.walk == Walk::light ? worker.lightTallies : worker.cameraTallies;
  // Splats go from the wave's queue to the films through the worker's writer.
  SplatDrain<S> drain;
  if (pass.splats) drain = [&](Splats<S>& splats) { worker.splats->drain(splats, worker.counters); };
  runPass(pass, context, worker.wave, settings_.measureStages ? tallies.data() : nullptr, drain);
}

template <class S>
void WaveSession<S>::traceLight(size_t first, size_t count, uint64_t iteration, LightStore<S>& store, Worker& worker) {
  Wave<S>& wave = worker.wave;
  wave.firstPath = first;
  wave.pathCount = count;
  wave.iterationBits = 0;
  tracePass(*plan_.pipeline.lightPass(), iteration, &store, worker);
  worker.lightPaths += wave.pathCount;
}

template <class S>
void WaveSession<S>::traceLightOfPixels(size_t first, size_t count, uint64_t iteration, Worker& worker) {
  const size_t pixels = film_.area().pixels.size();
  for (size_t walk = 0; walk < plan_.memory.lightPaths; walk += pixels) {
    traceLight(walk + first, count, iteration, worker.light, worker);
  }
}

template <class S>
void WaveSession<S>::traceLightWave(size_t waveIndex, uint64_t iteration, Worker& worker) {
  const size_t count = itemsOfPiece(waveIndex, plan_.memory.lightPaths, settings_.waveSize);
  traceLight(waveIndex * settings_.waveSize, count, iteration, photons_.storeOf(iteration, waveIndex), worker);
}

template <class S>
LightStore<S>* WaveSession<S>::partnersOf(size_t waveIndex, uint64_t iteration, Worker& worker) {
  // Without a photon map, the worker holds the light vertices of the wave that it traces.
  if (!plan_.pipeline.has(Fold::photonMap)) return &worker.light;
  if (!plan_.pipeline.cameraPass().strategies.connect) return nullptr;
  const std::span<LightStore<S>* const> stores = photons_.mappedStores(iteration);
  const size_t first = pieces_[waveIndex], count = pieces_[waveIndex + 1] - first;
  // The store of the light wave with this index will do if it has the light paths of exactly these pixels. Otherwise
  // the light vertices are collected from several stores.
  const bool sameCut = waveIndex < stores.size() && first == waveIndex * settings_.waveSize &&
                       count == itemsOfPiece(waveIndex, plan_.memory.lightPaths, settings_.waveSize);
  if (sameCut && plan_.memory.lightPaths == film_.area().pixels.size()) return stores[waveIndex];
  worker.light.collect(stores, plan_.memory.lightPaths, first, count);
  return &worker.light;
}

// Never more iterations at once than there were before, so that a film that is looked at early has samples everywhere.
template <class S>
uint32_t WaveSession<S>::iterationBits(uint64_t next) const {
  const auto log2 = [](uint64_t n) { return static_cast<uint32_t>(std::bit_width(std::max<uint64_t>(n, 1))) - 1; };
  // The sampler needs n consecutive iterations, the first of which is a multiple of n. A batch passes neither the end
  // of the render, nor the end of a learning block, nor the iteration from which on a block gathers no more records.
  return std::min({mostIterationBits(), static_cast<uint32_t>(std::countr_zero(numbers_.number(next))), log2(next),
                   log2(std::min(numbers_.together(next), endIteration_ - next)),
                   log2(learner_.endOfRun(next) - next)});
}

template <class S>
void WaveSession<S>::traceCamera(size_t first, size_t count, uint64_t iteration, uint32_t iterationBits,
                                 LightStore<S>* partners, Worker& worker) {
  Wave<S>& wave = worker.wave;
  wave.firstPath = first;
  wave.iterationBits = iterationBits;
  wave.pathCount = count << iterationBits;
  tracePass(plan_.pipeline.cameraPass(), iteration, partners, worker);
  learner_.gather(wave, iteration);
  worker.counters.nonFinite += addSamples(film_, plan_, samplerAt(iteration), wave);
  worker.paths += wave.pathCount;
  progressPaths_.fetch_add(wave.pathCount, std::memory_order_relaxed);
}

template <class S>
void WaveSession<S>::traceCameraWave(size_t waveIndex, Worker& worker) {
  CameraProgress& progress = camera_[waveIndex];
  const size_t first = pieces_[waveIndex], pixels = pieces_[waveIndex + 1] - first;
  // All pixels of a piece take the same number of iterations at once. The first pixel decides on the number.
  if (progress.pixels == 0) progress.iterationBits = iterationBits(progress.next);
  // Trace as many pixels as fill a wave, up to the end of the piece.
  const size_t some = film_.area().pixelsFrom(first + progress.pixels, pixels - progress.pixels,
                                              settings_.waveSize >> progress.iterationBits, film_.spreads());
  traceCamera(first + progress.pixels, some, progress.next, progress.iterationBits,
              partnersOf(waveIndex, progress.next, worker), worker);
  // After the last pixel, the piece goes on with the next iterations.
  progress.pixels += some;
  if (progress.pixels < pixels) return;
  progress.next += uint64_t{1} << progress.iterationBits;
  progress.pixels = 0;
}

// The pixels of a piece go through the phases of a stretch, in the page's order: a light walk, where there is one, and
// a camera walk of the same iteration.
template <class S>
void WaveSession<S>::traceStretch(const Stretch<S>& stretch, size_t piece, Worker& worker) {
  const size_t first = pieces_[piece], count = pieces_[piece + 1] - first;
  for (const auto& phase : stretch.phases) {
    if (std::get<Pass<S>>(phase).walk == Walk::light) {
      traceLightOfPixels(first, count, camera_[piece].next, worker);
    } else {
      traceCameraWave(piece, worker);
    }
  }
}

template <class S>
PhotonGrid<S> WaveSession<S>::photonGrid(double searchRadius) const {
  if (!plan_.pipeline.has(Fold::photonMap)) return {};
  const SceneView<S>& scene = plan_.view;
  return PhotonGrid<S>::over(scene.center, scene.radius, searchRadius,
                             static_cast<double>(std::max<size_t>(plan_.memory.photons, 1)));
}

template <class S>
void WaveSession<S>::buildPhotonMap(const ScheduledTask& task, Worker& worker) {
  const uint64_t begin = readTicks();
  // All tasks of a map share one row of the statistics. The map's photons are counted once.
  photons_.buildMap(task, photonGrid(plan_.mergeRadius.at(numbers_.number(task.iteration))), settings_.placement);
  worker.photonTally.ticks += readTicks() - begin;
  if (photons_.phases()[task.phase].step == 0) worker.photonTally.items += photons_.mapOf(task.iteration)->size;
}

template class WaveSession<float>;
template class WaveSession<double>;

}  // namespace wavecrest
