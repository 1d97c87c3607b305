#include "bench/until/film_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "bench/statistics/bands.h"
#include "engine/film/pixel_blocks.h"

namespace wavecrest {
namespace {

// Of the squared error, relative to it: beyond, neither its distribution nor the interval's ends mean much.
constexpr double kMostDeviation = 0.5;
// U has longer tails than Student's distribution where few pixels carry the error, and who stops at the first interval
// below a goal picks one that is low by chance. This factor makes up for both: tests/bench/until/film_error_test.cpp.
constexpr double kWidening = 1.4;

std::vector<float> meanFilm(std::span<const std::vector<float>> slices) {
  std::vector<float> mean(slices.front().size());
  for (size_t i = 0; i < mean.size(); ++i) {
    double sum = 0;
    for (const std::vector<float>& slice : slices) sum += slice[i];
    mean[i] = static_cast<float>(sum / static_cast<double>(slices.size()));
  }
  return mean;
}

// Weighted means <x_j - m, x_k - m> of all pairs of slices, m being their mean.
class Products {
 public:
  Products(std::span<const std::vector<float>> slices, size_t width) : count_(slices.size()), values_(count_ * count_) {
    const std::vector<float> mean = meanFilm(slices), weights = errorWeights(mean, width);
    const auto samples = static_cast<double>(mean.size());
    for (size_t j = 0; j < count_; ++j) {
      for (size_t k = j; k < count_; ++k) {
        double sum = 0;
        for (size_t i = 0; i < mean.size(); ++i) {
          sum += double{weights[i]} * double{slices[j][i] - mean[i]} * double{slices[k][i] - mean[i]};
        }
        values_[j * count_ + k] = values_[k * count_ + j] = sum / samples;
      }
    }
  }
  size_t count() const { return count_; }
  double operator()(size_t j, size_t k) const { return values_[j * count_ + k]; }

 private:
  size_t count_;
  std::vector<double> values_;
};

// E <d_j, d_k>^2 of different slices: a quarter of the mean squared contrast of four. For each pair a, b the contrasts
// with all c, d are the differences of u_c = <x_a - x_b, x_c>, so their mean square is twice the variance of u.
double squaredCrossProduct(const Products& products) {
  double sum = 0;
  const size_t count = products.count();
  const auto others = static_cast<double>(count - 2);
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b) {
      // Mean of u over all other slices, and squared distances from the mean.
      double mean = 0, square = 0;
      for (size_t c = 0; c < count; ++c) {
        if (c != a && c != b) mean += (products(a, c) - products(b, c)) / others;
      }
      for (size_t c = 0; c < count; ++c) {
        const double off = products(a, c) - products(b, c) - mean;
        if (c != a && c != b) square += off * off;
      }
      sum += 2 * square / (others - 1);
    }
  }
  return 0.25 * sum / (0.5 * static_cast<double>(count * (count - 1)));
}

}  // namespace

bool isBlack(std::span<const float> film) {
  return std::ranges::none_of(film, [](float value) { return value > 0; });
}

std::vector<float> errorWeights(std::span<const float> film, size_t width) {
  const PixelBlocks blocks = PixelBlocks::of(film.size(), width);
  std::vector<double> sums(blocks.count()), counts(blocks.count());
  double all = 0;
  for (size_t i = 0; i < film.size(); ++i) {
    const double value = std::max(film[i], 0.0f);
    const size_t block = blocks.ofSample(i);
    sums[block] += value;
    ++counts[block];
    all += value;
  }
  const double darkest = kDarkest * all / static_cast<double>(film.size());
  std::vector<float> weights(film.size());
  for (size_t i = 0; i < film.size(); ++i) {
    const size_t block = blocks.ofSample(i);
    const double brightness = std::max(sums[block] / counts[block], darkest);
    weights[i] = static_cast<float>(brightness > 0 ? 1 / (brightness * brightness) : 0);
  }
  return weights;
}

double relativeFilmError(std::span<const float> film, std::span<const float> expectation, size_t width) {
  assert(film.size() == expectation.size());
  const std::vector<float> weights = errorWeights(film, width);
  double sum = 0;
  for (size_t i = 0; i < film.size(); ++i) {
    sum += double{weights[i]} * std::pow(double{film[i]} - double{expectation[i]}, 2);
  }
  return std::sqrt(sum / static_cast<double>(film.size()));
}

std::optional<FilmError> estimateFilmError(std::span<const std::vector<float>> slices, size_t width) {
  if (slices.size() < kFewestSlices || std::ranges::all_of(slices, isBlack)) return std::nullopt;
  const Products products(slices, width);
  const auto count = static_cast<double>(slices.size()), pairs = count * (count - 1);
  double squaredError = 0;  // V
  for (size_t k = 0; k < slices.size(); ++k) squaredError += products(k, k) / pairs;
  const double value = std::sqrt(squaredError);
  if (value <= kNoVariance) return FilmError{.value = value, .interval = {value, value}};
  // U is the mean of pairs / 2 different products <d_j, d_k>, which are uncorrelated.
  const double deviation = std::sqrt(2 / pairs * squaredCrossProduct(products)) / squaredError;  // of U / V
  // Where one slice alone has found something, no two of them tell how often that is.
  if (!(deviation > 0 && deviation <= kMostDeviation)) return std::nullopt;
  // Of the products of K slices, K (K - 3) / 2 are free of their mean. The root halves the logarithm's deviation.
  const double margin = std::exp(0.5 * kWidening * studentQuantile(0.5 * count * (count - 3)) * deviation);
  return FilmError{.value = value, .interval = {value / margin, value * margin}};
}

void FilmSlices::add(std::vector<float> film) {
  assert(film_.empty() || film.size() == film_.size());
  // The film is the mean of all slices.
  const auto before = static_cast<double>(slices_.size());
  std::vector<float>& slice = slices_.emplace_back(film.size());
  for (size_t i = 0; i < film.size(); ++i) {
    const double earlier = film_.empty() ? 0 : before * double{film_[i]};
    slice[i] = static_cast<float>((before + 1) * double{film[i]} - earlier);
  }
  film_ = std::move(film);
  if (slices_.size() < 2 * kFewestSlices) return;
  // Neighbours are joined: half as many slices of twice the iterations.
  for (size_t k = 0; k < kFewestSlices; ++k) {
    for (size_t i = 0; i < film_.size(); ++i) {
      slices_[k][i] = 0.5f * (slices_[2 * k][i] + slices_[2 * k + 1][i]);
    }
  }
  slices_.resize(kFewestSlices);
  sliceIterations_ *= 2;
}

}  // namespace wavecrest
