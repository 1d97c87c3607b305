#include "metrics/cvvdp/cvvdp.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "metrics/cvvdp/model.h"
#include "metrics/cvvdp/pyramid.h"
#include "metrics/hdrvdp2/correlation.h"
#include "metrics/image/srgb.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace cvvdp {
namespace {

using Planes = std::array<Plane, kOpponents>;

Planes makePlanes(PlaneSize size) {
  return {Plane(size.width, size.height), Plane(size.width, size.height), Plane(size.width, size.height)};
}

// Row y of the three opponent planes, to write or to read.
template <class PlanesType>
auto rowsOf(PlanesType& planes, size_t y) {
  return std::array{planes[0].row(y), planes[1].row(y), planes[2].row(y)};
}
CvvdpChannels<const float*> readRows(const Planes& planes, size_t y) { return rowsOf(planes, y); }

// One band: what the reference alone decides.
struct Band {
  PlaneSize size;
  Planes sensitivity;  // at the reference's background; gain of channel and band included
  Planes reference;    // contrast in units of its threshold
};

// Of a comparison. Levels have one more entry than bands: the base.
struct Workspace {
  std::vector<Planes> levels;        // Gaussian pyramid of the test image
  std::vector<Planes> test, mutual;  // contrast in units of the threshold; min(|test|, |reference|)
  std::vector<Planes> differences;   // only where a map is asked for
};

// Rows for one thread, reused: fresh pages would cost more than the arithmetic.
float* scratchRow(size_t which, size_t floats) {
  thread_local std::array<AlignedArray<float>, 8> rows;
  if (rows[which].size() < floats) rows[which] = AlignedArray<float>(floats);
  return rows[which].data();
}

// Gaussian that smears mutual contrast: weights of the centre and its neighbours to either side, sum 1.
std::array<float, 2 * kMaskBlurRadius + 1> blurWeights() {
  std::array<double, 2 * kMaskBlurRadius + 1> weights{};
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double t = (static_cast<double>(i) - double{kMaskBlurRadius}) / kMaskBlurSigma;
    sum += weights[i] = std::exp(-0.5 * t * t);
  }
  std::array<float, weights.size()> result{};
  std::transform(weights.begin(), weights.end(), result.begin(), [&](double w) { return static_cast<float>(w / sum); });
  return result;
}

// Row y of a plane, blurred; images reflect at their edges, the edge sample is not repeated. Bands no larger than the
// reflection are left as they are.
const float* blurredRow(const MetricKernels& kernels, const Plane& plane, size_t y, size_t channel) {
  const size_t width = plane.width(), height = plane.height();
  if (std::min(width, height) <= kMaskBlurRadius) return plane.row(y);
  static const auto kWeights = blurWeights();
  // Scratch: a row filtered down the columns, with borders, and the result of each channel.
  constexpr size_t kBorder = kPlaneLanes;
  float* down = scratchRow(0, roundUpToLanes(width) + 2 * kBorder) + kBorder;
  float* across = scratchRow(1 + channel, roundUpToLanes(width));
  std::array<const float*, kWeights.size()> sources{};
  const float* weights[] = {kWeights.data()};
  const auto filter = [&](float* out) {
    float* outputs[] = {out};
    kernels.weightedSum({.sources = sources.data(),
                         .count = sources.size(),
                         .weights = weights,
                         .outputs = 1,
                         .out = outputs,
                         .width = width});
  };
  // Down the columns.
  for (size_t tap = 0; tap < sources.size(); ++tap)
    sources[tap] = plane.row(vdp::mirroredIndex(static_cast<std::ptrdiff_t>(y + tap) - kMaskBlurRadius, height));
  filter(down);
  // Reflect the row at both ends, then filter along it.
  for (size_t i = 1; i <= kMaskBlurRadius; ++i) {
    down[-static_cast<std::ptrdiff_t>(i)] = down[i];
    down[width - 1 + i] = down[width - 1 - i];
  }
  for (size_t tap = 0; tap < sources.size(); ++tap) sources[tap] = down + tap - kMaskBlurRadius;
  filter(across);
  return across;
}

}  // namespace
}  // namespace cvvdp

using namespace cvvdp;

struct PreparedCvvdp::State {
  State(const Image8& reference, Isa chosenIsa);

  void makeLevels(const Image8& image, std::vector<Planes>& levels) const;
  CvvdpChannels<const float*> expandedRows(const Planes& coarse, size_t level, size_t y) const;
  void prepareBand(size_t b, const std::vector<Planes>& levels, double frequency);
  std::unique_ptr<Workspace> takeWorkspace() const;
  std::array<double, kOpponents> poolBand(size_t b, Workspace& workspace, bool withMap) const;
  std::array<double, kOpponents> poolBase(Workspace& workspace, bool withMap) const;
  std::vector<float> differenceMap(Workspace& workspace) const;

  const MetricKernels& kernels;
  std::array<std::array<std::array<float, 256>, kOpponents>, 3> codeOpponents{};  // by code channel
  std::vector<Halving> halvings;                                                  // from each level to the next
  std::vector<Band> bands;                                                        // without the base
  Planes base;                                                                    // the coarsest level of the reference
  double baseBackground = 0;                                                      // of the reference
  std::array<double, kOpponents> baseSensitivity{};
  mutable std::mutex poolMutex;
  mutable std::vector<std::unique_ptr<Workspace>> pool;
};

namespace {

// Mean of the achromatic channel of the coarsest level.
double backgroundOf(const Planes& base) {
  double sum = 0;
  for (size_t y = 0; y < base[0].height(); ++y)
    for (size_t x = 0; x < base[0].width(); ++x) sum += std::max(double{base[0].row(y)[x]}, kLeastBackground);
  return sum / static_cast<double>(base[0].pixelCount());
}

// The root of the mean of squares, in the metric's offset powers.
double rootMeanSquare(double sumOfSquares, size_t samples) {
  return offsetPower(sumOfSquares / static_cast<double>(samples), 0.5);
}

// Bands but the first and the base count twice.
double bandGain(size_t band) { return band == 0 ? 1 : 2; }

}  // namespace

PreparedCvvdp::State::State(const Image8& reference, Isa isa) : kernels(metricKernels(isa)) {
  if (std::min(reference.width, reference.height) < kCvvdpSmallestSide)
    throw std::invalid_argument("ColorVideoVDP needs at least " + std::to_string(kCvvdpSmallestSide) +
                                " pixels on each side");
  // Opponent colours are linear in light: each code adds its own.
  const auto matrix = opponentFromRgb();
  for (size_t channel = 0; channel < 3; ++channel)
    for (size_t o = 0; o < kOpponents; ++o)
      for (size_t code = 0; code < 256; ++code)
        codeOpponents[channel][o][code] = static_cast<float>(matrix[o][channel] * displayed(srgbDecodeTable()[code]));

  // Bands and the sizes of their planes.
  const std::vector<double> frequencies = bandFrequencies(reference.width, reference.height);
  PlaneSize size{reference.width, reference.height};
  for (size_t b = 0; b + 1 < frequencies.size(); ++b) {
    bands.push_back({size, makePlanes(size), makePlanes(size)});
    halvings.emplace_back(size);
    size = halvings.back().coarse();
  }
  // The reference's Gaussian pyramid. What bands and base need of it is kept.
  std::vector<Planes> levels;
  for (const Band& band : bands) levels.push_back(makePlanes(band.size));
  levels.push_back(makePlanes(size));
  makeLevels(reference, levels);
  for (size_t b = 0; b < bands.size(); ++b) prepareBand(b, levels, frequencies[b]);
  base = std::move(levels.back());
  baseBackground = backgroundOf(base);
  for (size_t o = 0; o < kOpponents; ++o)
    baseSensitivity[o] = sensitivity(sensitivityCurve(o, frequencies.back()), baseBackground);
}

// Opponent colours of the displayed image, and its Gaussian pyramid.
void PreparedCvvdp::State::makeLevels(const Image8& image, std::vector<Planes>& levels) const {
  tbb::parallel_for(size_t{0}, size_t{image.height}, [&](size_t y) {
    const uint8_t* codes = image.pixels.data() + y * image.width * 3;
    for (size_t o = 0; o < kOpponents; ++o) {
      const auto &red = codeOpponents[0][o], &green = codeOpponents[1][o], &blue = codeOpponents[2][o];
      float* row = levels[0][o].row(y);
      for (size_t x = 0; x < image.width; ++x)
        row[x] = red[codes[3 * x]] + green[codes[3 * x + 1]] + blue[codes[3 * x + 2]];
    }
  });
  for (size_t l = 0; l < halvings.size(); ++l) {
    tbb::parallel_for(size_t{0}, levels[l + 1][0].height(), [&](size_t y) {
      float* scratch = scratchRow(0, halvings[l].scratchFloats());
      for (size_t o = 0; o < kOpponents; ++o)
        halvings[l].reduceRow(kernels, levels[l][o], y, scratch, levels[l + 1][o].row(y));
    });
  }
}

// Row y of the level after `level`, expanded to the size of `level`. The rows are scratch of the thread.
CvvdpChannels<const float*> PreparedCvvdp::State::expandedRows(const Planes& coarse, size_t level, size_t y) const {
  const size_t floats = halvings[level].scratchFloats();
  CvvdpChannels<const float*> rows{};
  for (size_t o = 0; o < kOpponents; ++o) {
    float* out = scratchRow(1 + o, floats);
    halvings[level].expandRow(kernels, coarse[o], y, scratchRow(0, floats), out);
    rows[o] = out;
  }
  return rows;
}

// The reference's contrast and sensitivity, in double: done once per reference, so plain loops do.
void PreparedCvvdp::State::prepareBand(size_t b, const std::vector<Planes>& levels, double frequency) {
  std::array<SensitivityCurve, kOpponents> curves{};
  for (size_t o = 0; o < kOpponents; ++o) curves[o] = sensitivityCurve(o, frequency);
  tbb::parallel_for(size_t{0}, bands[b].size.height, [&](size_t y) {
    // The next level is the local background: its achromatic channel divides all three differences.
    const auto coarse = expandedRows(levels[b + 1], b, y);
    for (size_t x = 0; x < bands[b].size.width; ++x) {
      const double background = std::max(double{coarse[0][x]}, kLeastBackground);
      for (size_t o = 0; o < kOpponents; ++o) {
        const double gain = sensitivity(curves[o], background) * kChannelGain[o] * bandGain(b);
        const double contrast = (double{levels[b][o].row(y)[x]} - double{coarse[o][x]}) / background;
        bands[b].sensitivity[o].row(y)[x] = static_cast<float>(gain);
        bands[b].reference[o].row(y)[x] = static_cast<float>(std::min(contrast, kGreatestContrast) * gain);
      }
    }
  });
}

// A work space from the pool, or a new one when all are in use.
std::unique_ptr<Workspace> PreparedCvvdp::State::takeWorkspace() const {
  {
    const std::lock_guard lock(poolMutex);
    if (!pool.empty()) {
      auto workspace = std::move(pool.back());
      pool.pop_back();
      return workspace;
    }
  }
  auto workspace = std::make_unique<Workspace>();
  for (const Band& band : bands) {
    workspace->levels.push_back(makePlanes(band.size));
    workspace->test.push_back(makePlanes(band.size));
    workspace->mutual.push_back(makePlanes(band.size));
  }
  workspace->levels.push_back(makePlanes({base[0].width(), base[0].height()}));
  return workspace;
}

// Pooled visible differences of one band.
std::array<double, kOpponents> PreparedCvvdp::State::poolBand(size_t b, Workspace& workspace, bool withMap) const {
  const Band& band = bands[b];
  // Contrast of the test image, and mutual contrast. All rows come first, as the blur reads neighbouring rows.
  Planes &test = workspace.test[b], &mutual = workspace.mutual[b];
  tbb::parallel_for(size_t{0}, band.size.height, [&](size_t y) {
    kernels.cvvdpContrastRow({.fine = readRows(workspace.levels[b], y),
                              .coarse = expandedRows(workspace.levels[b + 1], b, y),
                              .sensitivity = readRows(band.sensitivity, y),
                              .reference = readRows(band.reference, y),
                              .width = band.size.width,
                              .leastBackground = static_cast<float>(kLeastBackground),
                              .greatestContrast = static_cast<float>(kGreatestContrast),
                              .test = rowsOf(test, y),
                              .mutual = rowsOf(mutual, y)});
  });

  // Differences, masked by the blurred mutual contrast.
  CvvdpDifferenceRow settings{};
  settings.width = band.size.width;
  settings.offset = static_cast<float>(kPowerOffset);
  settings.differenceExponent = static_cast<float>(kDifferenceExponent);
  settings.maskGain = static_cast<float>(std::pow(10.0, kLogMaskGain));
  settings.greatest = static_cast<float>(std::pow(10.0, kLogGreatestDifference));
  for (size_t k = 0; k < kOpponents; ++k) {
    settings.maskExponent[k] = static_cast<float>(kMaskExponent[k]);
    for (size_t c = 0; c < kOpponents; ++c)
      settings.crossMasking[k][c] = static_cast<float>(std::exp2(kLogCrossMasking[k][c]));
  }
  std::vector<std::array<double, kOpponents>> rows(band.size.height);
  tbb::parallel_for(size_t{0}, band.size.height, [&](size_t y) {
    CvvdpDifferenceRow row = settings;
    row.test = readRows(test, y);
    row.reference = readRows(band.reference, y);
    for (size_t o = 0; o < kOpponents; ++o) row.mutual[o] = blurredRow(kernels, mutual[o], y, o);
    if (withMap) row.difference = rowsOf(workspace.differences[b], y);
    rows[y] = kernels.cvvdpDifferenceRow(row);
  });

  // Rows are added in order, so the result does not depend on the number of threads.
  std::array<double, kOpponents> pooled{};
  for (const auto& row : rows)
    for (size_t o = 0; o < kOpponents; ++o) pooled[o] += row[o];
  for (double& value : pooled) value = rootMeanSquare(value, band.size.width * band.size.height);
  return pooled;
}

// The base band: differences of contrast against each image's own mean, without masking.
std::array<double, kOpponents> PreparedCvvdp::State::poolBase(Workspace& workspace, bool withMap) const {
  const Planes& test = workspace.levels.back();
  const double testBackground = backgroundOf(test);
  std::array<double, kOpponents> pooled{};
  for (size_t o = 0; o < kOpponents; ++o) {
    for (size_t y = 0; y < base[o].height(); ++y) {
      for (size_t x = 0; x < base[o].width(); ++x) {
        const double t = std::min(test[o].row(y)[x] / testBackground, kGreatestContrast);
        const double r = std::min(base[o].row(y)[x] / baseBackground, kGreatestContrast);
        const double difference = std::abs(t - r) * baseSensitivity[o];
        pooled[o] += offsetPower(difference, 2);
        if (withMap) workspace.differences.back()[o].row(y)[x] = static_cast<float>(difference);
      }
    }
    pooled[o] = rootMeanSquare(pooled[o], base[o].pixelCount());
  }
  return pooled;
}

// The pyramid put together again from the differences, all channels in one.
std::vector<float> PreparedCvvdp::State::differenceMap(Workspace& workspace) const {
  // The 4-norm over the channels of each sample, without the gain of the band.
  std::vector<Plane> pyramid;
  for (size_t b = 0; b < workspace.differences.size(); ++b) {
    const Planes& differences = workspace.differences[b];
    const bool isBase = b == bands.size();
    Plane& plane = pyramid.emplace_back(differences[0].width(), differences[0].height());
    for (size_t y = 0; y < plane.height(); ++y) {
      for (size_t x = 0; x < plane.width(); ++x) {
        double sum = 0;
        for (size_t o = 0; o < kOpponents; ++o) {
          const double weight = kImageIntegration * (isBase ? kBaseBandWeight[o] : 1);
          sum += offsetPower(weight * differences[o].row(y)[x], kChannelExponent);
        }
        plane.row(y)[x] = static_cast<float>(offsetPower(sum, 1 / kChannelExponent) / (isBase ? 1 : bandGain(b)));
      }
    }
  }
  // From coarse to fine: each band plus the expanded sum of all coarser ones.
  for (size_t b = bands.size(); b-- > 0;) {
    const size_t floats = halvings[b].scratchFloats();
    for (size_t y = 0; y < pyramid[b].height(); ++y) {
      float* expanded = scratchRow(1, floats);
      halvings[b].expandRow(kernels, pyramid[b + 1], y, scratchRow(0, floats), expanded);
      float* row = pyramid[b].row(y);
      for (size_t x = 0; x < pyramid[b].width(); ++x) row[x] += expanded[x];
    }
  }
  // 10 - JOD of each pixel, over 10.
  std::vector<float> map;
  for (size_t y = 0; y < pyramid[0].height(); ++y)
    for (size_t x = 0; x < pyramid[0].width(); ++x)
      map.push_back(static_cast<float>(justObjectionableDifferences(double{pyramid[0].row(y)[x]}) / 10));
  return map;
}

PreparedCvvdp::PreparedCvvdp(const Image8& reference, Isa isa) : state_(std::make_unique<State>(reference, isa)) {}
PreparedCvvdp::~PreparedCvvdp() = default;
PreparedCvvdp::PreparedCvvdp(PreparedCvvdp&&) noexcept = default;
PreparedCvvdp& PreparedCvvdp::operator=(PreparedCvvdp&&) noexcept = default;

CvvdpResult PreparedCvvdp::compare(const Image8& test, bool withMap) const {
  std::unique_ptr<Workspace> taken = state_->takeWorkspace();
  Workspace& workspace = *taken;
  // Planes of differences are made when a map is first asked for.
  if (withMap && workspace.differences.empty())
    for (const Planes& level : workspace.levels)
      workspace.differences.push_back(makePlanes({level[0].width(), level[0].height()}));

  // The test image's pyramid, then the pooled differences of each band and of the base.
  state_->makeLevels(test, workspace.levels);
  CvvdpResult result;
  for (size_t b = 0; b < state_->bands.size(); ++b) result.bands.push_back(state_->poolBand(b, workspace, withMap));
  result.bands.push_back(state_->poolBase(workspace, withMap));

  // Over bands, then over channels, by norms of high order: the worst band counts most.
  double channels = 0;
  for (size_t o = 0; o < kOpponents; ++o) {
    double sum = 0;
    for (size_t b = 0; b < result.bands.size(); ++b) {
      const bool isBase = b + 1 == result.bands.size();
      sum += offsetPower(result.bands[b][o] * (isBase ? kBaseBandWeight[o] : 1), kBandExponent);
    }
    channels += offsetPower(offsetPower(sum, 1 / kBandExponent), kChannelExponent);
  }
  result.jod = 10 - justObjectionableDifferences(kImageIntegration * offsetPower(channels, 1 / kChannelExponent));
  if (withMap) result.map = state_->differenceMap(workspace);

  // The work space goes back to the pool.
  const std::lock_guard lock(state_->poolMutex);
  state_->pool.push_back(std::move(taken));
  return result;
}

}  // namespace wavecrest
