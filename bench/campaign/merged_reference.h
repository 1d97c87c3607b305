// A reference out of the parts of one render, which many machines have rendered (bench/checkpoint/merge.h): its halves
// are every other part and those between.
#pragma once

#include "bench/campaign/reference_file.h"
#include "bench/checkpoint/merge.h"

namespace wavecrest {

// merged: with halves. Measures the noise floors.
Reference mergedReference(const MergedParts& merged);

}  // namespace wavecrest
