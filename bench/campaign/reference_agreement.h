// Whether two references are of the same truth: a z-test of their difference in tiles, by the noise of their halves.
//
// The means of blocks of 8x8 pixels are independent but for splats and merges across their edges. In a tile of many
// blocks the sum of their differences has a variance that the halves tell: the sum of the squared half differences of
// both. Its ratio to the root of that is about Student's t of as many degrees of freedom as blocks where the truths
// agree. Chains (mlt) share their noise among blocks: the variance is then larger by what the tiles of their own half
// difference tell, and has a degree of freedom less than there are tiles. All blocks of a half of chains share the
// error of its brightness, so their halves are scaled to the brightness of the other reference first: it is not tested.
// Light of the direct pass does not have that error, so a part of it may remain.
#pragma once

#include <stdexcept>
#include <string>

#include "bench/campaign/reference_file.h"

namespace wavecrest {

struct Agreement {
  unsigned tiles = 0;
  bool testsBrightness = true;    // false where one of them is of mlt
  double largestZ = 0;            // by magnitude, over tiles and the whole image
  double limit = 0;               // beyond it, one in a hundred comparisons of equal truths would be
  double relativeDifference = 0;  // of the means of the whole images
  bool agrees() const { return largestZ <= limit; }
  std::string describe() const;  // one line
};

// Both need halves and equal sizes, of at least 64x48 pixels; else ReferenceComparisonError, whose text is complete.
struct ReferenceComparisonError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
Agreement compareReferences(const Reference& a, const Reference& b);

}  // namespace wavecrest
