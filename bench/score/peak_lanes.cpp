// What a core can do at best, for the roofline of `bench --score`: a triad over three columns, and a chain of fused
// multiply-adds that never leaves the registers.
#include "bench/score/peak_loops.h"
#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

void triad(const float* a, const float* b, float factor, float* out, size_t count) {
  const Float f(factor);
  for (size_t i = 0; i < count; i += kLanes) store(mulAdd(f, load(b + i), load(a + i)), out + i);
}

// Enough chains that none waits for itself: two units of five cycles at most, and registers for all of them.
constexpr size_t kChains = 12;

float multiplyAdd(float factor, size_t rounds) {
  Float sums[kChains];
  for (size_t k = 0; k < kChains; ++k) sums[k] = Float(static_cast<float>(k));
  const Float f(factor), term(1.0f);
  for (size_t round = 0; round < rounds; ++round) {
    for (Float& sum : sums) sum = mulAdd(sum, f, term);
  }
  Float sum = sums[0];
  for (size_t k = 1; k < kChains; ++k) sum = sum + sums[k];
  return greatestLane(sum);
}

}  // namespace

const PeakLoops& peakLoops() {
  static constexpr PeakLoops kLoops{
      .lanes = kLanes, .operationsPerRound = 2 * kChains * kLanes, .triad = triad, .multiplyAdd = multiplyAdd};
  return kLoops;
}

WAVECREST_SIMD_END
