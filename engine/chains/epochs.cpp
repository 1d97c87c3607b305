#include "engine/chains/epochs.h"

#include <algorithm>
#include <cmath>

#include "engine/state/state_stream.h"

namespace wavecrest {

double startOffset(uint64_t seed, uint64_t epoch) {
  // The increment comes before the finalizer, which maps 0 to 0.
  uint64_t x = (seed + 1) * 0x9e3779b97f4a7c15u + epoch;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

std::vector<BlockSums> Epochs::begin() {
  std::vector<BlockSums> blocks = sumsOf(plan_, targets);
  for (size_t i = 0; i < blocks.size(); ++i) {
    const uint32_t length = plan_.length[i];
    sums_.count[length] += plan_.blocks[i + 1] - plan_.blocks[i];
    sums_.sum[length] += blocks[i].sum;
    sums_.squares[length] += blocks[i].squares;
  }
  epochs_.push_back({brightnessOf(plan_, blocks)});
  if (unit_ == 0 && !dark()) unit_ = epochs_.back().brightness.mean;
  return blocks;
}

Brightness Epochs::ofFilm() const {
  Brightness all;
  double steps = 0, variance = 0;
  for (const Epoch& epoch : epochs_) {
    const auto count = static_cast<double>(epoch.steps);
    steps += count;
    all.mean += count * epoch.brightness.mean;
    variance += count * count * epoch.brightness.standardError * epoch.brightness.standardError;
    all.largestShare = std::max(all.largestShare, epoch.brightness.largestShare);
  }
  if (steps > 0) {
    all.mean /= steps;
    all.standardError = std::sqrt(variance) / steps;
  }
  return all;
}

void Epochs::save(StateWriter& out) const {
  static_assert(sizeof(Epoch) == 4 * sizeof(double), "padding would be written");
  out.list(epochs_);
  out.value(sums_);
  out.value(unit_);
}

void Epochs::restore(StateReader& in) {
  epochs_ = in.list<Epoch>();
  sums_ = in.value<LargeStepSums>();
  unit_ = in.value<double>();
}

void poolBrightness(ChainStatistics& chains) {
  LargeStepSums both = chains.bootstraps;
  both += chains.largeSteps;
  // Large steps of any length say nothing about the lengths, but about b as a whole.
  const Brightness all = chains.largeStepsOfAnyLength
                             ? pooled(brightnessOf(chains.bootstraps), brightnessOf(chains.largeSteps))
                             : brightnessOf(both);
  chains.pooledBrightness = all.mean;
  chains.pooledError = all.standardError;
}

}  // namespace wavecrest
