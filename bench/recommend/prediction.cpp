#include "bench/recommend/prediction.h"

#include <algorithm>
#include <cmath>

#include "bench/pixel_blocks.h"

namespace wavecrest {
namespace {

constexpr double kSignificant = 4;  // standard errors; of thousands of blocks hardly one is above by chance
constexpr int kBisections = 24;     // of the logarithm of time, over nine decades: to a few parts in a million
constexpr double kFirstSeconds = 1e-2;

// Signs of the four parts in each of the three independent samples of their mean's noise.
constexpr std::array<std::array<int, 4>, 3> kContrasts{{{1, 1, -1, -1}, {1, -1, 1, -1}, {1, -1, -1, 1}}};

// A quarter of the sum of the parts with these signs: their mean, or a sample of the mean's noise.
Image combined(const Pilot& pilot, const std::array<int, 4>& signs) {
  Image image = pilot.parts[0];
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    double sum = 0;
    for (size_t part = 0; part < 4; ++part) sum += signs[part] * static_cast<double>(pilot.parts[part].pixels[i]);
    image.pixels[i] = static_cast<float>(0.25 * sum);
  }
  return image;
}

// Calls visit with the indices of the samples of each block and channel.
template <class Visit>
void forEachBlock(const Image& image, Visit&& visit) {
  constexpr uint32_t kSide = PixelBlocks::kSide;
  std::vector<size_t> samples;
  for (uint32_t y0 = 0; y0 < image.height; y0 += kSide) {
    for (uint32_t x0 = 0; x0 < image.width; x0 += kSide) {
      for (uint32_t channel = 0; channel < 3; ++channel) {
        samples.clear();
        for (uint32_t y = y0; y < std::min(y0 + kSide, image.height); ++y) {
          for (uint32_t x = x0; x < std::min(x0 + kSide, image.width); ++x) {
            samples.push_back(3 * (size_t{y} * image.width + x) + channel);
          }
        }
        visit(samples);
      }
    }
  }
}

// Mean minus reference, averaged over each block, where that is more than noise of either explains; zero elsewhere.
Image significantBias(const Image& mean, const Image& reference, const std::array<Image, 3>& noises,
                      const Image& referenceNoise) {
  Image bias = mean;
  forEachBlock(mean, [&](const std::vector<size_t>& samples) {
    // Difference of the sums over the block, and the variance that noise gives it.
    double difference = 0, variance = 0;
    for (const size_t i : samples) {
      difference += static_cast<double>(mean.pixels[i]) - static_cast<double>(reference.pixels[i]);
      for (const Image& noise : noises) variance += std::pow(static_cast<double>(noise.pixels[i]), 2) / 3;
      variance += std::pow(static_cast<double>(referenceNoise.pixels[i]), 2);
    }
    const bool significant = std::abs(difference) > kSignificant * std::sqrt(variance);
    const double value = significant ? difference / static_cast<double>(samples.size()) : 0;
    for (const size_t i : samples) bias.pixels[i] = static_cast<float>(value);
  });
  return bias;
}

// SSIM of the image as it will be.
class Future {
 public:
  Future(const PreparedReference& reference, const Pilot& pilot, const Image& bias, const Image& noise)
      : reference_(reference), pilot_(pilot), bias_(bias), noise_(noise) {}

  // SSIM after so many seconds: noise and bias fall with their own powers from what a part of the pilot has. The mean
  // of its four parts has the bias of one, and half the noise.
  double ssimAt(double seconds) const {
    const double times = 0.25 * pilot_.seconds / seconds;
    const double noise = 2 * std::pow(times, pilot_.noiseExponent), bias = std::pow(times, pilot_.biasExponent);
    Image image = linearLight(reference_.image().file);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      image.pixels[i] += static_cast<float>(bias * bias_.pixels[i] + noise * noise_.pixels[i]);
    }
    const ComparedImage test = reference_.prepareTest("prediction", {std::move(image), Encoding::linear, {}});
    return reference_.ssim().compare(test.codes).mean;
  }

  // Seconds until the target, by bisection, as SSIM grows with time; nothing beyond kLongestSeconds.
  std::optional<double> secondsUntil(double target) const {
    double low = std::log(kFirstSeconds), high = std::log(kLongestSeconds);
    if (ssimAt(kLongestSeconds) < target) return std::nullopt;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (ssimAt(std::exp(middle)) < target ? low : high) = middle;
    }
    return std::exp(high);
  }

 private:
  const PreparedReference& reference_;
  const Pilot& pilot_;
  const Image &bias_, &noise_;
};

}  // namespace

Prediction predict(const PreparedReference& reference, const Image& referenceNoise, const Pilot& pilot,
                   double targetSsim) {
  // Mean, noise and bias of the pilot.
  const Image truth = linearLight(reference.image().file);
  const Image mean = combined(pilot, {1, 1, 1, 1});
  std::array<Image, 3> noises;
  for (size_t i = 0; i < noises.size(); ++i) noises[i] = combined(pilot, kContrasts[i]);
  const Image bias = significantBias(mean, truth, noises, referenceNoise);

  // SSIM of the pilot, and what is left of bias after kLongestSeconds.
  Prediction result;
  const ComparedImage now = reference.prepareTest("pilot", {mean, Encoding::linear, {}});
  result.ssimNow = reference.ssim().compare(now.codes).mean;
  result.ssimLimit = Future(reference, pilot, bias, noises[0]).ssimAt(kLongestSeconds);
  // Seconds until the target with each sample of the noise. The target must be reached with every sample.
  double sum = 0, squares = 0;
  for (const Image& noise : noises) {
    const std::optional<double> seconds = Future(reference, pilot, bias, noise).secondsUntil(targetSsim);
    if (!seconds) return result;
    sum += std::log(*seconds);
    squares += std::pow(std::log(*seconds), 2);
  }
  // Student's t with two degrees of freedom, over the logarithms of three times.
  constexpr double kStudent = 4.303;
  static_assert(kIntervalLevel == 0.95);
  // deviation is the standard error of the mean of three logarithms.
  const double middle = sum / 3, deviation = std::sqrt(std::max(squares / 3 - middle * middle, 0.0) / 2);
  result.seconds = std::exp(middle);
  result.interval = {std::exp(middle - kStudent * deviation), std::exp(middle + kStudent * deviation)};
  return result;
}

}  // namespace wavecrest
