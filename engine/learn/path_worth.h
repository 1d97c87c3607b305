// What paths are worth to an image, which their roulette goes by (METHODS 12.4; Rath et al. 2022, EARS).
//
// The guide knows how much light comes back from each cell, in the root mean square; a pixel's brightness says what
// that is to the image. The product of a path's throughput, the root and the reciprocal of the brightness is 1 in the
// root mean square over the first vertices of camera paths.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/state/state_stream.h"
#include "kernels/columns/guide_view.h"
#include "kernels/columns/records.h"

namespace wavecrest {

class PathWorth {
 public:
  // pixels: of the film.
  explicit PathWorth(size_t pixels) : perBrightness_((pixels + kWorthRun - 1) / kWorthRun) {}

  // Adds the records of a walk that is over. Safe from several threads.
  void gather(const DirectionRecords& records);
  // luminance: of the film's pixels, in the order of waves. Nothing may be gathering.
  void fold(std::span<const float> luminance);
  // Adds what paths are worth to what kernels read. decides: roulette may go by it.
  void showIn(GuideView& guide, bool decides) const;

  void save(StateWriter& out) const;
  // Throws StateError.
  void restore(StateReader& in);

 private:
  std::vector<float> perBrightness_;
  uint64_t squares_ = 0, count_ = 0;  // of what vertices of the first depth were worth, in units of 2^-kSquareBits
  double norm_ = 1;                   // what is worth 1
  uint64_t folds_ = 0, norms_ = 0;    // norms: folds that found it
};

}  // namespace wavecrest
