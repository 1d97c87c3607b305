// HDR-VDP-2.2: the quality scores Q and Q_MOS of an 8-bit test image against a reference, on an sRGB display at 30
// pixels per degree, all other parameters at their defaults. Higher Q is worse; Q_MOS runs from 0 to 100, 100 best.
//
// Identical images score less than infinitely well: the ceiling depends on the number of pyramid levels, so scores of
// images of very different sizes must not be compared. metrics/hdrvdp2/README.md describes the stages.
#pragma once

#include <memory>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/image/image.h"

namespace wavecrest {

constexpr uint32_t kHdrVdp2SmallestSide = 17;

struct HdrVdp2Result {
  double q = 0;
  double qMos = 0;
  // Probability that an observer sees a difference at each pixel; width * height, empty unless asked for.
  std::vector<float> probability;
};

// The contribution of one band and orientation to Q, for tests and for finding out where a score comes from.
struct HdrVdp2Band {
  size_t band = 0, orientation = 0;
  double weight = 0;  // of the band in Q
  double error = 0;   // E: root of the summed squared differences over the number of samples
};

// Everything that depends on the reference alone, and the work space of comparisons. The reference's part is immutable;
// any number of threads may compare at the same time, each taking a work space from a pool.
class PreparedHdrVdp2 {
 public:
  // Throws std::invalid_argument when a side is below kHdrVdp2SmallestSide.
  explicit PreparedHdrVdp2(const Image8& reference, Isa isa = bestIsa());
  ~PreparedHdrVdp2();
  PreparedHdrVdp2(PreparedHdrVdp2&&) noexcept;
  PreparedHdrVdp2& operator=(PreparedHdrVdp2&&) noexcept;

  // The test image has the reference's size. bands, if given, receives every band's contribution.
  HdrVdp2Result compare(const Image8& test, bool withProbability = false,
                        std::vector<HdrVdp2Band>* bands = nullptr) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wavecrest
