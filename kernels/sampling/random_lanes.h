// uniform4: the random numbers of every kernel, four per call and lane.
//
// in: the sampler's settings, one path word (kernels/sampling/sampler.h) per lane, a block and a stream; out: four
// numbers in [0,1) on the grid of 2^-24, which a float holds exactly. A block is one row of the dimension table: 4
// times the vertex index plus the Block of kernels/sampling/sampler.h. Call it where the numbers are used; storing them
// costs more than drawing them (1.3 ns per path with AVX-512, lanes_bench).
#pragma once

#include "kernels/sampling/philox_lanes.h"
#include "kernels/sampling/sampler.h"
#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

struct Uniform4 {
  Float a, b, c, d;
};

// The upper 24 bits as a number in [0,1).
WAVECREST_INLINE Float toUnitInterval(UInt bits) { return toFloat(shiftRight<8>(bits)) * Float(0x1p-24f); }

// The number in [0, 1) of 48 bits, the upper 24 bits of `upper` and those of `lower`, rounded down to a float. For
// every float a in [0, 1] the probability of a threshold below a is a, rounded up to 2^-48: 1 for a = 1.
WAVECREST_INLINE Float thresholdOf(UInt upper, UInt lower) {
  // sum - high is exact (Fast2Sum, Dekker 1971), and above `low` only where the sum was rounded up.
  const Float high = toUnitInterval(upper), low = toUnitInterval(lower) * Float(0x1p-24f), sum = high + low;
  return select(low < sum - high, fromBits(bits(sum) - UInt(1u)), sum);
}

WAVECREST_INLINE Uniform4 independentUniform4(const SamplerSettings& sampler, UInt path, uint32_t block,
                                              Stream stream) {
  // Lanes that are iterations ahead carry into no bit of another meaning: see SamplerSettings::iteration.
  const auto iteration = static_cast<uint32_t>(sampler.iteration);
  const UInt word = path + UInt(iteration << kPathBits);
  const PhiloxBlock counter{split(word), iteration / kIterationsPerWave, block,
                            streamWord(static_cast<uint32_t>(stream), sampler.iteration)};
  const auto bits = philox4x32<kPhiloxRounds>(counter, philoxKey(sampler.seed));
  return {toUnitInterval(join(bits.a)), toUnitInterval(join(bits.b)), toUnitInterval(join(bits.c)),
          toUnitInterval(join(bits.d))};
}

// Numbers of the other kinds (dependent_numbers.cpp). Not inlined: they would fill the loop of every caller with ten
// times the code of independent ones.
Uniform4 dependentUniform4(const SamplerSettings& sampler, UInt path, uint32_t block, Stream stream);

// The sampler's kind is the same for all lanes and calls: the branch is predicted.
WAVECREST_INLINE Uniform4 uniform4(const SamplerSettings& sampler, UInt path, uint32_t block, Stream stream) {
  if (sampler.kind == SamplerKind::independent) [[likely]]
    return independentUniform4(sampler, path, block, stream);
  return dependentUniform4(sampler, path, block, stream);
}

WAVECREST_SIMD_END
