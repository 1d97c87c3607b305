#include "engine/chains/chain_waves.h"

#include <algorithm>

#include "engine/flush_to_zero.h"

namespace wavecrest {

template <class S>
ChainWaves<S>::ChainWaves(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area)
    : plan_(plan), settings_(settings), area_(area) {
  const ChainState::Kept kept = keptSamples(plan.pipeline, plan.scene->view, settings.limits.maxDepth);
  const size_t waves = (settings.metropolis.chains + settings.waveSize - 1) / settings.waveSize;
  for (size_t wave = 0; wave < waves; ++wave) {
    states_.emplace_back(chainCount(wave), kept).multiplexed = plan.pipeline.lightPass.has_value();
    if (inPathSpace()) paths_.emplace_back(settings.waveSize, plan.pathLaws.law().maxEdges, plan.needs);
  }
}

template <class S>
size_t ChainWaves<S>::chainCount(size_t wave) const {
  return std::min<size_t>(settings_.waveSize, settings_.metropolis.chains - firstChain(wave));
}

template <class S>
void ChainWaves<S>::start(size_t wave, uint64_t epoch, const BootstrapPlan& bootstrap,
                          const std::vector<uint32_t>& starts, double splatFactor, ChainWorker<S>& worker) {
  const FlushToZero flushToZero;
  ChainState& state = states_[wave];
  Chains& chains = state.columns;
  const size_t count = chainCount(wave);
  const ChainCounters before = state.counters;
  const LargeStepSums largeBefore = state.largeSteps;
  // Replays the samples and accepts them all.
  for (size_t i = 0; i < count; ++i) {
    const uint32_t sample = starts[firstChain(wave) + i];
    chains.source[i] = sample;
    chains.length[i] = bootstrap.length[sample];
    chains.target[i] = 0;
    chains.weight[i] = 0;
  }
  state.splatFactor = static_cast<float>(splatFactor);
  state.samples.stream = Stream::bootstrap;
  state.samples.largeStep = 2;
  StageContext<S> context = chainContext(plan_, settings_, area_);
  context.sampler.iteration = epoch;
  worker.trace(context, state, count, false, pathsOf(wave));
  worker.decide(context, state, false);

  // From here on chains are themselves. The start is no step and has no weight.
  state.counters = before;
  state.largeSteps = largeBefore;
  state.samples.stream = Stream::chain;
  state.samples.largeStep = static_cast<float>(settings_.metropolis.largeStep);
  for (size_t i = 0; i < count; ++i) {
    chains.source[i] = static_cast<uint32_t>(firstChain(wave) + i);
    chains.weight[i] = 0;
    chains.rejections[i] = 0;
    if (inPathSpace()) chains.length[i] = 0;  // of any length from now on
  }
}

template <class S>
void ChainWaves<S>::clear() {
  for (size_t wave = 0; wave < size(); ++wave) {
    std::fill_n(static_cast<float*>(states_[wave].columns.target), chainCount(wave), 0.0f);
  }
}

template <class S>
void ChainWaves<S>::advance(size_t wave, uint64_t first, uint64_t steps, ChainWorker<S>& worker) {
  const FlushToZero flushToZero;
  ChainState& state = states_[wave];
  StageContext<S> context = chainContext(plan_, settings_, area_);
  for (uint64_t step = first; step < first + steps; ++step) {
    context.sampler.iteration = step;
    worker.trace(context, state, chainCount(wave), settings_.measureStages, pathsOf(wave));
    worker.decide(context, state, settings_.measureStages);
  }
}

template <class S>
void ChainWaves<S>::addPending(std::vector<PendingSplat>& splats) const {
  for (size_t wave = 0; wave < size(); ++wave) {
    const ChainState& state = states_[wave];
    const Chains& chains = state.columns;
    for (size_t i = 0; i < chainCount(wave); ++i) {
      if (!(chains.target[i] > 0)) continue;
      const double visits = static_cast<double>(chains.weight[i]) * static_cast<double>(state.splatFactor);
      splats.push_back({chains.pixel[i],
                        {visits * static_cast<double>(chains.red[i]), visits * static_cast<double>(chains.green[i]),
                         visits * static_cast<double>(chains.blue[i])}});
    }
  }
}

template <class S>
void ChainWaves<S>::listStuck(std::vector<StuckChain>& list) const {
  for (size_t wave = 0; wave < size(); ++wave) {
    const Chains& chains = states_[wave].columns;
    for (size_t i = 0; i < chainCount(wave); ++i) {
      if (chains.rejections[i] < kStuckRejections) continue;
      const uint32_t edges = inPathSpace()               ? paths_[wave].headers.edges[i]
                             : states_[wave].multiplexed ? chains.length[i]
                                                         : chains.cameraVertices[i];
      list.push_back({static_cast<uint32_t>(firstChain(wave) + i), chains.rejections[i], edges, chains.pixel[i]});
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const StuckChain& a, const StuckChain& b) { return a.rejections > b.rejections; });
  if (list.size() > kListedStuckChains) list.resize(kListedStuckChains);
}

template <class S>
ChainCounters ChainWaves<S>::counters() const {
  ChainCounters sum;
  for (const ChainState& state : states_) sum += state.counters;
  return sum;
}

template <class S>
LargeStepSums ChainWaves<S>::largeSteps() const {
  LargeStepSums sum;
  for (const ChainState& state : states_) sum += state.largeSteps;
  return sum;
}

template <class S>
size_t ChainWaves<S>::bytes() const {
  size_t sum = paths_.size() * PathStore<S>::bytesFor(settings_.waveSize, plan_.pathLaws.law().maxEdges, plan_.needs);
  for (const ChainState& state : states_) sum += state.bytes();
  return sum;
}

template class ChainWaves<float>;
template class ChainWaves<double>;

}  // namespace wavecrest
