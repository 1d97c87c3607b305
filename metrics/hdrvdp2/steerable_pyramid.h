// Steerable pyramid of four orientations: a high-pass residual, levels of four oriented bands, a low-pass base.
//
// in: one plane; out: bands b = 0 (high-pass, full size), b = 1..n (four each, level b - 1 of the pyramid) and b = n +
// 1 (base). Filters correlate with edges mirrored about the edge sample; subsampling keeps samples 0, 2, 4, ...
#pragma once

#include <array>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/hdrvdp2/steerable_filters.h"
#include "metrics/planes/plane.h"

namespace wavecrest::vdp {

struct Size {
  size_t width = 0, height = 0;
};

// The planes of one band: four orientations, or one in the first and last band.
struct Band {
  size_t orientations = 0;
  std::array<Plane, steerable::kOrientations> planes;
};

class SteerablePyramid {
 public:
  SteerablePyramid(size_t width, size_t height, Isa isa);

  size_t levels() const { return levels_; }
  const std::vector<Size>& bandSizes() const { return bandSizes_; }  // levels() + 2

  // Bands of the right sizes, and the intermediate planes of a decomposition; both may be reused.
  std::vector<Band> makeBands() const;
  struct Workspace {
    std::vector<Plane> lowPass;    // x_1 .. x_n, with mirrored borders
    std::vector<Plane> even, odd;  // their even and odd columns
  };
  Workspace makeWorkspace() const;

  // The input has a border of kInputBorder samples, which is overwritten.
  static constexpr size_t kInputBorder = 8;
  void decompose(Plane& input, std::vector<Band>& bands, Workspace& workspace) const;

  // The plane that such bands belong to, to about 1 % of its amplitude (decompose and reconstruct are adjoint, and the
  // filters only nearly orthogonal).
  Plane reconstruct(const std::vector<Band>& bands) const;

 private:
  void filterInput(const Plane& input, Plane& highPass, Plane& lowPass) const;
  void filterLevel(const Plane& in, Band& band) const;
  void subsample(const Plane& even, const Plane& odd, size_t inputHeight, Plane& out) const;

  Isa isa_;
  size_t levels_ = 0;
  std::vector<Size> bandSizes_;
};

}  // namespace wavecrest::vdp
