// What LDR-FLIP and HDR-FLIP share (flip.h): filters for one viewing condition, features of an image, comparison of
// two.
#pragma once

#include <array>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/planes/plane.h"

namespace wavecrest {

class FlipModel {
 public:
  explicit FlipModel(double pixelsPerDegree, Isa isa);

  // Opponent colours Y, Cx, Cz of linear RGB, relative to the white point.
  using Opponents = std::array<Plane, 3>;
  static std::array<float, 3> opponent(double red, double green, double blue);

  // Lightness, a, b, edge, point.
  using Features = std::array<Plane, 5>;
  Features analyze(const Opponents& image) const;

  // Writes max(map, error) of each pixel.
  void compare(const Features& reference, const Opponents& test, Plane& map) const;

 private:
  struct RowBuffers;
  void analyzeRow(const Opponents& image, size_t y, const std::array<float*, 5>& out, RowBuffers& buffers) const;

  Isa isa_;
  size_t radius_ = 0;
  // One-dimensional factors of all filters, 2 radius + 1 taps each: achromatic, red-green, the two Gaussians of
  // blue-yellow with their factors across the row; then Gaussian, edge and point of the feature detector.
  enum Tap : size_t { kAchromatic, kRedGreen, kBlueYellow1, kBlueYellow2, kGaussian, kEdge, kPoint, kTapSets };
  std::array<std::vector<float>, kTapSets> down_, across_;
  std::array<float, 9> rgbFromXyz_{}, xyzFromRgb_{};
  float colourMaximum_ = 0;
};

}  // namespace wavecrest
