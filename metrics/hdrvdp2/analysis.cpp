#include "metrics/hdrvdp2/analysis.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::vdp {
namespace {

// Means are taken row by row in double and the rows are added in order.
double rowSum(const float* row, size_t width) { return std::accumulate(row, row + width, 0.0); }
double total(const std::vector<double>& rows) { return std::accumulate(rows.begin(), rows.end(), 0.0); }

}  // namespace

double Analyzer::bandFrequency(size_t band) { return kPixelsPerDegree / 2 * std::exp2(-static_cast<double>(band)); }

Analyzer::Analyzer(size_t width, size_t height, Isa isa)
    : isa_(isa),
      pyramid_(width, height, isa),
      optics_(width, height, isa),
      base_(pyramid_.bandSizes().back().width, pyramid_.bandSizes().back().height, isa),
      opticalGain_(optics_.sampleGain(kPixelsPerDegree, opticalTransfer)) {
  // The light of each display channel's codes at each receptor. The three channels of a pixel are added up later.
  for (size_t channel = 0; channel < 3; ++channel)
    for (size_t receptor = 0; receptor < kReceptors; ++receptor)
      for (size_t code = 0; code < 256; ++code) {
        const double light = displayLight(static_cast<uint8_t>(code)) * kDisplayToReceptors[channel][receptor];
        codeLight_[channel][receptor][code] = static_cast<float>(light);
      }
  // The kernels read the response tables in single precision.
  const ResponseTables tables = makeResponseTables();
  for (double v : tables.cone) coneTable_.push_back(static_cast<float>(v));
  for (double v : tables.rod) rodTable_.push_back(static_cast<float>(v));
}

Analyzer::Workspace Analyzer::makeWorkspace() const {
  const auto [width, height] = pyramid_.bandSizes().front();
  Workspace workspace;
  for (Plane& plane : workspace.light) plane = Plane(width, height);
  workspace.response = Plane(width, height, SteerablePyramid::kInputBorder);
  workspace.spectra = optics_.makeSpectra(kReceptors);
  workspace.baseSpectra = base_.makeSpectra(1);
  workspace.pyramid = pyramid_.makeWorkspace();
  return workspace;
}

Analysis Analyzer::makeAnalysis() const {
  const auto [width, height] = pyramid_.bandSizes().front();
  return {Plane(width, height), pyramid_.makeBands(), 0};
}

// Light at L cones, M cones and rods. Scatter is linear, so it may follow the sum over the display's channels.
void Analyzer::displayToReceptors(const Image8& image, std::array<Plane, kReceptors>& light) const {
  tbb::parallel_for(size_t{0}, size_t{image.height}, [&](size_t y) {
    const uint8_t* codes = image.pixels.data() + y * image.width * 3;
    for (size_t receptor = 0; receptor < kReceptors; ++receptor) {
      const auto &red = codeLight_[0][receptor], &green = codeLight_[1][receptor], &blue = codeLight_[2][receptor];
      float* row = light[receptor].row(y);
      for (size_t x = 0; x < image.width; ++x)
        row[x] = red[codes[3 * x]] + green[codes[3 * x + 1]] + blue[codes[3 * x + 2]];
    }
  });
}

// Adapting luminance and achromatic response without its mean. Returns the mean adapting luminance.
double Analyzer::respond(const std::array<Plane, kReceptors>& light, Plane& adaptation, Plane& response) const {
  const size_t width = adaptation.width(), height = adaptation.height();
  // Response of each pixel, and sums of each row.
  std::vector<double> adaptationSums(height), responseSums(height);
  tbb::parallel_for(size_t{0}, height, [&](size_t y) {
    metricKernels(isa_).photoreceptorRow({.lCone = light[kLCone].row(y),
                                          .mCone = light[kMCone].row(y),
                                          .rod = light[kRod].row(y),
                                          .coneTable = coneTable_.data(),
                                          .rodTable = rodTable_.data(),
                                          .width = width,
                                          .adaptation = adaptation.row(y),
                                          .response = response.row(y)});
    adaptationSums[y] = rowSum(adaptation.row(y), width);
    responseSums[y] = rowSum(response.row(y), width);
  });
  // The pyramid takes the response without its mean.
  const auto count = static_cast<double>(adaptation.pixelCount());
  const auto mean = static_cast<float>(total(responseSums) / count);
  tbb::parallel_for(size_t{0}, height, [&](size_t y) {
    float* row = response.row(y);
    for (size_t x = 0; x < width; ++x) row[x] -= mean;
  });
  return total(adaptationSums) / count;
}

// The base band alone is weighted by contrast sensitivity in the Fourier domain, at the image's mean luminance.
void Analyzer::filterBase(double meanAdaptation, std::optional<double> pad, Analysis& analysis,
                          Workspace& workspace) const {
  Plane& base = analysis.bands.back().planes[0];
  // Mean of the base band: what pads it if no other value is given.
  double sum = 0;
  for (size_t y = 0; y < base.height(); ++y) sum += rowSum(base.row(y), base.width());
  analysis.basePad = sum / static_cast<double>(base.pixelCount());
  // HDR-VDP-2.2 takes 2 sqrt(2) times the band's nominal frequency for its sampling rate.
  const double samplesPerDegree = 2 * std::numbers::sqrt2 * bandFrequency(analysis.bands.size() - 1);
  const FourierGain gain =
      base_.sampleGain(samplesPerDegree, [&](double rho) { return contrastSensitivity(rho, meanAdaptation); });
  const FourierFilterJob job{&base, &base, pad.value_or(analysis.basePad)};
  base_.apply(gain, {&job, 1}, workspace.baseSpectra);
}

void Analyzer::analyze(const Image8& image, std::optional<double> basePad, Analysis& analysis,
                       Workspace& workspace) const {
  // Light of the display at the receptors.
  displayToReceptors(image, workspace.light);
  // Scatter in the eye. The torus around the image shows the surround's light, as each receptor sees it.
  std::array<FourierFilterJob, kReceptors> jobs;
  for (size_t receptor = 0; receptor < kReceptors; ++receptor) {
    double pad = 0;
    for (const auto& channel : kDisplayToReceptors) pad += kSurround * channel[receptor];
    jobs[receptor] = {&workspace.light[receptor], &workspace.light[receptor], pad};
  }
  optics_.apply(opticalGain_, jobs, workspace.spectra);
  // Photoreceptors, then the pyramid, then the base band's contrast sensitivity.
  const double meanAdaptation = respond(workspace.light, analysis.adaptation, workspace.response);
  pyramid_.decompose(workspace.response, analysis.bands, workspace.pyramid);
  filterBase(meanAdaptation, basePad, analysis, workspace);
}

}  // namespace wavecrest::vdp
