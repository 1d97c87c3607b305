// The sum of checkpoints that hold shares of one image: films are added by their counts, one part after the other, so
// memory does not depend on the number of parts.
//
// Parts are added in the order of what they hold, whatever the order of files. Splats are integers, and their sum is
// that of one unbroken render. Samples of pixels are added in double, a part's before those of the next: the sum of n
// samples differs from that of one render by n 2^-52 of itself at most, so that the image in float is the same or, in
// few pixels, the next number.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/checkpoint/checkpoint.h"
#include "engine/session/work_done.h"

namespace wavecrest {

struct MergedParts {
  CheckpointHeader header;  // of the sum; notes.stats: mergedStats() of the parts'
  std::unique_ptr<Film> film;
  WorkDone work;
  std::string missing;  // of the whole image, in words; empty: nothing
  // The image's relative RMSE as relativeFilmError has it, from how far the parts lie apart. Nothing for one part, and
  // where parts depend on each other. Leaves out what all parts share: the bias of merging, and the error of mlt's b.
  std::optional<double> relativeError;
  // The images of every other part and of those between: independent halves, as references have them (RGB, row by row).
  // Empty unless asked for, and where whyNoHalves says why there are none.
  std::array<std::vector<float>, 2> halves;
  std::string whyNoHalves;
};

// Throws CheckpointError where a file is damaged or no checkpoint, of another render than the first, or holds what
// another one holds; ImageError where it cannot be read.
MergedParts mergeParts(const std::vector<std::string>& files, bool halves = false);

// Writes the sum, which merges like any part. A render goes on from it where it has no gaps (Holdings::goesOn).
void writeSum(const std::string& file, const MergedParts& merged);

}  // namespace wavecrest
