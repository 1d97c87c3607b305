// One layer of samples of a reference, prepared for structural similarity: what SSIM, MS-SSIM and PU21-SSIM share.
//
// A layer holds one channel or several that are interleaved; each window takes 11x11 samples of one channel. The test
// image comes row by row from a function, so that a caller need not store it in this form.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/kernels/ssim_row.h"
#include "metrics/planes/plane.h"

namespace wavecrest {

class PreparedSsimLayer {
 public:
  // Writes row y of the test image's samples, as many as the reference's rows have.
  using TestRows = std::function<void(size_t y, float* out)>;

  // At least 11 samples of each channel in both directions.
  PreparedSsimLayer(Plane values, size_t channels, SsimConstants constants, Isa isa);

  size_t windowRows() const { return mean_.height(); }
  size_t rowWindows() const { return mean_.width(); }  // of all channels
  size_t channels() const { return channels_; }

  // Bands of rows of windows: one task each, in any order. rowSums has windowRows() entries; map, if given, is
  // rowWindows() x windowRows() with a slack of kSsimSlack.
  size_t bands() const;
  void compareBand(size_t band, const TestRows& testRows, SsimSums* rowSums, Plane* map) const;

  // Mean of all windows of each channel.
  SsimSums mean(const std::vector<SsimSums>& rowSums) const;
  // All bands on all threads, then the mean.
  SsimSums compare(const TestRows& testRows, Plane* map = nullptr) const;

 private:
  Isa isa_;
  size_t channels_;
  SsimConstants constants_;
  std::array<float, kSsimRadius + 1> taps_{};  // centre and offsets 1..5 of the window
  Plane values_;                               // x, full size
  Plane mean_, variance_;                      // of each window
};

}  // namespace wavecrest
