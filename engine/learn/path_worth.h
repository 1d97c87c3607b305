// How much a path is expected to add to its pixel, relative to the pixel's brightness: its worth, by which roulette of
// gpt decides (METHODS 12.6; Rath et al. 2022, EARS).
//
// worth = luminance of the throughput x root mean square of the light that came back to the cell (Guide) / brightness
// of the pixel, scaled so that the root mean square over the first vertices of all camera paths is 12.
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

  // Adds the records of a finished walk. Thread-safe.
  void gather(const DirectionRecords& records);
  // Ends a block. luminance: of the film's pixels, in the order of waves. No thread may be in gather().
  void fold(std::span<const float> luminance);
  // Sets the members of the view by which kernels find a path's worth, and whether roulette goes by it.
  void showIn(GuideView& guide) const;

  void save(StateWriter& out) const;
  // Throws StateError.
  void restore(StateReader& in);

 private:
  std::vector<float> perBrightness_;  // scale / brightness, of runs of pixels
  // Sum of worth^2 over the first vertices, and their number, those included whose paths roulette ended there; in units
  // of 2^-kSquareBits.
  uint64_t squares_ = 0, count_ = 0;
  double norm_ = 1;  // by which worths are divided
  bool hasBrightness_ = false, hasNorm_ = false;
};

}  // namespace wavecrest
