// Epochs of chains: each begins with a bootstrap of its own, from which all chains start anew. What the bootstraps have
// found out about b, and how long each epoch went on.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/pilot/bootstrap.h"
#include "engine/session/session.h"

namespace wavecrest {

// Where in [0, 1) startSamples begins in an epoch: a number that depends on the seed and epoch alone (SplitMix64,
// Steele et al. 2014).
double startOffset(uint64_t seed, uint64_t epoch);

class Epochs {
 public:
  std::vector<float> targets;  // of the bootstrap samples of the epoch that is to begin

  Epochs() = default;
  explicit Epochs(BootstrapPlan plan) : targets(plan.samples()), plan_(std::move(plan)) {}

  // The same for every epoch.
  const BootstrapPlan& plan() const { return plan_; }

  // Begins the next epoch with the targets, of which it returns the sums.
  std::vector<BlockSums> begin();
  // Its chains have taken so many steps more.
  void addSteps(uint64_t steps) { epochs_.back().steps += steps; }

  size_t count() const { return epochs_.size(); }
  // Whether the latest bootstrap found no light.
  bool dark() const { return !(epochs_.back().brightness.mean > 0); }
  // b of the first epoch that found light, which the film is in units of, or 0.
  double unit() const { return unit_; }
  // What the latest epoch's contributions are to be multiplied by for that.
  double scale() const { return epochs_.back().brightness.mean / unit_; }

  // b as the film has it: the epochs' means, each weighted by its steps, and the largest share of all.
  Brightness ofFilm() const;
  // What the samples of all bootstraps say about b, by length.
  const LargeStepSums& bootstraps() const { return sums_; }

  // Everything but the targets, for checkpoints.
  void save(StateWriter& out) const;
  void restore(StateReader& in);

 private:
  struct Epoch {
    Brightness brightness;
    uint64_t steps = 0;
  };
  BootstrapPlan plan_;
  std::vector<Epoch> epochs_;
  LargeStepSums sums_;  // of all bootstraps
  double unit_ = 0;
};

// Sets pooledBrightness and pooledError to b by all samples that know it: those of the bootstraps and of the large
// steps, which must be set.
void poolBrightness(ChainStatistics& chains);

}  // namespace wavecrest
