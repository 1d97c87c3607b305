#include "metrics/hdrvdp2/hdrvdp2.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "metrics/hdrvdp2/analysis.h"
#include "metrics/hdrvdp2/resize.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace vdp {
namespace {

// What one band needs beyond its samples.
struct BandSettings {
  Size size;
  size_t orientations = 0;
  float scale = 1;  // n_b = 2^b
  double weight = 0;
  bool weighted = true;  // all but the base band are divided by the local threshold
  std::vector<float> sensitivity;
};

// Resampling from a plane of one size to a row of another: columns first, then along the row.
class RowResizer {
 public:
  RowResizer(Size from, Size to) : vertical_(from.height, to.height), horizontal_(from.width, to.width) {}

  // scratch holds a row of the source's width; returns out, or a row of the plane itself when sizes agree.
  const float* row(const MetricKernels& kernels, const Plane& in, size_t y, float* scratch, float* out) const {
    if (vertical_.taps == 1 && horizontal_.taps == 1) return in.row(y);
    std::vector<const float*>& sources = rowList();
    sources.clear();
    for (size_t tap = 0; tap < vertical_.taps; ++tap)
      sources.push_back(in.row(vertical_.indexByOutput[y * vertical_.taps + tap]));
    const float* weights = vertical_.weightByOutput.data() + y * vertical_.taps;
    kernels.weightedSum({sources.data(), sources.size(), &weights, 1, &scratch, in.width()});
    kernels.gatheredSum({scratch, horizontal_.indexByTap.data(), horizontal_.weightByTap.data(), horizontal_.taps,
                         horizontal_.stride, out});
    return out;
  }

 private:
  // The list of source rows stays with the thread.
  static std::vector<const float*>& rowList() {
    thread_local std::vector<const float*> sources;
    return sources;
  }
  ResizeTable vertical_, horizontal_;
};

// What one comparison writes: the analysis of the test image, full-size maps of both images, and mutual masks.
struct Workspace {
  Analysis test;
  Analyzer::Workspace analysis;
  Plane logLuminance, pixelMask;
  std::vector<Band> masks;
};

}  // namespace
}  // namespace vdp

struct PreparedHdrVdp2::State {
  State(const Image8& reference, Isa isa);

  std::unique_ptr<vdp::Workspace> takeWorkspace() const;
  void compareImages(const Image8& test, vdp::Workspace& workspace) const;
  void makeMutualMasks(vdp::Workspace& workspace) const;
  using BandErrors = std::array<double, steerable::kOrientations>;
  // differences, if given, receives the bands of visible differences.
  BandErrors poolBand(size_t band, const vdp::Workspace& workspace, std::vector<vdp::Band>* differences) const;
  BandErrors poolRow(size_t band, size_t y, const vdp::Workspace& workspace, std::vector<vdp::Band>* differences) const;
  std::vector<float> detectionProbability(const std::vector<vdp::Band>& differences) const;

  Isa isa;
  Image8 image;
  vdp::Analyzer analyzer;
  vdp::Analysis reference;
  std::vector<vdp::BandSettings> settings;
  std::vector<vdp::RowResizer> fromFull, fromFiner, fromCoarser;  // by band
  mutable std::mutex poolMutex;
  mutable std::vector<std::unique_ptr<vdp::Workspace>> pool;
};

PreparedHdrVdp2::State::State(const Image8& referenceImage, Isa chosenIsa)
    : isa(chosenIsa),
      image(referenceImage),
      analyzer(referenceImage.width, referenceImage.height, chosenIsa),
      reference(analyzer.makeAnalysis()) {
  // Settings of each band. Sensitivity is tabulated over log10 of the luminance, from -5 to 5.
  const auto& sizes = analyzer.pyramid().bandSizes();
  for (size_t b = 0; b < sizes.size(); ++b) {
    vdp::BandSettings band;
    band.size = sizes[b];
    band.orientations = reference.bands[b].orientations;
    band.scale = std::exp2(static_cast<float>(b));
    const double frequency = vdp::Analyzer::bandFrequency(b);
    band.weight = vdp::bandWeight(frequency);
    band.weighted = b + 1 < sizes.size();
    for (size_t i = 0; i < kVdpSensitivityNodes; ++i) {
      const double logLuminance = -5 + 10 * static_cast<double>(i) / (kVdpSensitivityNodes - 1);
      const double s = band.weighted ? vdp::contrastSensitivity(frequency, std::pow(10.0, logLuminance)) : 1;
      band.sensitivity.push_back(static_cast<float>(s));
    }
    settings.push_back(std::move(band));
    // Resampling to this band. The first and the last band have no neighbour on one side and never read that resizer.
    fromFull.emplace_back(sizes.front(), sizes[b]);
    fromFiner.emplace_back(sizes[b > 0 ? b - 1 : b], sizes[b]);
    fromCoarser.emplace_back(sizes[b + 1 < sizes.size() ? b + 1 : b], sizes[b]);
  }
  // The reference is analysed once. The mean of its base band pads the base bands of all test images too.
  auto workspace = analyzer.makeWorkspace();
  analyzer.analyze(image, std::nullopt, reference, workspace);
}

// A work space from the pool, or a new one when all are in use.
std::unique_ptr<vdp::Workspace> PreparedHdrVdp2::State::takeWorkspace() const {
  {
    const std::lock_guard lock(poolMutex);
    if (!pool.empty()) {
      auto workspace = std::move(pool.back());
      pool.pop_back();
      return workspace;
    }
  }
  const auto [width, height] = settings.front().size;
  return std::make_unique<vdp::Workspace>(vdp::Workspace{analyzer.makeAnalysis(), analyzer.makeWorkspace(),
                                                         Plane(width, height), Plane(width, height),
                                                         analyzer.pyramid().makeBands()});
}

// The maps that need both images at full size: adapting luminance, and which pixels differ at all.
void PreparedHdrVdp2::State::compareImages(const Image8& test, vdp::Workspace& workspace) const {
  analyzer.analyze(test, reference.basePad, workspace.test, workspace.analysis);
  const size_t width = image.width;
  tbb::parallel_for(size_t{0}, size_t{image.height}, [&](size_t y) {
    metricKernels(isa).logMeanRow({.first = workspace.test.adaptation.row(y),
                                   .second = reference.adaptation.row(y),
                                   .width = width,
                                   .out = workspace.logLuminance.row(y)});
    // One code makes at least 0.88 % of light, above the metric's limit of 0.1 %.
    const uint8_t *a = test.pixels.data() + y * width * 3, *b = image.pixels.data() + y * width * 3;
    float* mask = workspace.pixelMask.row(y);
    for (size_t x = 0; x < width; ++x, a += 3, b += 3)
      mask[x] = static_cast<float>((a[0] != b[0]) | (a[1] != b[1]) | (a[2] != b[2]));
  });
}

// The mutual mask m of every band and orientation. Rows beyond the band are null, and count as zero.
void PreparedHdrVdp2::State::makeMutualMasks(vdp::Workspace& workspace) const {
  for (size_t b = 0; b < settings.size(); ++b) {
    const size_t width = settings[b].size.width, height = settings[b].size.height;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, height, 8), [&](const tbb::blocked_range<size_t>& range) {
      AlignedArray<float> scratch(roundUpToLanes(width) + 2 * kPlaneLanes);
      for (size_t y = range.begin(); y < range.end(); ++y) {
        for (size_t o = 0; o < settings[b].orientations; ++o) {
          const Plane &test = workspace.test.bands[b].planes[o], &ref = reference.bands[b].planes[o];
          const auto rows = [&](const Plane& plane) {
            return std::array{y > 0 ? plane.row(y - 1) : nullptr, plane.row(y),
                              y + 1 < height ? plane.row(y + 1) : nullptr};
          };
          metricKernels(isa).mutualMaskRow({.test = rows(test),
                                            .reference = rows(ref),
                                            .width = width,
                                            .scratch = scratch.data() + kPlaneLanes,
                                            .out = workspace.masks[b].planes[o].row(y)});
        }
      }
    });
  }
}

// Sum of squared differences of one row of a band, for each orientation.
PreparedHdrVdp2::State::BandErrors PreparedHdrVdp2::State::poolRow(size_t b, size_t y, const vdp::Workspace& workspace,
                                                                   std::vector<vdp::Band>* differences) const {
  const MetricKernels& kernels = metricKernels(isa);
  const vdp::BandSettings& band = settings[b];
  const size_t width = band.size.width, rowFloats = roundUpToLanes(image.width) + kPlaneLanes;
  // Seven rows of scratch in one buffer of the thread.
  thread_local AlignedArray<float> buffer;
  if (buffer.size() < 7 * rowFloats) buffer = AlignedArray<float>(7 * rowFloats);
  std::array<float*, 7> rows{};
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = buffer.data() + i * rowFloats;
  const auto [scratch, logLuminance, mask, toQ, toMinusTwoP, finer, coarser] = rows;

  // Sensitivity S at the luminance of this row's samples, as S^q and S^(-2p).
  kernels.sensitivityRow({.logLuminance = fromFull[b].row(kernels, workspace.logLuminance, y, scratch, logLuminance),
                          .table = band.sensitivity.data(),
                          .width = width,
                          .q = static_cast<float>(vdp::kMaskExponent),
                          .twoP = static_cast<float>(2 * vdp::kDifferenceExponent),
                          .toQ = toQ,
                          .toMinusTwoP = toMinusTwoP});

  // Constants of masking. k_self and k_xo include n_b^-q, which divides the band's own masks. The neighbours' masks are
  // divided by n_b / 2 and 2 n_b before their power is taken.
  const double withinScale = std::pow(double{band.scale}, -vdp::kMaskExponent);
  DifferenceRow row{};
  row.pixelMask = fromFull[b].row(kernels, workspace.pixelMask, y, scratch, mask);
  row.sensitivityToQ = toQ;
  row.sensitivityToMinusTwoP = toMinusTwoP;
  row.width = width;
  row.twoP = static_cast<float>(2 * vdp::kDifferenceExponent);
  row.q = static_cast<float>(vdp::kMaskExponent);
  row.scale = band.scale;
  row.finerScale = 2 / band.scale;
  row.coarserScale = 1 / (2 * band.scale);
  row.kSelf = static_cast<float>(vdp::kSelfMasking * withinScale);
  row.kXo = static_cast<float>(vdp::kOrientationMasking * withinScale);
  row.kXn = static_cast<float>(vdp::kScaleMasking);
  for (size_t o = 0; o < band.orientations; ++o) row.siblings[o] = workspace.masks[b].planes[o].row(y);

  // Sums of the orientations, one after the other.
  BandErrors sums{};
  for (size_t o = 0; o < band.orientations; ++o) {
    // A neighbour with a single orientation serves all of ours; the base band masks no other band.
    const auto neighbour = [&](size_t n) -> const Plane& {
      return workspace.masks[n].planes[settings[n].orientations > 1 ? o : 0];
    };
    if (b > 0) row.finer = fromFiner[b].row(kernels, neighbour(b - 1), y, scratch, finer);
    if (b + 2 < settings.size()) row.coarser = fromCoarser[b].row(kernels, neighbour(b + 1), y, scratch, coarser);
    row.test = workspace.test.bands[b].planes[o].row(y);
    row.reference = reference.bands[b].planes[o].row(y);
    row.self = workspace.masks[b].planes[o].row(y);
    row.difference = differences ? (*differences)[b].planes[o].row(y) : nullptr;
    sums[o] = kernels.differenceRow(row);
  }
  return sums;
}

// E of each orientation of a band. Row sums are added in order.
PreparedHdrVdp2::State::BandErrors PreparedHdrVdp2::State::poolBand(size_t b, const vdp::Workspace& workspace,
                                                                    std::vector<vdp::Band>* differences) const {
  const auto [width, height] = settings[b].size;
  std::vector<BandErrors> rows(height);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, height, 4), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t y = range.begin(); y < range.end(); ++y) rows[y] = poolRow(b, y, workspace, differences);
  });
  BandErrors errors{};
  for (size_t o = 0; o < errors.size(); ++o) {
    for (const BandErrors& row : rows) errors[o] += row[o];
    // The number of samples divides outside the root: that is how the metric is defined and calibrated.
    errors[o] = std::sqrt(errors[o]) / static_cast<double>(width * height);
  }
  return errors;
}

// The psychometric function of the reconstructed difference: 1 is the threshold, seen with probability one half.
// Local probabilities, without the original's pooling over the image. The original raises bands to the power
// 3.5 / p before reconstruction, which is 1 to seven digits.
std::vector<float> PreparedHdrVdp2::State::detectionProbability(const std::vector<vdp::Band>& differences) const {
  const Plane visible = analyzer.pyramid().reconstruct(differences);
  std::vector<float> probability;
  probability.reserve(visible.pixelCount());
  for (size_t y = 0; y < visible.height(); ++y)
    for (size_t x = 0; x < visible.width(); ++x) probability.push_back(1 - std::exp2(-std::abs(visible.row(y)[x])));
  return probability;
}

namespace {

const Image8& largeEnough(const Image8& image) {
  if (std::min(image.width, image.height) < kHdrVdp2SmallestSide) {
    throw std::invalid_argument("HDR-VDP-2 needs at least " + std::to_string(kHdrVdp2SmallestSide) +
                                " pixels on each side");
  }
  return image;
}

}  // namespace

PreparedHdrVdp2::PreparedHdrVdp2(const Image8& reference, Isa isa)
    : state_(std::make_unique<State>(largeEnough(reference), isa)) {}
PreparedHdrVdp2::~PreparedHdrVdp2() = default;
PreparedHdrVdp2::PreparedHdrVdp2(PreparedHdrVdp2&&) noexcept = default;
PreparedHdrVdp2& PreparedHdrVdp2::operator=(PreparedHdrVdp2&&) noexcept = default;

HdrVdp2Result PreparedHdrVdp2::compare(const Image8& test, bool withProbability,
                                       std::vector<HdrVdp2Band>* bands) const {
  // Analysis of the test image and the mutual masks, which all bands need.
  auto workspace = state_->takeWorkspace();
  state_->compareImages(test, *workspace);
  state_->makeMutualMasks(*workspace);

  HdrVdp2Result result;
  std::vector<vdp::Band> differences;
  if (withProbability) differences = state_->analyzer.pyramid().makeBands();
  // Q: the mean over bands and orientations of the weighted logarithms of E.
  size_t count = 0;
  for (size_t b = 0; b < state_->settings.size(); ++b) {
    const vdp::BandSettings& band = state_->settings[b];
    const State::BandErrors errors = state_->poolBand(b, *workspace, withProbability ? &differences : nullptr);
    for (size_t o = 0; o < band.orientations; ++o, ++count) {
      result.q += band.weight * std::log(errors[o] + vdp::kPoolingEpsilon);
      if (bands) bands->push_back({b, o, band.weight, errors[o]});
    }
  }
  result.q /= static_cast<double>(count);
  result.qMos = vdp::meanOpinionScore(result.q);
  if (withProbability) result.probability = state_->detectionProbability(differences);
  // The work space goes back to the pool.
  const std::lock_guard lock(state_->poolMutex);
  state_->pool.push_back(std::move(workspace));
  return result;
}

}  // namespace wavecrest
