#include "engine/chains/chain_waves.h"

#include <algorithm>
#include <tuple>

#include "engine/state/state_stream.h"
#include "engine/tasks/flush_to_zero.h"

namespace wavecrest {

template <class S>
ChainWaves<S>::ChainWaves(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area)
    : plan_(plan), settings_(settings), area_(area), layout_(settings) {
  // Make memory for all chains, wave by wave.
  const ChainState::Kept kept = keptSamples(plan.pipeline, plan.view, settings.limits.maxDepth);
  for (size_t wave = 0; wave < size(); ++wave) {
    states_.emplace_back(layout_.chainsOf(wave), kept).multiplexed = plan.pipeline.lightPass() != nullptr;
    if (inPathSpace()) paths_.emplace_back(settings.waveSize, plan.pathLaws.law().maxEdges, plan.needs);
  }
  // A column keeps one block: four numbers, each in a row of its own. They are saved whole, also what no walk has
  // drawn.
  sampleRows_ = size_t{4} * ChainState::columnsOf(kept);
  for (ChainState& state : states_) std::fill_n(state.samples.values, sampleRows_ * state.samples.stride, 0u);
}

// Group g is in wave g % size(), at lane g / size() * groupSize() (ChainLayout::chainAt).
template <class S>
template <class Visit>
void ChainWaves<S>::forEachGroup(Visit&& visit) const {
  size_t group = 0;
  for (size_t first = 0; group < layout_.groups(); first += layout_.groupSize()) {
    for (size_t wave = 0; wave < size() && group < layout_.groups(); ++wave, ++group) {
      visit(wave, first, layout_.chainsOfGroup(group));
    }
  }
}

template <class S>
void ChainWaves<S>::start(size_t wave, uint64_t epoch, const BootstrapPlan& bootstrap,
                          const std::vector<uint32_t>& starts, double splatFactor, ChainWorker<S>& worker) {
  const FlushToZero flushToZero;
  ChainState& state = states_[wave];
  Chains& chains = state.columns;
  const size_t count = layout_.chainsOf(wave);
  const ChainCounters before = state.counters;
  const LargeStepSums largeBefore = state.largeSteps;
  // Replays the samples and accepts them all.
  for (size_t i = 0; i < count; ++i) {
    const uint32_t sample = starts[layout_.chainAt(wave, i)];
    chains.source[i] = sample;
    chains.length[i] = bootstrap.lengthOf(sample);
    chains.target[i] = 0;
    chains.weight[i] = 0;
  }
  state.splatFactor = static_cast<float>(splatFactor);
  state.samples.stream = Stream::bootstrap;
  // A probability above one: every step is large.
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
    chains.source[i] = static_cast<uint32_t>(layout_.chainAt(wave, i));
    chains.weight[i] = 0;
    chains.rejections[i] = 0;
    if (inPathSpace()) chains.length[i] = 0;  // of any length from now on
  }
}

template <class S>
void ChainWaves<S>::clear() {
  for (size_t wave = 0; wave < size(); ++wave) {
    std::fill_n(static_cast<float*>(states_[wave].columns.target), layout_.chainsOf(wave), 0.0f);
    std::fill_n(static_cast<uint32_t*>(states_[wave].columns.rejections), layout_.chainsOf(wave), 0u);
  }
}

template <class S>
void ChainWaves<S>::advance(size_t wave, uint64_t first, uint64_t steps, ChainWorker<S>& worker) {
  const FlushToZero flushToZero;
  ChainState& state = states_[wave];
  StageContext<S> context = chainContext(plan_, settings_, area_);
  for (uint64_t step = first; step < first + steps; ++step) {
    // Random numbers follow from the step and the chain.
    context.sampler.iteration = step;
    worker.trace(context, state, layout_.chainsOf(wave), settings_.measureStages, pathsOf(wave));
    worker.decide(context, state, settings_.measureStages);
  }
}

template <class S>
void ChainWaves<S>::addPending(std::vector<PendingSplat>& splats) const {
  forEachGroup([&](size_t wave, size_t first, size_t count) {
    const ChainState& state = states_[wave];
    const Chains& chains = state.columns;
    for (size_t i = first; i < first + count; ++i) {
      // A chain that is nowhere owes nothing.
      if (!(chains.target[i] > 0)) continue;
      // `weight` is the number of expected visits that are not on the film yet.
      const double visits = static_cast<double>(chains.weight[i]) * static_cast<double>(state.splatFactor);
      splats.push_back({chains.pixel[i],
                        static_cast<uint32_t>(layout_.chainAt(wave, i)),
                        {visits * static_cast<double>(chains.red[i]), visits * static_cast<double>(chains.green[i]),
                         visits * static_cast<double>(chains.blue[i])}});
    }
  });
}

template <class S>
void ChainWaves<S>::listStuck(std::vector<StuckChain>& list) const {
  forEachGroup([&](size_t wave, size_t first, size_t count) {
    const Chains& chains = states_[wave].columns;
    for (size_t i = first; i < first + count; ++i) {
      if (chains.rejections[i] < kStuckRejections) continue;
      // Paths of pssmlt have no fixed length: vertices that draw numbers are counted instead.
      const uint32_t edges = inPathSpace()               ? paths_[wave].headers.edges[i]
                             : states_[wave].multiplexed ? chains.length[i]
                                                         : chains.cameraVertices[i];
      list.push_back({static_cast<uint32_t>(layout_.chainAt(wave, i)), chains.rejections[i], edges, chains.pixel[i]});
    }
  });
  // The sort is stable, so that the list does not depend on how chains lie in waves.
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

template <class S>
uint32_t ChainWaves<S>::pathVertices() const {
  uint32_t edges = 0;
  for (size_t wave = 0; wave < paths_.size(); ++wave) {
    const uint32_t* const ofWave = paths_[wave].headers.edges;
    edges = std::max(edges, *std::max_element(ofWave, ofWave + layout_.chainsOf(wave)));
  }
  return edges + 1;
}

template <class S>
std::vector<typename ChainWaves<S>::Row> ChainWaves<S>::rowsOf(size_t wave, uint32_t vertices) const {
  std::vector<Row> rows;
  const auto add = [&](auto* items) { rows.push_back({reinterpret_cast<unsigned char*>(items), sizeof(*items)}); };
  // all() has one form, for writing.
  const auto columnsOf = [](const auto& columns) {
    return const_cast<std::decay_t<decltype(columns)>&>(columns).all();
  };
  // Calls visit for each column that is not dropped.
  const auto forEachColumn = [&](const auto& columns, auto visit) {
    std::apply([&](auto&... column) { ((column.needed() ? visit(column) : void()), ...); }, columnsOf(columns));
  };
  // The rows are columns of the chains, then numbers that chains keep, then paths.
  const ChainState& state = states_[wave];
  forEachColumn(state.columns, [&](auto& column) { add(&column[0]); });
  for (size_t row = 0; row < sampleRows_; ++row) add(state.samples.values + row * state.samples.stride);
  if (inPathSpace()) {
    const PathStore<S>& paths = paths_[wave];
    forEachColumn(paths.headers, [&](auto& column) { add(&column[0]); });
    forEachColumn(paths.vertices, [&](auto& column) {
      for (size_t vertex = 0; vertex < vertices; ++vertex) add(&column[vertex * paths.stride()]);
    });
  }
  return rows;
}

template <class S>
void ChainWaves<S>::save(StateWriter& out) const {
  static_assert(sizeof(ChainCounters) == (2 * kMutationKinds + 4) * sizeof(uint64_t), "padding would be written");
  // Counts are sums over all waves.
  out.value(counters());
  out.value(largeSteps());
  // Write row by row over all waves, so that the state does not depend on how chains lie in waves.
  const uint32_t vertices = pathVertices();
  out.value(vertices);
  std::vector<std::vector<Row>> rows;
  for (size_t wave = 0; wave < size(); ++wave) rows.push_back(rowsOf(wave, vertices));
  for (size_t row = 0; row < rows.front().size(); ++row) {
    forEachGroup([&](size_t wave, size_t first, size_t count) {
      const Row& of = rows[wave][row];
      out.bytes({of.items + first * of.bytes, count * of.bytes});
    });
  }
}

template <class S>
void ChainWaves<S>::restore(StateReader& in, double splatFactor) {
  // Of all waves together; which of them has counted does not matter.
  states_.front().counters = in.value<ChainCounters>();
  states_.front().largeSteps = in.value<LargeStepSums>();
  // The saved paths must fit the memory of the chains.
  const auto vertices = in.value<uint32_t>();
  if (vertices == 0 || (inPathSpace() && vertices > plan_.pathLaws.law().maxEdges + 1)) {
    throw StateError("its paths are too long");
  }
  std::vector<std::vector<Row>> rows;
  for (size_t wave = 0; wave < size(); ++wave) rows.push_back(rowsOf(wave, vertices));
  for (size_t row = 0; row < rows.front().size(); ++row) {
    forEachGroup([&](size_t wave, size_t first, size_t count) {
      const Row& of = rows[wave][row];
      in.items(of.items + first * of.bytes, count * of.bytes);
    });
  }
  // Check the pixels, which are indices into the film. Set what follows from the settings and the epoch.
  for (size_t wave = 0; wave < size(); ++wave) {
    ChainState& state = states_[wave];
    const uint32_t* const pixels = state.columns.pixel;
    const size_t filmPixels = area_.pixels.size();
    if (std::any_of(pixels, pixels + layout_.chainsOf(wave), [&](uint32_t pixel) { return pixel >= filmPixels; })) {
      throw StateError("its chains are beyond the film");
    }
    state.splatFactor = static_cast<float>(splatFactor);
    state.samples.stream = Stream::chain;
    state.samples.largeStep = static_cast<float>(settings_.metropolis.largeStep);
  }
}

template class ChainWaves<float>;
template class ChainWaves<double>;

}  // namespace wavecrest
