// Proposals of Markov chains in lanes: fresh numbers for large steps, steps from the current ones for small steps.
//
// Kelemen et al., "A Simple and Robust Mutation Strategy for the Metropolis Light Transport Algorithm", 2002. Numbers
// are integers below 2^24 and steps wrap around, so a step and its opposite undo each other exactly and the law of
// steps is symmetric to the last bit.
#pragma once

#include <cassert>

#include "kernels/sampling/philox_lanes.h"
#include "kernels/sampling/sampler.h"
#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

// Four numbers in units of 2^-24.
struct ChainNumbers {
  UInt a, b, c, d;
};

// What a chain's random bits decide, besides the numbers of its walks.
enum class ChainUse : uint32_t { cameraWalk, lightWalk, step };

WAVECREST_INLINE ChainNumbers chainBits(const SamplerSettings& sampler, UInt source, uint32_t block, ChainUse use) {
  const uint32_t stream = 8 * static_cast<uint32_t>(sampler.chain->stream) + static_cast<uint32_t>(use);
  const PhiloxBlock counter{split(source), static_cast<uint32_t>(sampler.iteration), block,
                            streamWord(stream, sampler.iteration)};
  const auto bits = philox4x32<kPhiloxRounds>(counter, philoxKey(sampler.seed));
  return {join(bits.a), join(bits.b), join(bits.c), join(bits.d)};
}

// The number after a small step. 25 bits become the exponent's lowest two bits and the mantissa of a float, a size
// whose octave is uniform and which is uniform within the octave: Kelemen's s2 exp(-ln(s2/s1) u) with 2^x by its
// chords. Another bit is the sign.
WAVECREST_INLINE UInt smallStep(UInt current, UInt random, uint32_t stepBits) {
  const UInt size = toUInt(fromBits((random & UInt(0x1ffffffu)) + UInt(stepBits)));
  const UInt moved = select(hasBit(random, 31), current - size, current + size);
  return moved & UInt(0xffffffu);
}

// What the chains of these lanes propose for a block.
WAVECREST_INLINE ChainNumbers chainNumbers(const SamplerSettings& sampler, UInt lane, uint32_t block, Stream stream) {
  const ChainSamples& chain = *sampler.chain;
  const size_t walk = stream == Stream::light ? 1 : 0;
  assert(chain.keeps(walk, block));
  const ChainNumbers random =
      chainBits(sampler, gather(chain.source, lane), block, walk == 1 ? ChainUse::lightWalk : ChainUse::cameraWalk);
  ChainNumbers numbers{shiftRight<8>(random.a), shiftRight<8>(random.b), shiftRight<8>(random.c),
                       shiftRight<8>(random.d)};
  const Mask perturbed = UInt(block / 4) < gather(chain.live[walk], lane);
  if (none(perturbed)) return numbers;
  const uint32_t* const current = chain.values + size_t{4} * chain.column(walk, block) * chain.stride;
  const auto moved = [&](size_t row, UInt bits, UInt fresh) WAVECREST_LAMBDA {
    const UInt kept = gather(current + row * chain.stride, lane);
    return select(perturbed, smallStep(kept, bits, chain.stepBits), fresh);
  };
  numbers.a = moved(0, random.a, numbers.a);
  numbers.b = moved(1, random.b, numbers.b);
  numbers.c = moved(2, random.c, numbers.c);
  numbers.d = moved(3, random.d, numbers.d);
  return numbers;
}

WAVECREST_SIMD_END
