// Bootstrap: independent samples from which chains start, and which say how bright the image is.
//
// Chains that start from samples chosen in proportion to their target, with the image scaled by the mean target of the
// same samples, are unbiased from the first step on (Veach 1997, 11.3.1): E[b g(x0)] is the integral of I g, and no
// step changes that. So nothing is discarded, and chains may be short.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/columns/chains.h"

namespace wavecrest {

// Samples to draw, in the order of path lengths. They lie in blocks of one length each, by which threads go through
// them; what samples of a block have in common is kept once, as samples may be hundreds of millions.
struct BootstrapPlan {
  std::vector<size_t> blocks{0};  // where each block begins, and the end
  std::vector<uint32_t> length;   // of the paths of a block; 0 where chains have none
  std::vector<double> share;  // of the whole that a sample of a block stands for: one over the samples of its length

  size_t samples() const { return blocks.back(); }
  uint32_t lengthOf(size_t sample) const;
  // count samples more, of one length.
  void add(uint32_t ofLength, uint32_t count);
};

// All samples alike.
BootstrapPlan plainBootstrap(uint32_t samples);

// About `samples` samples over the lengths minLength to maxLength, most of them short: long paths carry less, and an
// error in what they carry weighs less. Every length gets some, or its light would be lost.
BootstrapPlan bootstrapByLength(uint32_t samples, uint32_t minLength, uint32_t maxLength);

struct Brightness {
  double mean = 0;           // b: the integral of the target
  double standardError = 0;  // of the mean
  double largestShare = 0;   // of one sample in the mean; large where too few samples found light
};

// What the targets of each block are together.
struct BlockSums {
  double sum = 0, squares = 0;
  double deviations = 0;  // of the squares of their distances from the block's mean
  float largest = 0;
  size_t lastLit = 0;  // the last sample whose target is not zero, if any
};
std::vector<BlockSums> sumsOf(const BootstrapPlan& plan, const std::vector<float>& targets);
Brightness brightnessOf(const BootstrapPlan& plan, const std::vector<BlockSums>& blocks);

// The same of samples that are kept as sums: the means of all lengths, added up. Lengths without samples add nothing.
Brightness brightnessOf(const LargeStepSums& samples);
// Two independent estimates of the same b, weighted by what is known of their variances.
Brightness pooled(const Brightness& a, const Brightness& b);

// Systematic resampling: chain m starts from the sample at (m + offset) / chains of the sum of share times target, with
// offset in [0, 1). Samples in order, so chains are in the order of lengths. blocks: sumsOf the targets. Some target
// must not be zero.
std::vector<uint32_t> startSamples(const BootstrapPlan& plan, const std::vector<float>& targets,
                                   const std::vector<BlockSums>& blocks, uint32_t chains, double offset);

}  // namespace wavecrest
