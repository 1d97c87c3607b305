// ColorVideoVDP 0.5.7 for still images: the quality of an 8-bit test image in just-objectionable differences (JOD). 10
// is no visible difference; one JOD less is a difference that 75 % of observers would choose against.
//
// The display is the package's "standard_4k" (cvvdp/model.h). metrics/cvvdp/README.md describes the stages.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/image/image.h"

namespace wavecrest {

constexpr uint32_t kCvvdpSmallestSide = 16;
// What the original prints of itself for this display.
constexpr std::string_view kCvvdpConditions =
    "ColorVideoVDP v0.5.7, 75.4 [pix/deg], Lpeak=200, Lblack=0.2, Lrefl=0.3979 [cd/m^2], (standard_4k)";

struct CvvdpResult {
  double jod = 0;
  // Pooled difference of each band, finest first, in the opponent channels: where a score comes from.
  std::vector<std::array<double, 3>> bands;
  // 1 - JOD / 10 of each pixel; width * height, empty unless asked for.
  std::vector<float> map;
};

// Everything that depends on the reference alone, and the work space of comparisons. The reference's part is immutable;
// any number of threads may compare at the same time, each taking a work space from a pool.
class PreparedCvvdp {
 public:
  // Throws std::invalid_argument when a side is below kCvvdpSmallestSide.
  explicit PreparedCvvdp(const Image8& reference, Isa isa = bestIsa());
  ~PreparedCvvdp();
  PreparedCvvdp(PreparedCvvdp&&) noexcept;
  PreparedCvvdp& operator=(PreparedCvvdp&&) noexcept;

  // The test image has the reference's size.
  CvvdpResult compare(const Image8& test, bool withMap = false) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wavecrest
