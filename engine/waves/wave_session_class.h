// The class behind makeWaveSession, whose members are in three files: wave_session.cpp has its state, trace_waves.cpp
// takes one wave through its passes, render_turns.cpp hands waves out to threads.
#pragma once

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/plan/share_iterations.h"
#include "engine/session/planned_session.h"
#include "engine/tasks/run_schedule.h"
#include "engine/waves/learner.h"
#include "engine/waves/photon_iterations.h"
#include "engine/waves/wave_worker.h"

namespace wavecrest {

template <class S>
class WaveSession final : public PlannedSession<S> {
 public:
  WaveSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared);

  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) override;
  RenderStatistics statistics() const override;
  std::optional<LearnedDirections> learnedDirections(uint32_t x, uint32_t y) const override {
    const FilmWindow window = film_.area().window();
    return learner_.learnedDirections(plan_, settings_, window.x0 + x, window.y0 + y);
  }
  void save(StateWriter& out) const override;
  void restore(StateReader& in) override;

 private:
  using Base = PlannedSession<S>;
  using Base::arena_, Base::clock_, Base::earlier_, Base::film_, Base::plan_, Base::progressPaths_, Base::settings_;
  using Worker = WaveWorker<S>;
  // How far the pixels of a piece are: iterations [next, next + 2^iterationBits) are being traced, and done for the
  // first `pixels` pixels. Iterations are counted from the session's first; numbers_ has their numbers in the image.
  struct CameraProgress {
    uint64_t next = 0;
    uint32_t iterationBits = 0;
    size_t pixels = 0;
  };
  // Whether a wave is to stop before it traces iteration `next`.
  using Finished = std::function<bool(uint64_t next)>;

  Worker& worker();
  // Takes the worker's wave, whose paths are set, through a pass. iteration: the first of its paths'.
  void tracePass(const Pass<S>& pass, uint64_t iteration, LightStore<S>* light, Worker& worker);
  // The logarithm of how many iterations a camera wave takes at most: of spread samples as many as leave it whole
  // tiles.
  uint32_t mostIterationBits() const {
    return plan_.pipeline.mostIterationBits(settings_.waveSize / (film_.spreads() ? uint32_t{kTilePixels} : 1));
  }
  uint32_t iterationBits(uint64_t next) const;
  // Of an iteration of the session: with which all of its paths are drawn.
  SamplerSettings samplerAt(uint64_t iteration, uint64_t lightPaths = 0) const;
  // Light paths or the camera paths of pixels [first, first + count), of one iteration; of camera paths 2^iterationBits
  // iterations.
  void traceLight(size_t first, size_t count, uint64_t iteration, LightStore<S>& store, Worker& worker);
  void traceCamera(size_t first, size_t count, uint64_t iteration, uint32_t iterationBits, LightStore<S>* partners,
                   Worker& worker);
  // Of a method without a photon map: as many light walks as go with the camera paths of these pixels.
  void traceLightOfPixels(size_t first, size_t count, uint64_t iteration, Worker& worker);
  void traceLightWave(size_t waveIndex, uint64_t iteration, Worker& worker);
  void traceCameraWave(size_t waveIndex, Worker& worker);
  void traceStretch(const Stretch<S>& stretch, size_t piece, Worker& worker);
  // A restored film may have stopped within an iteration. Renders until all its pixels have as many samples as the one
  // that has most.
  void levelPixels(const Finished& finished);
  std::vector<size_t> wavesInTurn() const;
  // Iterations of a method whose waves are independent.
  void renderWaves(const Finished& finished);
  // Iterations of a method with a photon map. end: the time when no other iteration may begin.
  void renderPhases(const Finished& finished, double end);
  // Iterations of any method.
  void renderIterations(const Finished& finished, double end);
  // Iterations in blocks, of a method that learns.
  void renderBlocks(const Finished& finished, double end);
  PhotonGrid<S> photonGrid(double searchRadius) const;
  void buildPhotonMap(const ScheduledTask& task, Worker& worker);
  // Light vertices that the camera paths of a wave are joined with.
  LightStore<S>* partnersOf(size_t waveIndex, uint64_t iteration, Worker& worker);
  void countLightPaths();

  const ShareIterations numbers_{settings_};
  std::vector<size_t> pieces_;          // the first pixel of each camera wave's own, and the end (FilmArea::pieces)
  uint64_t endIteration_ = 0;           // of this renderUntil
  std::vector<CameraProgress> camera_;  // of each tile
  bool level_ = true;                   // false: pixels of a restored film have different numbers of samples
  PhotonIterations<S> photons_;
  Learner<S> learner_;
  double iterationSeconds_ = 0;  // of the latest iterations with a photon map; 0: of none yet
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers_;
};

}  // namespace wavecrest
