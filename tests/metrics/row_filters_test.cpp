// Every instruction set's row filters against the definition, on widths around the lane counts.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "metrics/kernels/metric_kernels.h"
#include "metrics/planes/plane.h"

namespace wavecrest {
namespace {

std::vector<float> randomFloats(size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1, 1);
  std::vector<float> values(count);
  for (float& v : values) v = number(random);
  return values;
}

TEST(RowFilters, WeightedSumIsTheDefinitionOnEveryIsa) {
  constexpr size_t kRoom = 256, kTaps = 5;
  const auto data = randomFloats(kTaps * kRoom), taps = randomFloats(kTaps * kMaxFilterOutputs);
  for (const Isa isa : availableIsas()) {
    for (size_t outputs = 1; outputs <= kMaxFilterOutputs; ++outputs) {
      for (size_t width : {1u, 3u, 15u, 16u, 17u, 33u, 63u, 64u, 65u, 130u}) {
        AlignedArray<float> results(outputs * kRoom);
        std::vector<const float*> sources, weights;
        std::vector<float*> out;
        for (size_t i = 0; i < kTaps; ++i) sources.push_back(data.data() + i * kRoom + i);  // unaligned
        for (size_t o = 0; o < outputs; ++o) {
          weights.push_back(taps.data() + o * kTaps);
          out.push_back(results.data() + o * kRoom);
          out[o][roundUpToLanes(width)] = 42;
        }
        metricKernels(isa).weightedSum({sources.data(), kTaps, weights.data(), outputs, out.data(), width});
        for (size_t o = 0; o < outputs; ++o) {
          for (size_t x = 0; x < width; ++x) {
            double sum = 0;
            for (size_t i = 0; i < kTaps; ++i) sum += double{weights[o][i]} * double{sources[i][x]};
            ASSERT_NEAR(out[o][x], sum, 1e-6) << toString(isa) << " width " << width << " x " << x;
          }
          ASSERT_EQ(out[o][roundUpToLanes(width)], 42) << toString(isa) << ": wrote beyond the padding";
        }
      }
    }
  }
}

TEST(RowFilters, GatheredSumIsTheDefinitionOnEveryIsa) {
  constexpr size_t kTaps = 3;
  const auto data = randomFloats(100);
  for (const Isa isa : availableIsas()) {
    for (size_t stride : {16u, 48u}) {
      const auto weights = randomFloats(kTaps * stride);
      std::vector<uint32_t> indices;
      for (size_t i = 0; i < kTaps * stride; ++i) indices.push_back(static_cast<uint32_t>(i * 37 % 100));
      AlignedArray<float> out(stride);
      metricKernels(isa).gatheredSum({data.data(), indices.data(), weights.data(), kTaps, stride, out.data()});
      for (size_t x = 0; x < stride; ++x) {
        double sum = 0;
        for (size_t t = 0; t < kTaps; ++t)
          sum += double{weights[t * stride + x]} * double{data[indices[t * stride + x]]};
        ASSERT_NEAR(out.data()[x], sum, 1e-6) << toString(isa);
      }
    }
  }
}

}  // namespace
}  // namespace wavecrest
