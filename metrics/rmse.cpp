#include "metrics/rmse.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace wavecrest {
namespace {

// Of one row: squared differences summed up by channel, and the number of excluded pixels.
struct RowSums {
  std::array<double, 3> squares{};
  uint64_t excluded = 0;
};

// Sums rows in parallel and adds the rows in order. value(image, i) gives sample i of an image as a double.
template <class AnyImage, class Value>
double rmseOf(const AnyImage& reference, const AnyImage& test, Value value) {
  std::vector<RowSums> rows(reference.height);
  tbb::parallel_for(size_t{0}, rows.size(), [&](size_t y) {
    const size_t begin = y * reference.width * 3, end = begin + size_t{reference.width} * 3;
    for (size_t i = begin; i < end; i += 3) {
      std::array<double, 3> squares{};
      for (size_t c = 0; c < 3; ++c) {
        const double difference = value(test, i + c) - value(reference, i + c);
        squares[c] = difference * difference;
      }
      // inf - inf is NaN, so one test of the sum finds every non-finite sample. Squares of differences of floats do not
      // overflow a double.
      if (!std::isfinite(squares[0] + squares[1] + squares[2])) {
        ++rows[y].excluded;
      } else {
        for (size_t c = 0; c < 3; ++c) rows[y].squares[c] += squares[c];
      }
    }
  });
  RowSums sum;
  for (const RowSums& row : rows) {
    for (size_t c = 0; c < 3; ++c) sum.squares[c] += row.squares[c];
    sum.excluded += row.excluded;
  }
  // Means over the pixels that are not excluded. Without any such pixel they are 0 / 0, NaN.
  const auto count = static_cast<double>(reference.pixelCount() - sum.excluded);
  return std::sqrt((sum.squares[0] + sum.squares[1] + sum.squares[2]) / (3 * count));
}

// Mean over channels of the error of each pixel. error(r, difference) is that of a sample.
template <class Error>
std::vector<double> pixelErrors(const Image& reference, const Image& test, Error error) {
  std::vector<double> errors(reference.pixelCount());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, errors.size()), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
      double sum = 0;
      for (size_t i = pixel * 3; i < pixel * 3 + 3; ++i) {
        const double r = reference.pixels[i];
        sum += error(r, test.pixels[i] - r);
      }
      errors[pixel] = sum / 3;
    }
  });
  return errors;
}

}  // namespace

double rmse(const Image& reference, const Image& test) {
  return rmseOf(reference, test, [](const Image& image, size_t i) { return double{image.pixels[i]}; });
}

double rmse(const Image8& reference, const Image8& test) {
  return rmseOf(reference, test, [](const Image8& image, size_t i) { return image.pixels[i] / 255.0; });
}

RelmseResult relmse(const Image& reference, const Image& test, const RelmseSettings& settings) {
  std::vector<double> errors = pixelErrors(reference, test, [&](double r, double difference) {
    return difference * difference / (r * r + settings.epsilon);
  });
  RelmseResult result;
  // Pixels that are not finite are excluded.
  const auto finiteEnd = std::remove_if(errors.begin(), errors.end(), [](double e) { return !std::isfinite(e); });
  errors.erase(finiteEnd, errors.end());

  // Both means from one order: the part below the cut, then the worst pixels.
  const auto worst = static_cast<size_t>(kTrimmedFraction * static_cast<double>(errors.size()));
  const auto cut = errors.end() - static_cast<std::ptrdiff_t>(worst);
  if (worst > 0) std::nth_element(errors.begin(), cut, errors.end());
  const double kept = std::accumulate(errors.begin(), cut, 0.0);
  result.trimmed = kept / static_cast<double>(errors.size() - worst);
  result.relmse = std::accumulate(cut, errors.end(), kept) / static_cast<double>(errors.size());
  return result;
}

double mape(const Image& reference, const Image& test) {
  double sum = 0, count = 0;
  for (const double error : pixelErrors(reference, test, [](double r, double difference) {
         return std::abs(difference) / (std::abs(r) + kMapeEpsilon);
       })) {
    if (!std::isfinite(error)) continue;
    sum += error;
    ++count;
  }
  return sum / count;
}

}  // namespace wavecrest
