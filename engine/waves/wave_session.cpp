#include "engine/waves/wave_session.h"

#include <utility>

#include "engine/plan/memory_plan.h"
#include "engine/session/stage_rows.h"
#include "engine/state/state_stream.h"
#include "engine/waves/wave_session_class.h"

namespace wavecrest {

template <class S>
WaveSession<S>::WaveSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared)
    : Base(scene, settings, std::move(prepared)) {
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

// A snapshot divides the sums of splats by the light paths that made them.
template <class S>
void WaveSession<S>::countLightPaths() {
  uint64_t lightPaths = earlier_.lightPaths;
  for (const auto& worker : workers_) lightPaths += worker->lightPaths;
  film_.weighSplats(1, lightPaths);
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
    if (worker->splats) out.memory.splats += worker->splats->bytes();
    if (plan_.pipeline.lightPass() && plan_.lightUse.connected) out.memory.lightVertices += worker->light.bytes();
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
  WorkDone::of(statistics()).save(out);
  learner_.save(out);  // last: a sum of parts has none
}

template <class S>
void WaveSession<S>::restore(StateReader& in) {
  film_.restore(in);
  earlier_.restore(in, statistics().stages);
  learner_.restore(in);
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

template class WaveSession<float>;
template class WaveSession<double>;

template <class S>
std::unique_ptr<Session> makeWaveSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared) {
  return std::make_unique<WaveSession<S>>(scene, settings, std::move(prepared));
}
template std::unique_ptr<Session> makeWaveSession(const Scene&, const RenderSettings&, Prepared<float>);
template std::unique_ptr<Session> makeWaveSession(const Scene&, const RenderSettings&, Prepared<double>);

}  // namespace wavecrest
