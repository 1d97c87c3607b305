// Owen-scrambled Sobol points: the four numbers of one (path, block, stream) are a four-dimensional Sobol sequence over
// the iterations, shuffled and scrambled independently of every other.
//
// Burley, "Practical Hash-based Owen Scrambling", JCGT 2020: higher dimensions are padded with further such sets, whose
// order is decorrelated by scrambling the index too. The seeds of the scrambles are random bits of Philox, so no two
// sets have related ones. One set of four was measured against two pairs of (0,2)-sequences per block: equal on
// functions of one pair, but at 4096 points 50 times more accurate on a smooth function of all four numbers, and no
// dimension table has to say which numbers belong together.
#pragma once

#include "kernels/sampling/philox_lanes.h"
#include "kernels/sampling/sampler.h"
#include "kernels/sampling/sobol_directions.h"
#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

// Flips each bit by a hash of the seed and the bits below it: nested uniform scrambling of a number whose digits are
// reversed. The hash of Laine and Karras 2011 with the constants of Vegdahl, "Building a Better LK Hash", 2021.
WAVECREST_INLINE UInt scrambleReversed(UInt x, UInt seed) {
  x = x ^ (x * UInt(0x3d20adeau));
  x = x + seed;
  x = x * (shiftRight<16>(seed) | UInt(1u));
  x = x ^ (x * UInt(0x05526c56u));
  return x ^ (x * UInt(0x53a22864u));
}

// Pascal's triangle modulo 2 times the bits of x: each digit is the parity of the bits above it that contain its index,
// so sums over one index bit at a time suffice (Ahmed, "An Implementation Algorithm of 2D Sobol Sequence", 2024).
WAVECREST_INLINE UInt pascalTriangle(UInt x) {
  x = x ^ (shiftRight<1>(x) & UInt(0x55555555u));
  x = x ^ (shiftRight<2>(x) & UInt(0x33333333u));
  x = x ^ (shiftRight<4>(x) & UInt(0x0f0f0f0fu));
  x = x ^ (shiftRight<8>(x) & UInt(0x00ff00ffu));
  return x ^ shiftRight<16>(x);
}

// Four words of reversed digits: point `index` of the sequence, index below 2^kSobolIndexBits.
struct SobolPoint {
  UInt a, b, c, d;
};
WAVECREST_INLINE SobolPoint sobolPointReversed(UInt index) {
  UInt c(0u), d(0u);
#pragma GCC unroll 32
  for (uint32_t bit = 0; bit < kSobolIndexBits; ++bit) {
    const Mask set = hasBit(index, bit);
    c = select(set, c ^ UInt(kSobolDimension2[bit]), c);
    d = select(set, d ^ UInt(kSobolDimension3[bit]), d);
  }
  return {index, pascalTriangle(index), c, d};
}

// 32 random bits for each number, uppermost digit first.
WAVECREST_INLINE SobolPoint sobolBits(const SamplerSettings& sampler, UInt path, uint32_t block, Stream stream) {
  constexpr uint32_t kIndexMask = (1u << kSobolIndexBits) - 1;
  const auto iteration = static_cast<uint32_t>(sampler.iteration);
  const uint32_t epoch = iteration >> kSobolIndexBits;
  const UInt set = path & UInt(kMostPaths - 1);
  const PhiloxBlock counter{split(set), epoch, block, streamWord(static_cast<uint32_t>(stream), sampler.iteration)};
  const auto random = philox4x32<kPhiloxRounds>(counter, philoxKey(sampler.seed));
  const UInt seedA = join(random.a), seedB = join(random.b), seedC = join(random.c), seedD = join(random.d);

  // The order of the points: any three of the four scrambles are independent of it.
  const UInt index = UInt(iteration & kIndexMask) + shiftRight<kPathBits>(path);
  const UInt shuffled = scrambleReversed(reverseBits(index), xor3(seedA, seedB, seedC) ^ seedD);
  const SobolPoint point = sobolPointReversed(reverseBits(shuffled) & UInt(kIndexMask));
  return {reverseBits(scrambleReversed(point.a, seedA)), reverseBits(scrambleReversed(point.b, seedB)),
          reverseBits(scrambleReversed(point.c, seedC)), reverseBits(scrambleReversed(point.d, seedD))};
}

WAVECREST_SIMD_END
