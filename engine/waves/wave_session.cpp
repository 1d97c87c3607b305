#include "engine/waves/wave_session.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include "engine/plan/memory_plan.h"
#include "engine/plan/share_iterations.h"
#include "engine/plan/survival.h"
#include "engine/session/add_samples.h"
#include "engine/session/planned_session.h"
#include "engine/session/stage_rows.h"
#include "engine/state/state_stream.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/tasks/for_each.h"
#include "engine/tasks/run_schedule.h"
#include "engine/waves/learner.h"
#include "engine/waves/photon_iterations.h"
#include "engine/waves/wave_worker.h"

namespace wavecrest {
namespace {

template <class S>
class WaveSession final : public PlannedSession<S> {
 public:
  WaveSession(const Scene& scene, const RenderSettings& settings);

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
  // How far the camera paths of a wave's pixels are: 2^iterationBits iterations from `next` on are under way, and done
  // for the first `pixels` of them. The session counts its own iterations from 0 on; numbers_ has their numbers in the
  // image.
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

template <class S>
WaveSession<S>::WaveSession(const Scene& scene, const RenderSettings& settings) : Base(scene, settings) {
  this->finishBuilding([&] {
    const size_t pixels = film_.area().pixels.size();
    if (plan_.pipeline.splats()) film_.makeSplats(settings_.threads, plan_.memory.splatScale);
    // A piece of camera paths is a wave; where waves take several iterations at once, as many pixels as give all
    // threads work.
    const uint32_t together = 1u << mostIterationBits();
    const size_t piece =
        together == 1
            ? settings_.waveSize
            : pieceSize(pixels * together, settings_.cutForThreads(), settings_.waveSize * together) / together;
    pieces_ = film_.area().pieces(piece, film_.spreads());
    camera_.resize(pieces_.size() - 1, {.next = 0});
    if (plan_.pipeline.has(Fold::photonMap)) photons_ = PhotonIterations<S>(plan_, settings_, pixels, camera_.size());
    if (!plan_.pipeline.lessons.empty()) learner_ = Learner<S>(plan_, settings_, pixels);
  });
}

// Returns the calling thread's worker, and makes it at the thread's first wave.
template <class S>
typename WaveSession<S>::Worker& WaveSession<S>::worker() {
  std::unique_ptr<Worker>& mine = workers_.local();
  if (!mine) mine = std::make_unique<Worker>(plan_, settings_.waveSize, film_);
  return *mine;
}

template <class S>
void WaveSession<S>::tracePass(const Pass<S>& pass, uint64_t iteration, LightStore<S>* light, Worker& worker) {
  const FlushToZero flushToZero;
  const FilmArea& area = film_.area();
  // Weights, the merging radius and random numbers are those of the iteration in the image.
  const uint64_t number = numbers_.number(iteration);
  const MisSettings mis = misSettings(pass.strategies, plan_.mergeRadius, plan_.memory.lightPaths, number);
  const std::optional<SurvivalRule> rule = survivalRule(settings_, pass.walk);
  StageContext<S> context{.scene = &plan_.scene->view,
                          .pixels = area.pixels.data(),
                          .sampler = samplerOf(settings_, number, plan_.memory.lightPaths),
                          .limits = settings_.limits,
                          .survival = pointerTo(rule),
                          .mis = mis,
                          .rouletteBelow = plan_.connectionRouletteBelow,
                          .light = light,
                          .photonGrid = photonGrid(mis.radius),
                          .photons = photons_.mapOf(iteration),
                          .film = area.window(),
                          .sharedPlace = film_.spreads(),
                          .counters = &worker.counters};
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
  // The sampler wants the first of n iterations at once to be a multiple of n, and the others to follow it. The last
  // one must not pass the end, of the render or of iterations that learn alike.
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
  worker.counters.nonFinite += addSamples(film_, plan_, samplerOf(settings_, numbers_.number(iteration)), wave);
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

// The camera waves, those that are furthest behind first. A render that stops often, for snapshots, would otherwise
// begin each time with the same pixels, and the last ones would have their first samples late.
template <class S>
std::vector<size_t> WaveSession<S>::wavesInTurn() const {
  std::vector<size_t> order(camera_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::tie(camera_[a].next, camera_[a].pixels) < std::tie(camera_[b].next, camera_[b].pixels);
  });
  return order;
}

// A turn is an iteration of a piece, or several of some of its pixels. A first iteration takes one turn of a piece, so
// all pieces have it before any begins the second.
template <class S>
void WaveSession<S>::renderWaves(const Finished& finished) {
  const std::vector<size_t> order = wavesInTurn();
  takeTurns(camera_.size(), settings_.threads, [&](size_t turn) {
    const size_t wave = order[turn];
    if (finished(camera_[wave].next)) return false;
    traceStretch(plan_.pipeline.stretches.front(), wave, worker());
    return !finished(camera_[wave].next);
  });
}

template <class S>
PhotonGrid<S> WaveSession<S>::photonGrid(double searchRadius) const {
  if (!plan_.pipeline.has(Fold::photonMap)) return {};
  const SceneView<S>& scene = plan_.scene->view;
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

template <class S>
void WaveSession<S>::renderPhases(const Finished& finished, double end) {
  const uint64_t first = camera_.front().next;
  const double before = clock_.shown();
  // Iterations that have begun are finished. One begins early, while others are under way, only where it would begin
  // after them as well.
  const auto mayBegin = [&](uint64_t iteration, size_t underWay) {
    if (finished(iteration)) return false;
    if (underWay == 0 || end == std::numeric_limits<double>::infinity()) return true;
    // An iteration takes the mean time of the iterations that this call has finished.
    const auto done = static_cast<double>(iteration - underWay - first);
    if (done > 0) iterationSeconds_ = (clock_.shown() - before) / done;
    return iterationSeconds_ > 0 && clock_.shown() + static_cast<double>(underWay) * iterationSeconds_ < end;
  };
  // Hand out the tasks of all phases.
  const Schedule schedule = photons_.schedule();
  runSchedule(schedule, first, settings_.threads, mayBegin, [&](const ScheduledTask& task) {
    const Stretch<S>* const stretch = photons_.phases()[task.phase].stretch;
    if (stretch == nullptr) {
      buildPhotonMap(task, worker());
    } else if (stretch->pass(Walk::light) != nullptr) {
      traceLightWave(task.index, task.iteration, worker());
    } else {
      traceCameraWave(task.index, worker());
      finished(task.iteration);  // progress alone: an iteration that has begun is finished
    }
  });
}

template <class S>
void WaveSession<S>::renderIterations(const Finished& finished, double end) {
  if (plan_.pipeline.has(Fold::photonMap)) {
    renderPhases(finished, end);
  } else {
    renderWaves(finished);
  }
}

// Waves stop at the end of their block. Once all have reached it, what they gathered is folded, and the next block
// begins.
template <class S>
void WaveSession<S>::renderBlocks(const Finished& finished, double end) {
  for (;;) {
    const uint64_t blockEnd = learner_.blockEnd();
    renderIterations([&](uint64_t next) { return next >= blockEnd || finished(next); }, end);
    const bool over = std::all_of(camera_.begin(), camera_.end(),
                                  [&](const CameraProgress& progress) { return progress.next == blockEnd; });
    if (!over || finished(blockEnd)) return;
    learner_.fold();
  }
}

// One iteration at a time, light path and camera path of a pixel together, in runs of pixels that stopped together.
template <class S>
void WaveSession<S>::levelPixels(const Finished& finished) {
  const uint64_t goal = film_.maxSamples();
  const std::vector<PixelRun> runs = film_.runsBelow(goal, settings_.waveSize);
  forEach(runs.size(), [&](size_t index) {
    const PixelRun& run = runs[index];
    Worker& mine = worker();
    for (uint64_t next = run.samples; next < goal; ++next) {
      if (finished(next)) return;
      if (plan_.pipeline.lightPass()) traceLightOfPixels(run.first, run.count, next, mine);
      traceCamera(run.first, run.count, next, 0, &mine.light, mine);
    }
  });
  level_ = film_.minSamples() == goal;
}

// A snapshot divides the sums of splats by the light paths that made them.
template <class S>
void WaveSession<S>::countLightPaths() {
  uint64_t lightPaths = earlier_.lightPaths;
  for (const auto& worker : workers_) lightPaths += worker->lightPaths;
  film_.weighSplats(1, lightPaths);
}

template <class S>
void WaveSession<S>::renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) {
  {
    const RenderClock::Running clock(clock_);
    const WorkerLimit limit(settings_.threads);
    endIteration_ = iterations.value_or(std::numeric_limits<uint64_t>::max());
    const Finished finished = [&](uint64_t next) {
      if (next >= endIteration_) return true;
      const double now = clock.look();
      return (seconds && now >= *seconds) || this->interrupted();
    };
    arena_.execute([&] {
      if (!level_) levelPixels(finished);
      if (!level_) return;
      const double end = seconds.value_or(std::numeric_limits<double>::infinity());
      if (learner_.learns()) {
        renderBlocks(finished, end);
      } else {
        renderIterations(finished, end);
      }
    });
  }
  countLightPaths();
}

template <class S>
RenderStatistics WaveSession<S>::statistics() const {
  RenderStatistics out = this->plannedStatistics();
  out.iterations = film_.minSamples();
  if (plan_.pipeline.splats()) out.memory.splats = film_.splats().bytes();
  out.memory.learned = learner_.bytes();
  out.guide = learner_.guideStatistics();
  // Make the rows of the light pass, then those of the camera pass.
  if (plan_.pipeline.lightPass()) addRows(*plan_.pipeline.lightPass(), out.stages);
  const size_t cameraRow = out.stages.size();
  addRows(plan_.pipeline.cameraPass(), out.stages);
  // Add up what all workers have counted.
  for (const auto& worker : workers_) {
    out.paths += worker->paths;
    out.lightPaths += worker->lightPaths;
    out.counters += worker->counters;
    out.bytesPerPath = worker->wave.bytesPerPath();
    out.memory.waves += waveBytes(out.bytesPerPath, settings_.waveSize);
    if (plan_.pipeline.lightPass() && !plan_.pipeline.has(Fold::photonMap))
      out.memory.lightVertices += worker->light.bytes();
    addTallies(worker->lightTallies, 0, out.stages);
    addTallies(worker->cameraTallies, cameraRow, out.stages);
  }
  // The photon map is the last row.
  if (plan_.pipeline.has(Fold::photonMap)) {
    out.stages.push_back({"photon map"});
    for (const auto& worker : workers_) addTallies({worker->photonTally}, out.stages.size() - 1, out.stages);
    out.memory.lightVertices += photons_.storeBytes();
    out.memory.photonMap = photons_.mapBytes();
  }
  earlier_.addTo(out);
  return out;
}

// Which iterations a wave has done is what its pixels' numbers of samples say; light vertices and photons are made anew
// in each iteration.
template <class S>
void WaveSession<S>::save(StateWriter& out) const {
  film_.save(out);
  learner_.save(out);
  WorkDone::of(statistics()).save(out);
}

template <class S>
void WaveSession<S>::restore(StateReader& in) {
  film_.restore(in);
  learner_.restore(in);
  earlier_.restore(in, statistics().stages);
  in.finish();
  // The next renderUntil levels pixels that have fewer samples than others.
  const uint64_t done = film_.maxSamples();
  level_ = film_.minSamples() == done;
  if (!level_ && plan_.pipeline.has(Fold::photonMap)) throw StateError("it ends within an iteration");
  // Pixels may differ within the block under way.
  if (learner_.learns() && (done > learner_.blockEnd() || film_.minSamples() < beginOfBlock(learner_.blockEnd() - 1))) {
    throw StateError("it has other blocks of iterations");
  }
  for (CameraProgress& progress : camera_) progress.next = done;
  this->goOnFromEarlier(earlier_.paths);
  countLightPaths();
}

}  // namespace

template <class S>
std::unique_ptr<Session> makeWaveSession(const Scene& scene, const RenderSettings& settings) {
  return std::make_unique<WaveSession<S>>(scene, settings);
}
template std::unique_ptr<Session> makeWaveSession<float>(const Scene&, const RenderSettings&);
template std::unique_ptr<Session> makeWaveSession<double>(const Scene&, const RenderSettings&);

}  // namespace wavecrest
