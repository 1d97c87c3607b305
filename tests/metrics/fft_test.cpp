// The batched transforms against kissfft, one lane at a time.
#include "metrics/planes/fft.h"

#include <gtest/gtest.h>
#include <kissfft/kiss_fft.h>

#include <cmath>
#include <random>

#include "metrics/planes/plane.h"

namespace wavecrest {
namespace {

std::vector<kiss_fft_cpx> laneOf(const float* batch, size_t length, size_t lane) {
  std::vector<kiss_fft_cpx> values;
  for (size_t k = 0; k < length; ++k)
    values.push_back({batch[k * kFftElement + lane], batch[k * kFftElement + kFftBatch + lane]});
  return values;
}

void fillRandom(AlignedArray<float>& batch, size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-1, 1);
  for (size_t i = 0; i < count; ++i) batch.data()[i] = number(random);
}

class Fft : public ::testing::TestWithParam<size_t> {};

TEST_P(Fft, AgreesWithKissfftInEveryLaneOnEveryIsa) {
  const size_t length = GetParam();
  for (const Isa isa : availableIsas()) {
    const FftPlan plan(length, isa);
    AlignedArray<float> batch(length * kFftElement), work(plan.workFloats());
    fillRandom(batch, length * kFftElement);
    for (const FftDirection direction : {FftDirection::forward, FftDirection::inverse}) {
      std::vector<std::vector<kiss_fft_cpx>> expected(kFftBatch);
      kiss_fft_cfg config =
          kiss_fft_alloc(static_cast<int>(length), direction == FftDirection::inverse, nullptr, nullptr);
      for (size_t lane = 0; lane < kFftBatch; ++lane) {
        const auto in = laneOf(batch.data(), length, lane);
        expected[lane].resize(length);
        kiss_fft(config, in.data(), expected[lane].data());
      }
      kiss_fft_free(config);
      plan.transform(batch.data(), work.data(), direction);
      // Rounding of both sides grows with the logarithm of the length, and the values with its square root.
      double scale = 0;
      for (const auto& z : expected[0]) scale = std::max(scale, std::hypot(double{z.r}, double{z.i}));
      const double tolerance = 4e-6 * scale;
      for (size_t lane = 0; lane < kFftBatch; ++lane) {
        const auto actual = laneOf(batch.data(), length, lane);
        for (size_t k = 0; k < length; ++k) {
          ASSERT_NEAR(actual[k].r, expected[lane][k].r, tolerance) << toString(isa) << " lane " << lane << " k " << k;
          ASSERT_NEAR(actual[k].i, expected[lane][k].i, tolerance) << toString(isa) << " lane " << lane << " k " << k;
        }
      }
    }
  }
}

// Every radix alone and mixed, lengths with large primes (Bluestein), and those of 1024x768 and 333x217 images.
INSTANTIATE_TEST_SUITE_P(Lengths, Fft,
                         ::testing::Values(1, 2, 3, 4, 5, 7, 8, 11, 12, 13, 30, 34, 49, 60, 64, 94, 434, 666, 1536,
                                           2048, 2 * 1021));

}  // namespace
}  // namespace wavecrest
