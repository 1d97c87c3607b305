#include "engine/chains/bootstrap.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wavecrest {
namespace {

constexpr uint32_t kFewestSamples = 32;

}  // namespace

BootstrapPlan plainBootstrap(uint32_t samples) {
  return {std::vector<uint32_t>(samples, 0), std::vector<double>(samples, 1.0 / samples)};
}

BootstrapPlan bootstrapByLength(uint32_t samples, uint32_t minLength, uint32_t maxLength) {
  BootstrapPlan plan;
  if (minLength > maxLength) return plan;
  const double norm = (1 - kLengthRatio) / (1 - std::pow(kLengthRatio, maxLength - minLength + 1));
  for (uint32_t length = minLength; length <= maxLength; ++length) {
    const double wanted = samples * norm * std::pow(kLengthRatio, length - minLength);
    const uint32_t count = std::max(kFewestSamples, static_cast<uint32_t>(std::lround(wanted)));
    plan.length.insert(plan.length.end(), count, length);
    plan.share.insert(plan.share.end(), count, 1.0 / count);
  }
  return plan;
}

Brightness brightnessOf(const BootstrapPlan& plan, const std::vector<float>& targets) {
  assert(plan.length.size() == targets.size());
  Brightness out;
  double largest = 0, variance = 0;
  for (size_t begin = 0; begin < targets.size();) {
    size_t end = begin;
    double sum = 0, squares = 0;
    for (; end < targets.size() && plan.length[end] == plan.length[begin]; ++end)
      sum += static_cast<double>(targets[end]);
    const auto count = static_cast<double>(end - begin);
    for (size_t i = begin; i < end; ++i) {
      const double difference = static_cast<double>(targets[i]) - sum / count;
      squares += difference * difference;
      largest = std::max(largest, static_cast<double>(targets[i]) / count);
    }
    out.mean += sum / count;
    if (count > 1) variance += squares / (count - 1) / count;
    begin = end;
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
    if (count > 1) variance += std::max(samples.squares[length] / count - mean * mean, 0.0) / (count - 1);
  }
  out.standardError = std::sqrt(variance);
  return out;
}

Brightness pooled(const Brightness& a, const Brightness& b) {
  const double va = a.standardError * a.standardError, vb = b.standardError * b.standardError;
  if (!(va > 0)) return b;
  if (!(vb > 0)) return a;
  Brightness out;
  out.mean = (a.mean * vb + b.mean * va) / (va + vb);
  out.standardError = std::sqrt(va * vb / (va + vb));
  return out;
}

std::vector<uint32_t> startSamples(const BootstrapPlan& plan, const std::vector<float>& targets, uint32_t chains,
                                   double offset) {
  const auto weight = [&](size_t i) { return plan.share[i] * static_cast<double>(targets[i]); };
  double sum = 0;
  uint32_t last = 0;  // the last sample with light: rounding must not lead past it
  for (size_t i = 0; i < targets.size(); ++i) {
    sum += weight(i);
    if (targets[i] > 0) last = static_cast<uint32_t>(i);
  }
  assert(sum > 0);
  std::vector<uint32_t> out;
  out.reserve(chains);
  double reached = 0;
  uint32_t sample = 0;
  for (uint32_t chain = 0; chain < chains; ++chain) {
    const double goal = (chain + offset) / chains * sum;
    while (sample < last && reached + weight(sample) <= goal) reached += weight(sample++);
    out.push_back(sample);
  }
  return out;
}

}  // namespace wavecrest
