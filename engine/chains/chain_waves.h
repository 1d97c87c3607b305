// The chains of a render, in waves that workers advance: the states they are in, and in path space their paths.
#pragma once

#include <vector>

#include "engine/chains/chain_worker.h"
#include "engine/pilot/bootstrap.h"
#include "engine/plan/chain_layout.h"
#include "engine/session/session.h"
#include "kernels/columns/chain_paths.h"

namespace wavecrest {

class StateReader;
class StateWriter;

template <class S>
class ChainWaves {
 public:
  // The chains of the settings' share, in waves of at most their size, which are nowhere at first. All three must
  // outlive them.
  ChainWaves(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

  size_t size() const { return layout_.waves(); }
  const ChainLayout& layout() const { return layout_; }

  // The chains of a wave start anew, chain m from sample starts[m] of an epoch's bootstrap. What they add to the film
  // from now on is multiplied by splatFactor.
  void start(size_t wave, uint64_t epoch, const BootstrapPlan& bootstrap, const std::vector<uint32_t>& starts,
             double splatFactor, ChainWorker<S>& worker);
  // No sample has found light to start from: all chains are nowhere, and none is stuck.
  void clear();
  // The chains of a wave take steps first, first + 1, ...
  void advance(size_t wave, uint64_t first, uint64_t steps, ChainWorker<S>& worker);

  // Adds what is due to the states that chains are in: a state is splatted when its chain leaves it.
  void addPending(std::vector<PendingSplat>& splats) const;
  // Adds the chains that have been rejected at least kStuckRejections times in a row; keeps those that were rejected
  // most, kListedStuckChains of them.
  void listStuck(std::vector<StuckChain>& list) const;

  ChainCounters counters() const;
  LargeStepSums largeSteps() const;
  size_t bytes() const;

  // The chains between two steps, for checkpoints: in an order that does not depend on the waves.
  void save(StateWriter& out) const;
  // splatFactor: of the epoch that they are in.
  void restore(StateReader& in, double splatFactor);

 private:
  // One number of each chain of a wave.
  struct Row {
    unsigned char* items;
    size_t bytes;  // of one item
  };
  // All rows that say where chains are, paths up to so many vertices; the same rows for all waves.
  std::vector<Row> rowsOf(size_t wave, uint32_t vertices) const;
  // The most that the path of a chain has.
  uint32_t pathVertices() const;
  // Calls visit(wave, first lane, chains) for each group, in the order of chains.
  template <class Visit>
  void forEachGroup(Visit&& visit) const;

  bool inPathSpace() const { return plan_.pipeline.inPathSpace; }
  PathStore<S>* pathsOf(size_t wave) { return paths_.empty() ? nullptr : &paths_[wave]; }

  const RenderPlan<S>& plan_;
  const RenderSettings& settings_;
  const FilmArea& area_;
  const ChainLayout layout_;
  size_t sampleRows_ = 0;  // of the numbers that a wave keeps
  std::vector<ChainState> states_;
  std::vector<PathStore<S>> paths_;  // in path space; rows as long as those of proposals
};

}  // namespace wavecrest
