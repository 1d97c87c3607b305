// FLIP: the difference an observer perceives when flipping between two images, per pixel and on average, 0..1.
//
// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020. Opponent colours are filtered by contrast sensitivity, compared as Hunt-adjusted
// CIELAB by the HyAB distance, and the colour error is raised by differences of edges and points. HDR-FLIP: Andersson,
// Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021. The
// largest LDR-FLIP over a series of exposures, tone-mapped; the exposures follow from the reference alone, so all
// comparisons against it use the same.
#pragma once

#include <array>
#include <vector>

#include "metrics/flip_model.h"
#include "metrics/image/image.h"

namespace wavecrest {

// 0.7 m from a 0.7 m wide display of 3840 pixels.
constexpr double kFlipPixelsPerDegree = 67.02064327658225;

struct FlipResult {
  double mean = 0;
  std::vector<float> map;  // width * height, empty unless asked for
};

// LDR-FLIP against one reference of 8-bit gamma-corrected codes. Immutable; any number of threads may compare.
class PreparedFlip {
 public:
  explicit PreparedFlip(const Image8& reference, double pixelsPerDegree = kFlipPixelsPerDegree, Isa isa = bestIsa());
  FlipResult compare(const Image8& test, bool withMap = false) const;

 private:
  FlipModel::Opponents opponents(const Image8& image) const;

  FlipModel model_;
  std::array<std::array<std::array<float, 256>, 3>, 3> codeOpponents_{};  // of each code of each channel
  FlipModel::Features reference_;
};

// HDR-FLIP against one reference of linear light. Its pixels that are not finite do not choose exposures. Light of many
// stops has many exposures. Features of the reference are stored for the first kKeptExposures; those of the others are
// computed in each comparison.
class PreparedHdrFlip {
 public:
  explicit PreparedHdrFlip(const Image& reference, double pixelsPerDegree = kFlipPixelsPerDegree, Isa isa = bestIsa());
  FlipResult compare(const Image& test, bool withMap = false) const;

  static constexpr size_t kKeptExposures = 16;
  const std::vector<double>& exposures() const { return exposures_; }  // in stops

 private:
  FlipModel model_;
  std::vector<double> exposures_;
  std::vector<FlipModel::Features> references_;  // for the first exposures
  Image light_;                                  // of the reference, for the others; empty where there are none
};

}  // namespace wavecrest
