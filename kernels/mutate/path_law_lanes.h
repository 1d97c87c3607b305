// Probabilities of the choices that a path-space mutation makes, in lanes: by those that propose and by those that
// weigh.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/mutate/path_law.h"

WAVECREST_SIMD_BEGIN

// Which mutations besides the large step suit a path, as numbers 0 or 1, and how many they are.
struct SuitableKinds {
  UInt fromEye, bidirectional, caustic, count;
};
WAVECREST_INLINE SuitableKinds suitableKinds(const PathLaw& law, UInt edges, UInt causticStart) {
  const UInt zero(0u), one(1u);
  const auto allowed = [&](uint32_t kind) WAVECREST_LAMBDA { return UInt((law.kinds & kind) != 0 ? 1u : 0u); };
  SuitableKinds kinds{allowed(PathLaw::kFromEye), select(one < edges, allowed(PathLaw::kBidirectional), zero),
                      select(causticStart == zero, zero, allowed(PathLaw::kCaustic)), zero};
  kinds.count = kinds.fromEye + kinds.bidirectional + kinds.caustic;
  return kinds;
}

// Numbers of vertices that may replace those between two kept ends: entries [first, end) of kAddedLaw, and their sum.
// They leave a path of an allowed length that is not the same path, with a light and a lens.
struct AddedRange {
  UInt first, end;
  Float sum;
};
WAVECREST_INLINE AddedRange addedRange(const PathLaw& law, UInt edges, UInt lightKept, UInt eyeFrom) {
  const UInt zero(0u), one(1u), middle(static_cast<uint32_t>(kMostAdded));
  const UInt deleted = eyeFrom - lightKept;
  UInt least = select(lightKept == zero, one, zero) + select(eyeFrom == edges + one, one, zero);
  least = max(least, select(deleted == zero, one, zero));
  // middle + added - deleted, never below zero.
  const auto entry = [&](UInt more, UInt less) WAVECREST_LAMBDA {
    const UInt sum = middle + more;
    return select(sum < less, zero, sum - less);
  };
  AddedRange range;
  range.first = max(entry(least, deleted), entry(UInt(law.minEdges), edges));
  range.end = min(entry(UInt(law.maxEdges + 1), edges), UInt(static_cast<uint32_t>(kAddedLaw.size())));
  range.sum = Float(0);
  for (uint32_t i = 0; i < kAddedLaw.size(); ++i) {
    const Mask allowed = (range.first < UInt(i + 1)) & (UInt(i) < range.end);
    range.sum = select(allowed, range.sum + Float(kAddedLaw[i]), range.sum);
  }
  return range;
}

// Ways to split `added` vertices of a path of `edges` between the two walks: the lens is no light vertex, and nothing
// joins a light with the lens.
WAVECREST_INLINE UInt splitsOf(UInt added, Mask newLens, UInt edges) {
  const UInt one(1u);
  return select(edges == one, one, select(newLens, added, added + one));
}

// Probability that the bidirectional mutation of a path of `edges` deletes what lies between two kept ends and adds so
// many vertices by one given split.
WAVECREST_INLINE Float bidirectionalShare(const PathLaw& law, UInt edges, UInt lightKept, UInt eyeFrom, UInt added) {
  const UInt one(1u), middle(static_cast<uint32_t>(kMostAdded));
  const UInt deleted = eyeFrom - lightKept;
  const UInt newEdges = edges + added - deleted;
  const AddedRange range = addedRange(law, edges, lightKept, eyeFrom);
  const UInt index = middle + added - deleted;  // wraps to a large number below zero
  const Mask allowed = andNot(index < range.end, index < range.first);
  const Float addedShare = gather(kAddedLaw.data(), select(allowed, index, middle));
  const Float deletion = gather(law.deletionShare, edges * UInt(law.deletionStride()) + deleted + one);
  const Float splits = toFloat(splitsOf(added, eyeFrom == edges + one, newEdges));
  return zeroUnless(allowed, deletion * addedShare / (range.sum * splits));
}

// Probability of the length of a path made anew.
WAVECREST_INLINE Float lengthShare(const PathLaw& law, UInt edges) {
  return gather(law.lengthsUpTo, edges) - gather(law.lengthsUpTo, edges - UInt(1u));
}

WAVECREST_SIMD_END
