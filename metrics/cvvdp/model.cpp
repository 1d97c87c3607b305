#include "metrics/cvvdp/model.h"

#include <algorithm>

namespace wavecrest::cvvdp {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Linear sRGB to CIE XYZ under D65.
constexpr Matrix kXyzFromRgb{
    {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};
// CIE XYZ to cone responses L, M, S.
constexpr Matrix kLmsFromXyz{{{0.187596268556126, 0.585168649077728, -0.026384263306304},
                              {-0.133397430663221, 0.405505777260049, 0.034502127690364},
                              {0.000244379021663, -0.000542995890619, 0.019406849066323}}};
// Cone responses to opponent colours: L + M, L against M, S against L + M.
constexpr Matrix kDklFromLms{{{1, 1, 0}, {1, -2.311130179947035, 0}, {-1, -1, 50.977571328718781}}};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      for (size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

// Place of a value on a grid that is uniform in the logarithm, 0 to count - 1.
double gridPlace(double value, double least, double greatest, size_t count) {
  const double last = static_cast<double>(count - 1);
  return std::clamp(std::log(value / least) / std::log(greatest / least) * last, 0.0, last);
}

// Linear interpolation of value(0) .. value(count - 1) at a place on that grid.
template <class Value>
double interpolated(double place, size_t count, Value value) {
  const size_t low = std::min(static_cast<size_t>(place), count - 2);
  const double fraction = place - static_cast<double>(low);
  return (1 - fraction) * value(low) + fraction * value(low + 1);
}

constexpr double kLeastBandFrequency = 0.2;                     // bands end with the first one at or below it
constexpr double kBaseBandFrequency = 0.1;                      // what the base band counts as
constexpr double kSecondBand = 0.3228;                          // frequency of the second band relative to the first
constexpr double kSensitivityCorrection = -0.2797423303127289;  // dB

}  // namespace

std::array<std::array<double, 3>, kOpponents> opponentFromRgb() {
  return product(kDklFromLms, product(kLmsFromXyz, kXyzFromRgb));
}

std::vector<double> bandFrequencies(size_t width, size_t height) {
  // Whole halvings of the shorter side until one pixel is left.
  const auto halvings = static_cast<size_t>(std::log2(static_cast<double>(std::min(width, height))));
  const size_t most = halvings - 1;  // bands before the base, at most
  std::vector<double> frequencies{kPixelsPerDegree / 2};
  // The first band counts as the Nyquist frequency. From the second band on, frequencies halve.
  double frequency = kSecondBand * kPixelsPerDegree / 2;
  while (frequencies.size() < most && frequencies.back() > kLeastBandFrequency) {
    frequencies.push_back(frequency);
    frequency /= 2;
  }
  frequencies.push_back(kBaseBandFrequency);
  return frequencies;
}

SensitivityCurve sensitivityCurve(size_t opponent, double frequency) {
  const double place = gridPlace(frequency, kCsfLeastFrequency, kCsfGreatestFrequency, kCsfFrequencies);
  SensitivityCurve curve{};
  for (size_t l = 0; l < kCsfLuminances; ++l) {
    curve[l] = interpolated(place, kCsfFrequencies, [&](size_t i) { return double{kLogSensitivity[opponent][l][i]}; });
  }
  return curve;
}

double sensitivity(const SensitivityCurve& curve, double luminance) {
  // Interpolation of log10 of the sensitivity over the logarithm of luminance.
  const double place = gridPlace(luminance, kCsfLeastLuminance, kCsfGreatestLuminance, kCsfLuminances);
  const double logS = interpolated(place, kCsfLuminances, [&](size_t i) { return curve[i]; });
  return std::pow(10.0, logS + kSensitivityCorrection / 20);
}

double justObjectionableDifferences(double difference) {
  constexpr double kScale = 0.0439569391310215, kExponent = 0.9302042722702026;
  // Below this, the power law continues as a straight line to zero, and its slope stays finite.
  constexpr double kLinearBelow = 0.1;
  if (difference > kLinearBelow) return kScale * std::pow(difference, kExponent);
  return kScale * std::pow(kLinearBelow, kExponent - 1) * difference;
}

}  // namespace wavecrest::cvvdp
