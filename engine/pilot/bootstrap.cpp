#include "engine/pilot/bootstrap.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/plan/path_laws.h"
#include "engine/tasks/for_each.h"

namespace wavecrest {
namespace {

// The least number of samples of any length.
constexpr uint32_t kFewestSamples = 32;
// Samples whose targets one task adds up.
constexpr size_t kBlockSamples = 2048;
// Chains whose starts one task finds.
constexpr uint32_t kBlockChains = 1024;

}  // namespace

uint32_t BootstrapPlan::lengthOf(size_t sample) const {
  const auto after = std::upper_bound(blocks.begin(), blocks.end(), sample);
  return length[static_cast<size_t>(after - blocks.begin()) - 1];
}

void BootstrapPlan::add(uint32_t ofLength, uint32_t count) {
  const size_t end = samples() + count;
  while (samples() != end) {
    blocks.push_back(std::min(samples() + kBlockSamples, end));
    length.push_back(ofLength);
    share.push_back(1.0 / count);
  }
}

BootstrapPlan plainBootstrap(uint32_t samples) {
  BootstrapPlan plan;
  plan.add(0, samples);
  return plan;
}

BootstrapPlan bootstrapByLength(uint32_t samples, uint32_t minLength, uint32_t maxLength) {
  BootstrapPlan plan;
  if (minLength > maxLength) return plan;
  // Numbers of samples fall by kLengthRatio from length to length, and add up to about `samples`.
  const double norm = (1 - kLengthRatio) / (1 - std::pow(kLengthRatio, maxLength - minLength + 1));
  for (uint32_t length = minLength; length <= maxLength; ++length) {
    const double wanted = samples * norm * std::pow(kLengthRatio, length - minLength);
    plan.add(length, std::max(kFewestSamples, static_cast<uint32_t>(std::lround(wanted))));
  }
  return plan;
}

std::vector<BlockSums> sumsOf(const BootstrapPlan& plan, const std::vector<float>& targets) {
  assert(plan.samples() == targets.size());
  std::vector<BlockSums> blocks(plan.length.size());
  forEach(blocks.size(), [&](size_t block) {
    BlockSums sums;
    const size_t begin = plan.blocks[block], end = plan.blocks[block + 1];
    for (size_t i = begin; i < end; ++i) {
      const double target = static_cast<double>(targets[i]);
      sums.sum += target;
      sums.squares += target * target;
      sums.largest = std::max(sums.largest, targets[i]);
      if (targets[i] > 0) sums.lastLit = i;
    }
    // Deviations take a second pass: a difference of the sums would lose its digits where targets are nearly equal.
    const double mean = sums.sum / static_cast<double>(end - begin);
    for (size_t i = begin; i < end; ++i) {
      const double difference = static_cast<double>(targets[i]) - mean;
      sums.deviations += difference * difference;
    }
    blocks[block] = sums;
  });
  return blocks;
}

Brightness brightnessOf(const BootstrapPlan& plan, const std::vector<BlockSums>& blocks) {
  Brightness out;
  // b is the sum of the means of all lengths. The means are independent, so their variances add up.
  double largest = 0, variance = 0;
  for (size_t block = 0; block < blocks.size();) {
    // The blocks of one length together (Chan, Golub, LeVeque 1979).
    const uint32_t length = plan.length[block];
    double count = 0, sum = 0, deviations = 0, most = 0;
    for (; block < blocks.size() && plan.length[block] == length; ++block) {
      const auto added = static_cast<double>(plan.blocks[block + 1] - plan.blocks[block]);
      const double difference = count == 0 ? 0 : blocks[block].sum / added - sum / count;
      deviations += blocks[block].deviations + difference * difference * count * added / (count + added);
      count += added;
      sum += blocks[block].sum;
      most = std::max(most, static_cast<double>(blocks[block].largest));
    }
    out.mean += sum / count;
    largest = std::max(largest, most / count);
    if (count > 1) variance += deviations / (count - 1) / count;
  }
  out.standardError = std::sqrt(variance);
  out.largestShare = out.mean > 0 ? largest / out.mean : 0;
  return out;
}

Brightness brightnessOf(const LargeStepSums& samples) {
  Brightness out;
  double variance = 0;
  for (size_t length = 0; length < LargeStepSums::kLengths; ++length) {
    if (samples.count[length] == 0) continue;
    const auto count = static_cast<double>(samples.count[length]);
    const double mean = samples.sum[length] / count;
    out.mean += mean;
    // Rounding may leave this difference below zero.
    if (count > 1) variance += std::max(samples.squares[length] / count - mean * mean, 0.0) / (count - 1);
  }
  out.standardError = std::sqrt(variance);
  return out;
}

Brightness pooled(const Brightness& a, const Brightness& b) {
  const double va = a.standardError * a.standardError, vb = b.standardError * b.standardError;
  // An estimate whose standard error is zero or no number is left out.
  if (!(va > 0)) return b;
  if (!(vb > 0)) return a;
  // Weights are the reciprocals of the variances.
  Brightness out;
  out.mean = (a.mean * vb + b.mean * va) / (va + vb);
  out.standardError = std::sqrt(va * vb / (va + vb));
  return out;
}

std::vector<uint32_t> startSamples(const BootstrapPlan& plan, const std::vector<float>& targets,
                                   const std::vector<BlockSums>& blocks, uint32_t chains, double offset) {
  // The weights of all blocks before each, and of all. Rounding must not lead past the last sample with light.
  std::vector<double> before(blocks.size() + 1);
  size_t lastLit = 0;
  for (size_t block = 0; block < blocks.size(); ++block) {
    before[block + 1] = before[block] + plan.share[block] * blocks[block].sum;
    if (blocks[block].sum > 0) lastLit = block;
  }
  assert(before.back() > 0);
  // Each task finds the starts of kBlockChains chains.
  std::vector<uint32_t> out(chains);
  forEach((chains + kBlockChains - 1) / kBlockChains, [&](size_t task) {
    const auto first = static_cast<uint32_t>(task) * kBlockChains, end = std::min(first + kBlockChains, chains);
    size_t block = 0, sample = 0;
    double reached = 0;
    for (uint32_t chain = first; chain < end; ++chain) {
      const double goal = (chain + offset) / chains * before.back();
      // Find the block that holds the goal. A chain in the same block as the chain before goes on from that chain's
      // sample.
      const auto after = std::upper_bound(before.begin(), before.end() - 1, goal);
      const size_t holding = std::min(static_cast<size_t>(after - before.begin() - 1), lastLit);
      if (chain == first || holding != block) {
        block = holding;
        sample = plan.blocks[block];
        reached = before[block];
      }
      const double share = plan.share[block];
      // Add up weights in the block until the sum passes the goal.
      const auto weight = [&] { return share * static_cast<double>(targets[sample]); };
      while (sample < blocks[block].lastLit && reached + weight() <= goal) {
        reached += weight();
        ++sample;
      }
      out[chain] = static_cast<uint32_t>(sample);
    }
  });
  return out;
}

}  // namespace wavecrest
