// Which iterations of an image a session renders: the numbers that its own first, second, ... iteration have in the
// whole. Random numbers and the radius of merges follow from these numbers.
//
// A share of RenderShare::rounds takes part in rounds of n, 2 n, 4 n, ... iterations of the image, for n shares, and
// has a run of equal length in each: 1, 2, 4, ... iterations. Whenever a render ends, shares that are equally fast have
// about the first iterations of the image, in a few runs, as one session would have. The last round ends with the
// image and is cut into equal runs as well. Any other share is one run from RenderSettings::firstIteration on.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/plan/render_settings.h"

namespace wavecrest {

class ShareIterations {
 public:
  using Run = std::pair<uint64_t, uint64_t>;  // iterations [first, second) of the image

  explicit ShareIterations(const RenderSettings& settings);

  // The number in the image of this session's iteration `own`, from 0 on.
  uint64_t number(uint64_t own) const { return runWith(own).number; }
  // How many iterations from `own` on have consecutive numbers.
  uint64_t together(uint64_t own) const { return runWith(own).left; }
  // The numbers of the first `count` iterations, ascending.
  std::vector<Run> runs(uint64_t count) const;

 private:
  struct Place {
    uint64_t number, left;
  };
  Place runWith(uint64_t own) const;

  bool rounds_;
  uint64_t first_, part_, parts_, all_;  // all: of the image, or the largest number
};

// Iterations of a share of rounds, of so many of the image.
uint64_t iterationsInRounds(uint64_t all, uint32_t part, uint32_t parts);

}  // namespace wavecrest
