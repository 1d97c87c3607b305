#include "engine/chains/chain_session.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "engine/chains/chain_waves.h"
#include "engine/chains/chain_worker.h"
#include "engine/chains/epochs.h"
#include "engine/plan/chain_layout.h"
#include "engine/plan/memory_plan.h"
#include "engine/session/add_samples.h"
#include "engine/session/planned_session.h"
#include "engine/session/stage_rows.h"
#include "engine/state/state_stream.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/tasks/for_each.h"

namespace wavecrest {
namespace {

// Steps of a wave in a turn, before others have theirs: a millisecond or some.
constexpr uint64_t kTurnSteps = 4;
// All waves meet after a round of about this many seconds, when the clock is looked at: threads wait for each other
// there, and an interrupt waits for it.
constexpr double kRoundSeconds = 0.05;

// Mutations of a pixel, in the mean, to a sample of its direct light: a quarter or so of the time goes there.
constexpr uint64_t kMutationsPerDirect = 2;

template <class S>
class ChainSession final : public PlannedSession<S> {
 public:
  ChainSession(const Scene& scene, const RenderSettings& settings);

  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) override;
  RenderStatistics statistics() const override;
  void save(StateWriter& out) const override;
  void restore(StateReader& in) override;

 private:
  using Base = PlannedSession<S>;
  using Base::arena_, Base::clock_, Base::earlier_, Base::film_, Base::plan_, Base::progressPaths_, Base::settings_;

  ChainWorker<S>& worker();
  uint64_t stepsFor(uint64_t iterations) const;
  // Mutations so far: by the chains of this share, and by those of all shares.
  uint64_t mutations() const { return step_ * settings_.chainsOfShare(); }
  uint64_t mutationsOfAll() const { return step_ * settings_.metropolis.chains; }
  bool direct() const { return hasDirectPass(plan_, settings_); }

  // Whether a render is to end: its time is over, or it was interrupted. Checked before every wave.
  using Stop = std::function<bool()>;

  // These return false where they were stopped; the next call goes on from there.
  bool bootstrap(uint64_t epoch, const Stop& stop);
  bool beginEpoch(uint64_t epoch, const Stop& stop);
  bool traceDirect(const Stop& stop);
  void bootstrapWave(size_t wave, uint64_t epoch);
  void advance(uint64_t steps);
  uint64_t stepsInTime(uint64_t most, double secondsLeft) const;
  void addPending();
  void updateFilm();

  Epochs epochs_;
  std::optional<ChainWaves<S>> chains_;  // from the plan on
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<ChainWorker<S>>> workers_;
  std::vector<char> bootstrapped_;  // which waves of the next epoch's bootstrap samples are traced
  uint64_t directDone_ = 0;         // direct light samples of each pixel, of this share; some may have more
  uint64_t step_ = 0;               // steps that every chain has taken
  double stepSeconds_ = 0;          // that the latest with light took
  std::vector<StuckChain> stuck_;   // at the ends of epochs
};

template <class S>
ChainSession<S>::ChainSession(const Scene& scene, const RenderSettings& settings) : Base(scene, settings) {
  if (settings.firstIteration != 0) {
    throw std::invalid_argument("ChainSession: chains cannot begin in the middle; expected the first iteration");
  }
  this->finishBuilding([&] {
    film_.makeSplats(settings_.threads, plan_.memory.splatScale);
    const MetropolisSettings& metropolis = settings_.metropolis;
    const bool multiplexed = plan_.pipeline.lightPass() != nullptr;
    epochs_ = Epochs(multiplexed ? bootstrapByLength(metropolis.bootstrapSamples, direct() ? kDirectLength + 1 : 1,
                                                     settings_.limits.maxDepth)
                                 : plainBootstrap(metropolis.bootstrapSamples));
    chains_.emplace(plan_, settings_, film_.area());
    bootstrapped_.resize(piecesOf(epochs_.targets.size(), settings_.waveSize));
  });
}

template <class S>
ChainWorker<S>& ChainSession<S>::worker() {
  std::unique_ptr<ChainWorker<S>>& mine = workers_.local();
  if (!mine) mine = std::make_unique<ChainWorker<S>>(plan_, settings_.waveSize, film_.splats());
  return *mine;
}

// An iteration is a mutation per pixel in the mean. More mutations than 64 bits count are steps without end.
template <class S>
uint64_t ChainSession<S>::stepsFor(uint64_t iterations) const {
  constexpr uint64_t kEndless = std::numeric_limits<uint64_t>::max();
  const uint64_t chains = settings_.metropolis.chains, pixels = film_.area().pixels.size();
  if (iterations > (kEndless - chains) / pixels) return kEndless;
  return (iterations * pixels + chains - 1) / chains;
}

// Traces the bootstrap samples of one wave, and keeps the target of each.
template <class S>
void ChainSession<S>::bootstrapWave(size_t wave, uint64_t epoch) {
  const FlushToZero flushToZero;
  std::vector<float>& targets = epochs_.targets;
  const size_t first = wave * settings_.waveSize, count = itemsOfPiece(wave, targets.size(), settings_.waveSize);
  // All steps are large, so no current numbers are kept.
  ChainState state(count, {});
  // Bootstrap walks draw the same blocks of numbers as the walks of chains.
  const ChainState::Kept kept = keptSamples(plan_.pipeline, plan_.view, settings_.limits.maxDepth);
  std::copy_n(kept.blocks, 2, state.samples.blocks);
  state.multiplexed = plan_.pipeline.lightPass() != nullptr;
  state.samples.stream = Stream::bootstrap;
  // A probability above one: every step is large.
  state.samples.largeStep = 2;
  // The random numbers of a sample follow from its index and the epoch.
  for (size_t i = 0; i < count; ++i) {
    state.columns.source[i] = static_cast<uint32_t>(first + i);
    state.columns.length[i] = epochs_.plan().lengthOf(first + i);
  }
  StageContext<S> context = chainContext(plan_, settings_, film_.area());
  context.sampler.iteration = epoch;
  ChainWorker<S>& mine = worker();
  mine.trace(context, state, count, false);
  // Moves every chain, from nowhere, to its sample; what it adds to the film is nothing.
  mine.decide(context, state, false);
  for (size_t i = 0; i < count; ++i) targets[first + i] = state.columns.target[i];
}

// Traces what is left of an epoch's bootstrap. Waves that an earlier call has traced are kept.
template <class S>
bool ChainSession<S>::bootstrap(uint64_t epoch, const Stop& stop) {
  forEach(bootstrapped_.size(), [&](size_t wave) {
    if (bootstrapped_[wave] || stop()) return;
    bootstrapWave(wave, epoch);
    bootstrapped_[wave] = 1;
  });
  return std::find(bootstrapped_.begin(), bootstrapped_.end(), 0) == bootstrapped_.end();
}

// Ends the epoch before, if there is one, and starts all chains from new bootstrap samples.
template <class S>
bool ChainSession<S>::beginEpoch(uint64_t epoch, const Stop& stop) {
  if (!bootstrap(epoch, stop)) return false;
  std::fill(bootstrapped_.begin(), bootstrapped_.end(), 0);  // the next epoch has samples of its own
  // Add what chains owe from the epoch before, and list the chains that are stuck at the end of it.
  if (epoch != 0) {
    addPending();
    chains_->listStuck(stuck_);
  }
  const std::vector<BlockSums> targets = epochs_.begin();
  if (epochs_.dark()) {
    chains_->clear();
    return true;
  }
  // Chains start from samples in proportion to their targets.
  const std::vector<uint32_t> starts = startSamples(epochs_.plan(), epochs_.targets, targets,
                                                    settings_.metropolis.chains, startOffset(settings_.seed, epoch));
  forEach(chains_->size(),
          [&](size_t wave) { chains_->start(wave, epoch, epochs_.plan(), starts, epochs_.scale(), worker()); });
  return true;
}

// All chains take `steps` steps, from step_ on. Waves take turns of kTurnSteps steps.
template <class S>
void ChainSession<S>::advance(uint64_t steps) {
  std::vector<uint64_t> done(chains_->size(), 0);
  takeTurns(chains_->size(), settings_.threads, [&](size_t wave) {
    const uint64_t some = std::min(kTurnSteps, steps - done[wave]);
    chains_->advance(wave, step_ + done[wave], some, worker());
    progressPaths_.fetch_add(some * chains_->layout().chainsOf(wave), std::memory_order_relaxed);
    done[wave] += some;
    return done[wave] < steps;
  });
}

// One direct sample of each pixel for every so many mutations of it, the first before the first step: an image with
// mutations has direct light. Where several sessions share the chains, they take turns. One level of samples after the
// other, so that whatever stops it leaves all pixels with about as many.
template <class S>
bool ChainSession<S>::traceDirect(const Stop& stop) {
  const FilmArea& area = film_.area();
  const uint64_t perIteration = kMutationsPerDirect * area.pixels.size(),
                 all = std::max<uint64_t>(1, (mutationsOfAll() + perIteration - 1) / perIteration);
  // This share has samples part, part + parts, ... of all.
  const uint64_t part = settings_.share.part, parts = settings_.share.parts,
                 goal = all > part ? (all - part - 1) / parts + 1 : 0;
  while (directDone_ < goal && !stop()) {
    const std::vector<PixelRun> runs = film_.runsBelow(directDone_ + 1, settings_.waveSize);
    forEach(runs.size(), [&](size_t index) {
      if (stop()) return;
      const FlushToZero flushToZero;
      const PixelRun& run = runs[index];
      StageContext<S> context = chainContext(plan_, settings_, area);
      context.sampler = {settings_.sampler, settings_.seed, part + parts * run.samples, nullptr};
      context.sharedPlace = film_.spreads();
      ChainWorker<S>& mine = worker();
      mine.traceDirect(context, area, run.first, run.count);
      mine.counters.nonFinite += addSamples(film_, plan_, context.sampler, mine.wave());
    });
    directDone_ = film_.minSamples();
  }
  return directDone_ >= goal;
}

// Steps of the round that begins now. Chains move together, as the film divides by one number of steps, so a step that
// has begun is finished. One that would end after the limit, by the time that the latest took, is left out; before
// there is any, one at a time.
template <class S>
uint64_t ChainSession<S>::stepsInTime(uint64_t most, double secondsLeft) const {
  if (stepSeconds_ == 0) return std::min<uint64_t>(most, 1);
  // A recorded render (bench/scaling) has rounds as long as those of the threads that its work is cut for.
  const double recorded = static_cast<double>(settings_.cutForThreads()) / settings_.threads;
  const auto round = std::max(kRoundSeconds * recorded / stepSeconds_, static_cast<double>(kTurnSteps));
  return static_cast<uint64_t>(std::clamp(std::min(round, secondsLeft / stepSeconds_), 0.0, static_cast<double>(most)));
}

// What chains owe at the end of an epoch goes into the sums.
template <class S>
void ChainSession<S>::addPending() {
  std::vector<PendingSplat> pending;
  chains_->addPending(pending);
  for (const PendingSplat& splat : pending) film_.splats().add(splat.pixel, splat.rgb);
}

template <class S>
void ChainSession<S>::updateFilm() {
  std::vector<PendingSplat> pending;
  chains_->addPending(pending);
  film_.setPending(std::move(pending));
  // b N_pix / M
  film_.weighSplats(epochs_.unit() * static_cast<double>(film_.area().pixels.size()), mutations());
}

template <class S>
void ChainSession<S>::renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) {
  {
    const RenderClock::Running clock(clock_);
    const WorkerLimit limit(settings_.threads);
    // Set the limits of this call, in steps and in seconds.
    const uint64_t restart = epochSteps(settings_.metropolis, epochs_.targets.size());
    const uint64_t goal = iterations ? stepsFor(*iterations) : std::numeric_limits<uint64_t>::max();
    const double end = seconds.value_or(std::numeric_limits<double>::infinity());
    const Stop stop = [&] { return (seconds && clock.look() >= *seconds) || this->interrupted(); };
    arena_.execute([&] {
      while (!stop()) {
        // Bring direct light up to the mutations so far.
        if (direct() && !traceDirect(stop)) return;
        if (step_ >= goal) return;
        // All chains start anew at the first step of an epoch.
        if (epochs_.count() <= step_ / restart && !beginEpoch(step_ / restart, stop)) return;
        // Run a round of steps, which ends with the epoch at the latest. Steps of an epoch without light count too, but
        // cost nothing and do not tell how long others take. Direct light is to keep up with them.
        const double before = clock.look();
        const uint64_t most = std::min(restart - step_ % restart, goal - step_);
        const bool dark = epochs_.dark();
        const uint64_t steps = dark ? std::min(most, kTurnSteps) : stepsInTime(most, end - before);
        if (steps == 0) return;
        if (dark) {
          progressPaths_.fetch_add(steps * settings_.chainsOfShare(), std::memory_order_relaxed);
        } else {
          advance(steps);
          stepSeconds_ = (clock.look() - before) / static_cast<double>(steps);
        }
        step_ += steps;
        epochs_.addSteps(steps);
      }
    });
  }
  updateFilm();
}

template <class S>
RenderStatistics ChainSession<S>::statistics() const {
  RenderStatistics out = this->plannedStatistics();
  // Of the whole render, of which a share has some of the chains.
  out.iterations = mutationsOfAll() / film_.area().pixels.size();
  out.paths = mutations();
  // Make the rows of the stages, and add up what all workers have counted.
  for (std::string& name : stageNames(plan_.pipeline)) out.stages.push_back({std::move(name)});
  out.memory.splats = film_.splats().bytes();
  for (const auto& worker : workers_) {
    out.counters += worker->counters;
    out.bytesPerPath = worker->bytesPerPath();
    out.memory.waves +=
        (worker->joinsWalks() ? kWavesOfJoinedWalks : 1) * waveBytes(worker->bytesPerPath(), settings_.waveSize) +
        worker->pathBytes();
    out.memory.splats += worker->splatBytes();
    out.memory.lightVertices += worker->lightBytes();
    addTallies(worker->tallies, 0, out.stages);
  }
  if (direct()) {
    out.stages.push_back({"direct pass"});
    for (const auto& worker : workers_) addTallies({worker->directTally}, out.stages.size() - 1, out.stages);
  }
  earlier_.addTo(out);
  // Add the statistics that only chains have.
  ChainStatistics& chains = out.chains.emplace();
  chains.mutations = mutations();
  chains.directPass = direct();
  chains.directPaths = film_.allSamples();  // which are those of the direct pass alone
  chains.epochs = epochs_.count();
  const Brightness ofFilm = epochs_.ofFilm();
  chains.brightness = ofFilm.mean;
  chains.brightnessError = ofFilm.standardError;
  chains.largestShare = ofFilm.largestShare;
  chains.counters = chains_->counters();
  chains.bytes = chains_->bytes();
  chains.bootstraps = epochs_.bootstraps();
  chains.largeSteps = chains_->largeSteps();
  chains.largeStepsOfAnyLength = plan_.pipeline.inPathSpace;
  poolBrightness(chains);
  chains.stuck = stuck_;
  chains_->listStuck(chains.stuck);
  out.counters.nonFinite += chains.counters.nonFinite;
  // With two walks to a path, walks end where their strategy says, and those of the direct pass after its two edges:
  // longer paths are left out, and none is cut.
  if (plan_.pipeline.lightPass() != nullptr) {
    out.counters.cutPaths = 0;
    out.counters.cutThroughput = 0;
  }
  out.memory.chains = chains.bytes + epochs_.targets.size() * kBootstrapSampleBytes;
  return out;
}

// A bootstrap that is not complete is left out: its samples are traced again.
template <class S>
void ChainSession<S>::save(StateWriter& out) const {
  film_.save(out);
  const RenderStatistics now = statistics();
  WorkDone work = WorkDone::of(now);
  // Mutations follow from the steps; chains keep counts of their own.
  work.paths = 0;
  work.counters.nonFinite -= now.chains->counters.nonFinite;
  work.save(out);
  out.value(step_);
  out.list(stuck_);
  epochs_.save(out);
  chains_->save(out);
}

template <class S>
void ChainSession<S>::restore(StateReader& in) {
  film_.restore(in);
  earlier_.restore(in, statistics().stages);
  step_ = in.value<uint64_t>();
  stuck_ = in.list<StuckChain>();
  epochs_.restore(in);
  // Without an epoch that found light there is no scale, and chains splat nothing.
  const bool lit = epochs_.count() != 0 && !epochs_.dark();
  chains_->restore(in, lit ? epochs_.scale() : 1);
  in.finish();
  directDone_ = film_.minSamples();
  this->goOnFromEarlier(mutations());
  updateFilm();
}

}  // namespace

template <class S>
std::unique_ptr<Session> makeChainSession(const Scene& scene, const RenderSettings& settings) {
  return std::make_unique<ChainSession<S>>(scene, settings);
}
template std::unique_ptr<Session> makeChainSession<float>(const Scene&, const RenderSettings&);
template std::unique_ptr<Session> makeChainSession<double>(const Scene&, const RenderSettings&);

}  // namespace wavecrest
