// Owen-scrambled Sobol points: the four numbers of one (path, block, stream) are a four-dimensional Sobol sequence over
// the iterations, shuffled and scrambled independently of every other. Of light paths the four numbers of one block are
// one over all paths of all iterations, one after the other.
//
// Burley, "Practical Hash-based Owen Scrambling", JCGT 2020: higher dimensions are padded with further such sets, whose
// order is decorrelated by scrambling the index too. The seeds of the scrambles are random bits of Philox, so no two
// sets have related ones. One set of four was measured against two pairs of (0,2)-sequences per block: equal on
// functions of one pair, but at 4096 points 50 times more accurate on a smooth function of all four numbers, and no
// dimension table has to say which numbers belong together.
#pragma once

#include <cassert>

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

// Four words of reversed digits: point `index` of the sequence, index below 2^kBits.
struct SobolPoint {
  UInt a, b, c, d;
};
template <uint32_t kBits>
WAVECREST_INLINE SobolPoint sobolPointReversed(UInt index) {
  UInt c(0u), d(0u);
#pragma GCC unroll 32
  for (uint32_t bit = 0; bit < kBits; ++bit) {
    const Mask set = hasBit(index, bit);
    c = select(set, c ^ UInt(kSobolDimension2[bit]), c);
    d = select(set, d ^ UInt(kSobolDimension3[bit]), d);
  }
  return {index, pascalTriangle(index), c, d};
}

// Seeds of a set's four scrambles; each a UInt or, where all lanes agree, a uint32_t.
template <class Word>
struct SobolSeeds {
  Word a, b, c, d;
};

// 32 random bits for each number of point `index` of a set, uppermost digit first. The order of the points is scrambled
// by a fifth seed: any three of the four scrambles are independent of it.
template <uint32_t kBits, class Word>
WAVECREST_INLINE SobolPoint scrambledPoint(UInt index, const SobolSeeds<Word>& seeds) {
  constexpr uint32_t kIndexMask = ~0u >> (32 - kBits);
  const UInt order = UInt(seeds.a) ^ UInt(seeds.b) ^ UInt(seeds.c) ^ UInt(seeds.d);
  const UInt shuffled = reverseBits(scrambleReversed(reverseBits(index), order)) & UInt(kIndexMask);
  const SobolPoint point = sobolPointReversed<kBits>(shuffled);
  return {reverseBits(scrambleReversed(point.a, UInt(seeds.a))), reverseBits(scrambleReversed(point.b, UInt(seeds.b))),
          reverseBits(scrambleReversed(point.c, UInt(seeds.c))), reverseBits(scrambleReversed(point.d, UInt(seeds.d)))};
}

// A path's own set, over the iterations.
WAVECREST_INLINE SobolPoint sobolBits(const SamplerSettings& sampler, UInt path, uint32_t block, Stream stream) {
  const auto iteration = static_cast<uint32_t>(sampler.iteration);
  const uint32_t epoch = iteration >> kPathSetBits;
  const UInt set = path & UInt(kMostPaths - 1);
  const PhiloxBlock counter{split(set), epoch, block, streamWord(static_cast<uint32_t>(stream), sampler.iteration)};
  const auto random = philox4x32<kPhiloxRounds>(counter, philoxKey(sampler.seed));
  const UInt index = UInt(iteration & ((1u << kPathSetBits) - 1)) + shiftRight<kPathBits>(path);
  return scrambledPoint<kPathSetBits>(index,
                                      SobolSeeds<UInt>{join(random.a), join(random.b), join(random.c), join(random.d)});
}

// The set of all light paths of as many whole iterations as its points are enough for.
WAVECREST_INLINE SobolPoint sharedSobolBits(const SamplerSettings& sampler, UInt path, uint32_t block) {
  assert(sampler.lightPaths != 0);
  const uint64_t together = kMostPaths / sampler.lightPaths, epoch = sampler.iteration / together;
  const auto first = static_cast<uint32_t>(sampler.iteration % together * sampler.lightPaths);
  // No path with a set of its own has this number.
  const PhiloxBlock counter{kMostPaths, static_cast<uint32_t>(epoch), block,
                            streamWord(static_cast<uint32_t>(Stream::light), epoch)};
  const auto random = philox4x32<kPhiloxRounds>(counter, philoxKey(sampler.seed));
  return scrambledPoint<kPathBits>(path + UInt(first), SobolSeeds<uint32_t>{random.a, random.b, random.c, random.d});
}

WAVECREST_SIMD_END
