#include "metrics/flip_model.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace {

using Matrix3 = std::array<double, 9>;

// Linear sRGB to CIE XYZ under D65, from the chromaticities of ITU-R BT.709 as exact fractions.
constexpr Matrix3 kXyzFromRgb{
    10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,  //
    2613072.0 / 12288897,  8788810.0 / 12288897, 887015.0 / 12288897,   //
    1425312.0 / 73733382,  8788810.0 / 73733382, 70074185.0 / 73733382,
};

// Rows divided by the white point: relative XYZ.
Matrix3 relativeXyzFromRgb() {
  Matrix3 m = kXyzFromRgb;
  for (size_t row = 0; row < 3; ++row) {
    const double white = m[3 * row] + m[3 * row + 1] + m[3 * row + 2];
    for (size_t column = 0; column < 3; ++column) m[3 * row + column] /= white;
  }
  return m;
}

// Inverse of a matrix from its minors. Cyclic indices give each minor its sign.
Matrix3 inverse(const Matrix3& m) {
  const auto minor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
  };
  const double determinant = m[0] * minor(0, 0) + m[1] * minor(0, 1) + m[2] * minor(0, 2);
  Matrix3 result{};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) result[3 * c + r] = minor(r, c) / determinant;
  return result;
}

std::array<float, 9> toFloat(const Matrix3& m) {
  std::array<float, 9> result{};
  std::transform(m.begin(), m.end(), result.begin(), [](double v) { return static_cast<float>(v); });
  return result;
}

// The function f of CIELAB: a cube root with a linear part near black.
double labCurve(double t) {
  constexpr double kDelta = 6.0 / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

// Taps that one weighted sum adds up: blue-yellow is a sum of two filters.
constexpr size_t kMostSources = 256;

// Lightness, a and b of linear RGB. The Hunt adjustment multiplies a and b by 0.01 times the lightness.
std::array<double, 3> huntLab(double red, double green, double blue) {
  const Matrix3 m = relativeXyzFromRgb();
  const auto curve = [&](size_t row) { return labCurve(m[row] * red + m[row + 1] * green + m[row + 2] * blue); };
  const double fx = curve(0), fy = curve(3), fz = curve(6), lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

// The greatest difference in the gamut: between the green and the blue primary.
double largestColourDifference() {
  // The HyAB distance: absolute difference of lightness plus Euclidean distance of (a, b).
  const auto green = huntLab(0, 1, 0), blue = huntLab(0, 0, 1);
  return std::abs(green[0] - blue[0]) + std::hypot(green[1] - blue[1], green[2] - blue[2]);
}

std::vector<float> toFloat(const std::vector<double>& taps) { return {taps.begin(), taps.end()}; }

// Samples of function(i) at i = -radius .. radius.
template <class Function>
std::vector<double> sampleTaps(size_t radius, Function function) {
  std::vector<double> taps;
  for (size_t i = 0; i <= 2 * radius; ++i)
    taps.push_back(function(static_cast<double>(i) - static_cast<double>(radius)));
  return taps;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// Contrast sensitivity of the three opponent channels as sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
// degrees.
constexpr double kAchromaticB = 0.0047, kRedGreenB = 0.0053;
constexpr double kBlueYellowA1 = 34.1, kBlueYellowB1 = 0.04, kBlueYellowA2 = 13.5, kBlueYellowB2 = 0.025;

// Taps exp(-pi^2 x^2 / b) of one Gaussian, without its factor.
std::vector<double> sensitivityTaps(size_t radius, double pixelsPerDegree, double b) {
  return sampleTaps(radius, [&](double i) {
    const double x = i / pixelsPerDegree;
    return std::exp(-std::numbers::pi * std::numbers::pi * x * x / b);
  });
}

// Positive taps sum to 1, negative ones to -1.
void normalizeSigns(std::vector<double>& taps) {
  double positive = 0, negative = 0;
  for (double t : taps) (t > 0 ? positive : negative) += t;
  for (double& t : taps) t /= t > 0 ? positive : -negative;
}

void scale(std::vector<double>& taps, double factor) {
  for (double& t : taps) t *= factor;
}

}  // namespace

FlipModel::FlipModel(double pixelsPerDegree, Isa isa) : isa_(isa) {
  // The widest Gaussian sets the radius of the colour filters, at three standard deviations: exp(-pi^2 x^2 / b) has the
  // standard deviation sqrt(b / (2 pi^2)). Features are 0.082 degrees wide, two standard deviations.
  const double deviation = std::sqrt(kBlueYellowB1 / (2 * std::numbers::pi * std::numbers::pi)) * pixelsPerDegree;
  const double featureDeviation = 0.5 * 0.082 * pixelsPerDegree;
  const auto colourRadius = static_cast<size_t>(std::ceil(3 * deviation));
  const auto featureRadius = static_cast<size_t>(std::ceil(3 * featureDeviation));
  radius_ = std::max(colourRadius, featureRadius);
  if (2 * (2 * radius_ + 1) > kMostSources) {
    throw std::invalid_argument("FlipModel: too many pixels per degree; expected filters of at most 127 taps");
  }

  // Keeps a filter twice, for columns and for rows. The filter's factor goes to the row taps.
  const auto set = [&](Tap tap, size_t radius, std::vector<double> taps, double acrossFactor) {
    // Shorter filters are widened by zeros so that all share their sources.
    std::vector<double> widened(2 * radius_ + 1, 0.0);
    std::copy(taps.begin(), taps.end(), widened.begin() + static_cast<std::ptrdiff_t>(radius_ - radius));
    down_[tap] = toFloat(widened);
    scale(widened, acrossFactor);
    across_[tap] = toFloat(widened);
  };
  // Achromatic and red-green are one Gaussian each, normalised by itself.
  for (const auto& [tap, b] : {std::pair{kAchromatic, kAchromaticB}, {kRedGreen, kRedGreenB}}) {
    auto taps = sensitivityTaps(colourRadius, pixelsPerDegree, b);
    scale(taps, 1 / sum(taps));
    set(tap, colourRadius, taps, 1);
  }
  // Blue-yellow is a sum of two separable Gaussians, normalised together.
  const auto wide = sensitivityTaps(colourRadius, pixelsPerDegree, kBlueYellowB1);
  const auto narrow = sensitivityTaps(colourRadius, pixelsPerDegree, kBlueYellowB2);
  const double wideFactor = kBlueYellowA1 * std::sqrt(std::numbers::pi / kBlueYellowB1);
  const double narrowFactor = kBlueYellowA2 * std::sqrt(std::numbers::pi / kBlueYellowB2);
  const double total = wideFactor * sum(wide) * sum(wide) + narrowFactor * sum(narrow) * sum(narrow);
  set(kBlueYellow1, colourRadius, wide, wideFactor / total);
  set(kBlueYellow2, colourRadius, narrow, narrowFactor / total);

  // Edges and points: first and second derivative of a Gaussian in one direction, Gaussian in the other.
  const double variance = featureDeviation * featureDeviation;
  const auto gaussian = [&](double i) { return std::exp(-i * i / (2 * variance)); };
  auto smooth = sampleTaps(featureRadius, gaussian);
  auto edge = sampleTaps(featureRadius, [&](double i) { return -i * gaussian(i); });
  auto point = sampleTaps(featureRadius, [&](double i) { return (i * i / variance - 1) * gaussian(i); });
  scale(smooth, 1 / sum(smooth));
  normalizeSigns(edge);
  normalizeSigns(point);
  // Features are defined on relative luminance, (Y + 16) / 116; the constant vanishes in derivatives.
  for (const auto& [tap, taps] : {std::pair{kGaussian, smooth}, {kEdge, edge}, {kPoint, point}})
    set(tap, featureRadius, taps, 1.0 / 116);

  // What the kernels need: colour conversions, and the greatest colour difference raised to its exponent.
  const Matrix3 xyzFromRgb = relativeXyzFromRgb();
  xyzFromRgb_ = toFloat(xyzFromRgb);
  rgbFromXyz_ = toFloat(inverse(xyzFromRgb));
  colourMaximum_ = static_cast<float>(std::pow(largestColourDifference(), double{kFlipColourExponent}));
}

// Y, Cx and Cz are CIELAB without its cube root.
std::array<float, 3> FlipModel::opponent(double red, double green, double blue) {
  static const Matrix3 m = relativeXyzFromRgb();
  const double x = m[0] * red + m[1] * green + m[2] * blue, y = m[3] * red + m[4] * green + m[5] * blue,
               z = m[6] * red + m[7] * green + m[8] * blue;
  return {static_cast<float>(116 * y - 16), static_cast<float>(500 * (x - y)), static_cast<float>(200 * (y - z))};
}

// Rows of one task: filtered down the columns, with borders for the taps across; filtered both ways; features.
struct FlipModel::RowBuffers {
  RowBuffers(size_t width, size_t radius)
      : down(width, kTapSets, radius), across(width, kTapSets), features(width, 5) {}
  Plane down, across, features;
};

void FlipModel::analyzeRow(const Opponents& image, size_t y, const std::array<float*, 5>& out,
                           RowBuffers& buffers) const {
  const MetricKernels& kernels = metricKernels(isa_);
  const size_t width = image[0].width(), taps = 2 * radius_ + 1;
  std::array<const float*, kMostSources> sources{};

  // Down the columns; rows beyond the image repeat its edge.
  const auto filterDown = [&](const Plane& channel, std::initializer_list<Tap> filters) {
    for (size_t i = 0; i < taps; ++i) {
      const auto row = static_cast<std::ptrdiff_t>(y + i) - static_cast<std::ptrdiff_t>(radius_);
      const auto last = static_cast<std::ptrdiff_t>(channel.height()) - 1;
      sources[i] = channel.row(static_cast<size_t>(std::clamp<std::ptrdiff_t>(row, 0, last)));
    }
    std::array<const float*, kMaxFilterOutputs> weights{};
    std::array<float*, kMaxFilterOutputs> rows{};
    size_t count = 0;
    for (Tap filter : filters) {
      weights[count] = down_[filter].data();
      rows[count++] = buffers.down.row(filter);
    }
    kernels.weightedSum({sources.data(), taps, weights.data(), count, rows.data(), width});
  };
  filterDown(image[0], {kAchromatic, kGaussian, kEdge, kPoint});
  filterDown(image[1], {kRedGreen});
  filterDown(image[2], {kBlueYellow1, kBlueYellow2});
  // Each filtered row is continued by its edge samples.
  for (size_t filter = 0; filter < kTapSets; ++filter) {
    float* row = buffers.down.row(filter);
    std::fill(row - radius_, row, row[0]);
    std::fill(row + width, row + width + radius_, row[width - 1]);
  }

  // Across the rows. A result is the sum of its terms. Each term filters one of the rows that were filtered down.
  struct Term {
    Tap row, filter;
  };
  std::array<float, kMostSources> weights{};
  const auto filterAcross = [&](size_t target, std::initializer_list<Term> terms) {
    size_t count = 0;
    for (const Term& term : terms) {
      for (size_t i = 0; i < taps; ++i, ++count) {
        sources[count] = buffers.down.row(term.row) + i - radius_;
        weights[count] = across_[term.filter][i];
      }
    }
    const float* weightRow = weights.data();
    float* row = buffers.across.row(target);
    kernels.weightedSum({sources.data(), count, &weightRow, 1, &row, width});
    return row;
  };
  const float* filteredY = filterAcross(0, {{kAchromatic, kAchromatic}});
  const float* filteredCx = filterAcross(1, {{kRedGreen, kRedGreen}});
  const float* filteredCz = filterAcross(2, {{kBlueYellow1, kBlueYellow1}, {kBlueYellow2, kBlueYellow2}});
  const float* edgeX = filterAcross(3, {{kGaussian, kEdge}});
  const float* edgeY = filterAcross(4, {{kEdge, kGaussian}});
  const float* pointX = filterAcross(5, {{kGaussian, kPoint}});
  const float* pointY = filterAcross(6, {{kPoint, kGaussian}});

  // Pointwise: colours to Hunt-adjusted CIELAB, derivatives to magnitudes of edges and points.
  kernels.flipAppearanceRow({.y = filteredY,
                             .cx = filteredCx,
                             .cz = filteredCz,
                             .width = width,
                             .rgbFromXyz = rgbFromXyz_,
                             .xyzFromRgb = xyzFromRgb_,
                             .lightness = out[0],
                             .a = out[1],
                             .b = out[2]});
  kernels.flipFeatureRow({edgeX, edgeY, pointX, pointY, width, out[3], out[4]});
}

namespace {

// Calls function(begin, end) for blocks of rows, in parallel.
template <class Function>
void forEachRowBlock(size_t rows, Function function) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, rows, 16),
                    [&](const tbb::blocked_range<size_t>& range) { function(range.begin(), range.end()); });
}

// Row y of the five features of an image.
template <class PlaneArray>
FlipRow featureRow(const PlaneArray& planes, size_t y) {
  return {planes[0].row(y), planes[1].row(y), planes[2].row(y), planes[3].row(y), planes[4].row(y)};
}

}  // namespace

FlipModel::Features FlipModel::analyze(const Opponents& image) const {
  Features features;
  for (Plane& plane : features) plane = Plane(image[0].width(), image[0].height());
  forEachRowBlock(image[0].height(), [&](size_t begin, size_t end) {
    RowBuffers buffers(image[0].width(), radius_);
    for (size_t y = begin; y < end; ++y) {
      std::array<float*, 5> out{};
      for (size_t i = 0; i < out.size(); ++i) out[i] = features[i].row(y);
      analyzeRow(image, y, out, buffers);
    }
  });
  return features;
}

void FlipModel::compare(const Features& reference, const Opponents& test, Plane& map) const {
  // Features of the test image are made row by row and compared at once; no plane of them is stored.
  const size_t width = map.width();
  forEachRowBlock(map.height(), [&](size_t begin, size_t end) {
    RowBuffers buffers(width, radius_);
    std::array<float*, 5> out{};
    for (size_t i = 0; i < out.size(); ++i) out[i] = buffers.features.row(i);
    for (size_t y = begin; y < end; ++y) {
      analyzeRow(test, y, out, buffers);
      metricKernels(isa_).flipErrorRow({.reference = featureRow(reference, y),
                                        .test = {out[0], out[1], out[2], out[3], out[4]},
                                        .width = width,
                                        .colourMaximum = colourMaximum_,
                                        .error = map.row(y)});
    }
  });
}

}  // namespace wavecrest
