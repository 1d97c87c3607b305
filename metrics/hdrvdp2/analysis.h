// The part of HDR-VDP-2 that looks at one image: display light, scatter in the eye, photoreceptors, pyramid.
#pragma once

#include <optional>
#include <vector>

#include "metrics/hdrvdp2/model.h"
#include "metrics/hdrvdp2/steerable_pyramid.h"
#include "metrics/image/image.h"
#include "metrics/planes/fourier_filter.h"

namespace wavecrest::vdp {

// What is known of one image after the analysis.
struct Analysis {
  Plane adaptation;         // cd/m2
  std::vector<Band> bands;  // the base band is filtered by the eye's contrast sensitivity
  double basePad = 0;       // mean of the base band before that filter
};

// Everything that depends on the image size only.
class Analyzer {
 public:
  Analyzer(size_t width, size_t height, Isa isa);

  struct Workspace {
    std::array<Plane, kReceptors> light;
    Plane response;
    FourierFilter::Spectra spectra, baseSpectra;
    SteerablePyramid::Workspace pyramid;
  };
  Workspace makeWorkspace() const;
  Analysis makeAnalysis() const;

  // basePad: of the reference, when a test image is analysed; otherwise the image's own.
  void analyze(const Image8& image, std::optional<double> basePad, Analysis& analysis, Workspace& workspace) const;

  const SteerablePyramid& pyramid() const { return pyramid_; }
  // Nominal frequency of a band, cycles per degree.
  static double bandFrequency(size_t band);

 private:
  void displayToReceptors(const Image8& image, std::array<Plane, kReceptors>& light) const;
  double respond(const std::array<Plane, kReceptors>& light, Plane& adaptation, Plane& response) const;
  void filterBase(double meanAdaptation, std::optional<double> pad, Analysis& analysis, Workspace& workspace) const;

  Isa isa_;
  SteerablePyramid pyramid_;
  FourierFilter optics_, base_;
  FourierGain opticalGain_;
  // Light of each 8-bit code of each display channel at each receptor.
  std::array<std::array<std::array<float, 256>, kReceptors>, 3> codeLight_{};
  std::vector<float> coneTable_, rodTable_;
};

}  // namespace wavecrest::vdp
