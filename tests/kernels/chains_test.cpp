// Markov chains through the kernels that propose and accept, on a target that is known: a brightness for each pixel of
// a small film, instead of light.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "kernels/columns/chains.h"
#include "kernels/stages.h"
#include "tests/effort.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 24, kHeight = 16, kPixels = kWidth * kHeight;
constexpr uint32_t kRange = 1u << 24;

// A wave of chains with nothing but an origin, whose first two numbers choose a pixel.
class ToyChains {
 public:
  using Target = std::function<float(uint32_t pixel)>;

  ToyChains(Isa isa, size_t count, Target target)
      : stages_(findStages<float>(isa, Precision::floating,
                                  chooseSpecialization(featuresOf(Specialization::diffuse), Precision::floating))),
        // Every column: where only the complete kernels are compiled they stand in for these.
        wave_(count, {.shadingNormals = true, .textures = true, .rouletteScale = true, .connections = true}),
        state(count, kept()),
        sums(kPixels, 0),
        target_(std::move(target)) {
    camera();
    wave_.pathCount = count;
    for (size_t i = 0; i < count; ++i) state.columns.source[i] = static_cast<uint32_t>(i);
  }

  // One step: propose, evaluate, accept. Chains that are nowhere yet take what they get.
  void step(uint32_t number) {
    StageContext<float> context;
    context.scene = &scene_;
    context.sampler = {SamplerKind::chain, 17, number, &state.samples};
    context.film = {0, 0, kWidth, kHeight};
    context.chains.state = &state;
    context.lanes.pixel = state.columns.proposedPixel;
    context.counters = &counters;
    stages_.proposeMutations(context, wave_);
    stages_.generateCameraPaths(context, wave_);
    for (size_t i = 0; i < wave_.pathCount; ++i) {
      const float value = target_(state.columns.proposedPixel[i]);
      wave_.radiance.red[i] = wave_.radiance.green[i] = wave_.radiance.blue[i] = value;
    }
    stages_.acceptMutations(context, wave_);
    for (size_t i = 0; i < wave_.splats.size; ++i) {
      sums[wave_.splats.pixel[i]] += static_cast<double>(wave_.splats.red[i]);
    }
  }

  const std::vector<uint32_t> numbers(size_t row) const {
    const uint32_t* first = state.samples.values + row * state.samples.stride;
    return {first, first + wave_.pathCount};
  }
  void setNumbers(uint32_t value) {
    std::fill_n(state.samples.values, 4 * state.samples.stride, value);
    for (size_t i = 0; i < wave_.pathCount; ++i) state.columns.cameraVertices[i] = 1;
  }
  double splatted(uint32_t pixel) const { return sums[pixel]; }

 private:
  const Stages<float>& stages_;
  Wave<float> wave_;
  SceneView<float> scene_;

 public:
  ChainState state;
  StageCounters counters;
  std::vector<double> sums;  // of what was splatted, by pixel

 private:
  static ChainState::Kept kept() {
    ChainState::Kept kept;
    kept.blocks[0] = {1, 0};  // Block::scatter of the origin
    kept.vertices[0] = 1;
    return kept;
  }
  void camera() {
    scene_.camera.width = kWidth;
    scene_.camera.height = kHeight;
    scene_.camera.corner[2] = scene_.camera.du[0] = scene_.camera.dv[1] = 1;
  }
  Target target_;
};

// A ramp with a hole, a pixel that outshines all others, and no light in one part.
float toyTarget(uint32_t pixel) {
  const uint32_t x = pixel % kWidth, y = pixel / kWidth;
  if (x >= 8 && x < 12 && y >= 4 && y < 9) return 0;
  if (x == 20 && y == 3) return 40;
  return 0.25f + 0.125f * static_cast<float>(x + y);
}

double toySum() {
  double sum = 0;
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) sum += static_cast<double>(toyTarget(pixel));
  return sum;
}

using Stationary = IsaTest;
WAVECREST_TEST_EVERY_ISA(Stationary);

// Chains are independent of each other, so where they are in the end is a sample of the target. They start at any lit
// pixel, far from it.
TEST_P(Stationary, chainsEndWhereTheTargetSays) {
  constexpr size_t kChains = effort(20'011, 4'003);
  ToyChains chains(GetParam(), kChains, toyTarget);
  const uint32_t steps = GetParam() == Isa::scalar ? 60 : 120;
  for (uint32_t step = 0; step < steps; ++step) chains.step(step);
  std::vector<size_t> counts(kPixels, 0);
  std::vector<double> expected(kPixels);
  for (size_t i = 0; i < kChains; ++i) {
    ASSERT_GT(chains.state.columns.target[i], 0.0f) << "a chain in the dark";
    ++counts[chains.state.columns.pixel[i]];
  }
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    expected[pixel] = kChains * static_cast<double>(toyTarget(pixel)) / toySum();
  }
  EXPECT_LE(chiSquareDeviations(counts, expected), kMaxDeviations);
}

// What is splatted, with what is still due to the current states, is a visit for each step, in proportion to the
// target.
TEST_P(Stationary, splatsAreTheTarget) {
  constexpr size_t kChains = 4'001;
  constexpr uint32_t kBurnIn = 60, kSteps = 60;
  ToyChains chains(GetParam(), kChains, toyTarget);
  for (uint32_t step = 0; step < kBurnIn; ++step) chains.step(step);
  std::fill(chains.sums.begin(), chains.sums.end(), 0);
  std::fill_n(static_cast<float*>(chains.state.columns.weight), kChains, 0.0f);
  for (uint32_t step = 0; step < kSteps; ++step) chains.step(kBurnIn + step);
  std::vector<double> visits(kPixels);
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) visits[pixel] = chains.splatted(pixel);
  for (size_t i = 0; i < kChains; ++i) {
    visits[chains.state.columns.pixel[i]] += static_cast<double>(chains.state.columns.weight[i]);
  }
  double all = 0, quarter = 0, wanted = 0;
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    all += visits[pixel];
    if (toyTarget(pixel) == 0) {
      EXPECT_EQ(visits[pixel], 0);
    }
    if (pixel % kWidth >= 12) continue;
    quarter += visits[pixel];
    wanted += static_cast<double>(toyTarget(pixel)) / toySum();
  }
  EXPECT_NEAR(all, double{kChains} * kSteps, 1e-4 * kChains * kSteps);
  // Half of the film: a chain's visits to it are correlated over some ten steps at most.
  const double error = std::sqrt(wanted * (1 - wanted) * 20 / (double{kChains} * kSteps));
  EXPECT_NEAR(quarter / all, wanted, 5 * error);
}

using SmallSteps = IsaTest;
WAVECREST_TEST_EVERY_ISA(SmallSteps);

// On a constant target every proposal is taken, so the numbers after a step are the proposal.
std::vector<int32_t> stepsFrom(Isa isa, uint32_t start, size_t count) {
  ToyChains chains(isa, count, [](uint32_t) { return 1.0f; });
  chains.state.samples.largeStep = 0;
  chains.step(0);
  chains.setNumbers(start);
  chains.step(1);
  std::vector<int32_t> steps;
  for (size_t row = 0; row < 4; ++row) {
    for (const uint32_t number : chains.numbers(row)) {
      EXPECT_LT(number, kRange);
      // Around the circle, whichever way is shorter.
      const auto step = static_cast<int32_t>((number - start) & (kRange - 1));
      steps.push_back(step < static_cast<int32_t>(kRange / 2) ? step : step - static_cast<int32_t>(kRange));
    }
  }
  return steps;
}

TEST_P(SmallSteps, haveASymmetricLaw) {
  const std::vector<int32_t> steps = stepsFrom(GetParam(), kRange / 3, 20'000);
  // 16 bins per octave from 2^14 to 2^18, of either sign.
  constexpr size_t kBins = 64;
  std::vector<size_t> counts(2 * kBins, 0);  // up, then down
  for (const int32_t step : steps) {
    const uint32_t size = static_cast<uint32_t>(std::abs(step));
    ASSERT_GE(size, 1u << 14);
    ASSERT_LT(size, 1u << 18);
    const auto octave = static_cast<size_t>(std::log2(size)) - 14;
    const size_t bin = 16 * octave + ((size >> (10 + octave)) & 15u);
    ++counts[step > 0 ? bin : kBins + bin];
  }
  // Octaves alike, uniform within, up as down.
  const std::vector<double> expected(2 * kBins, static_cast<double>(steps.size()) / (2 * kBins));
  EXPECT_LE(chiSquareDeviations(counts, expected), kMaxDeviations);
}

TEST_P(SmallSteps, wrapAroundTheEnds) {
  for (const uint32_t start : {0u, kRange - 1}) {
    const std::vector<int32_t> steps = stepsFrom(GetParam(), start, 2'000);
    size_t up = 0;
    for (const int32_t step : steps) up += step > 0 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(up) / static_cast<double>(steps.size()), 0.5, 5 * 0.5 / std::sqrt(8'000.0));
  }
}

TEST_P(SmallSteps, areTakenAsOftenAsAsked) {
  constexpr size_t kChains = 1'999;
  ToyChains chains(GetParam(), kChains, [](uint32_t) { return 1.0f; });
  chains.state.samples.largeStep = 0.3f;
  for (uint32_t step = 0; step < 50; ++step) chains.step(step);
  const ChainCounters& counters = chains.state.counters;
  EXPECT_EQ(counters.proposedOf(Mutation::large) + counters.proposedOf(Mutation::small), 50 * kChains);
  const double steps = 49 * kChains;  // the first is from nowhere, which counts as large
  const double large = static_cast<double>(counters.proposedOf(Mutation::large)) - kChains;
  EXPECT_NEAR(large / steps, 0.3, 5 * std::sqrt(0.21 / steps));
  EXPECT_EQ(counters.proposedOf(Mutation::large), counters.acceptedOf(Mutation::large));
  EXPECT_EQ(counters.proposedOf(Mutation::small), counters.acceptedOf(Mutation::small));
  EXPECT_EQ(counters.longestRejection, 0u);
}

using ChainTwin = IsaTest;
WAVECREST_TEST_EVERY_ISA(ChainTwin);

// Targets and their ratios are binary fractions here or rounded once, so all but sums of weights are equal to the bit.
TEST_P(ChainTwin, takesTheSameStepsForAnyCount) {
  for (const size_t count : {1u, 3u, 15u, 16u, 17u, 31u, 37u}) {
    ToyChains expected(Isa::scalar, count, toyTarget), actual(GetParam(), count, toyTarget);
    for (uint32_t step = 0; step < 40; ++step) {
      expected.step(step);
      actual.step(step);
    }
    const Chains &a = expected.state.columns, &b = actual.state.columns;
    for (size_t i = 0; i < count; ++i) {
      ASSERT_EQ(a.pixel[i], b.pixel[i]) << count << " chains, chain " << i;
      ASSERT_EQ(a.cameraVertices[i], b.cameraVertices[i]);
      ASSERT_EQ(a.rejections[i], b.rejections[i]);
      ASSERT_NEAR(a.target[i], b.target[i], 1e-6f * a.target[i]);
      ASSERT_NEAR(a.weight[i], b.weight[i], 1e-4f);
    }
    for (size_t row = 0; row < 4; ++row) EXPECT_EQ(expected.numbers(row), actual.numbers(row)) << count << " chains";
    EXPECT_EQ(expected.state.counters.acceptedOf(Mutation::large), actual.state.counters.acceptedOf(Mutation::large));
    EXPECT_EQ(expected.state.counters.acceptedOf(Mutation::small), actual.state.counters.acceptedOf(Mutation::small));
    EXPECT_EQ(expected.state.counters.dark, actual.state.counters.dark);
    EXPECT_EQ(expected.state.counters.longestRejection, actual.state.counters.longestRejection);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      EXPECT_NEAR(expected.splatted(pixel), actual.splatted(pixel), 1e-4);
    }
  }
}

// A contribution that is no number, or of negative luminance, is refused and counted, and the chain stays where it is.
TEST_P(ChainTwin, refusesWhatIsNoNumberOrNegative) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
    bool broken = false;
    ToyChains chains(GetParam(), 21, [&](uint32_t) { return broken ? bad : 1.0f; });
    chains.step(0);
    broken = true;
    chains.step(1);
    EXPECT_EQ(chains.state.counters.nonFinite, bad < 0 ? 0u : 21u);
    EXPECT_EQ(chains.state.counters.dark, bad < 0 ? 21u : 0u);
    EXPECT_EQ(chains.state.counters.longestRejection, 1u);
    for (size_t i = 0; i < 21; ++i) EXPECT_NEAR(chains.state.columns.target[i], 1, 1e-6);
  }
}

}  // namespace
}  // namespace wavecrest
