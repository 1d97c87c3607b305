// Which wave is next: turns of independent waves, phases of iterations with a photon map, blocks of those that learn.
#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "engine/tasks/for_each.h"
#include "engine/waves/wave_session_class.h"

namespace wavecrest {

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
    learner_.fold(film_);
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

template class WaveSession<float>;
template class WaveSession<double>;

}  // namespace wavecrest
