#include "bench/recommend/prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "engine/film/pixel_blocks.h"
#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

constexpr double kSignificant = 4;  // standard errors; of thousands of blocks hardly one is above by chance
constexpr int kBisections = 14;     // of the logarithm of time, over nine decades: to a part in a thousand
constexpr double kFirstSeconds = 1e-2;
constexpr int kWindow = 3;  // a window of 7 x 7 pixels, about that of SSIM

// What no sample of the noise tells: rare paths that a pilot has not met, and a speed that changes. Natural logarithm
// of time, at the pilot's own time and for each factor e beyond it. Chosen so that the intervals of
// bench/recommend/judge hold the times of nine scenes.
constexpr double kModelError = 0.15, kModelErrorPerE = 0.06;

// Merging blurs within blocks as well, and what is not significant is not seen. A radius that balances bias and noise
// makes the time of methods that merge alone longer by about this factor, at most by its square: 1.2 to 1.5 in the four
// scenes in which bench/recommend/judge saw ppm advised.
constexpr double kUnseenBias = 1.25;

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

Image meanOf(const Pilot& pilot) { return combined(pilot, {1, 1, 1, 1}); }

NoiseSamples noisesOf(const Pilot& pilot) {
  NoiseSamples noises;
  for (size_t i = 0; i < noises.size(); ++i) noises[i] = combined(pilot, kContrasts[i]);
  return noises;
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

// The variance that three samples of noise give one value of an image.
double varianceAt(const NoiseSamples& noises, size_t i) {
  double sum = 0;
  for (const Image& noise : noises) sum += std::pow(static_cast<double>(noise.pixels[i]), 2);
  return sum / 3;
}

// How many times the variance of the sum over a block is what it would be if its pixels were independent, at least 1.
// Pixels share photons; with every filter but a box they also share samples. It is estimated from all blocks of the
// image together, as a single block has only three samples of noise.
double varianceFactor(const NoiseSamples& noises) {
  double ofSums = 0, ofSamples = 0;
  forEachBlock(noises.front(), [&](const std::vector<size_t>& samples) {
    for (const Image& noise : noises) {
      double sum = 0;
      for (const size_t i : samples) {
        const auto value = static_cast<double>(noise.pixels[i]);
        sum += value;
        ofSamples += value * value;
      }
      ofSums += sum * sum;
    }
  });
  return ofSamples > 0 ? std::max(ofSums / ofSamples, 1.0) : 1;
}

// Mean minus reference, averaged over each block, where that is more than noise of either explains; zero elsewhere.
Image significantBias(const Image& mean, const NoiseSamples& noises, const PilotReference& reference) {
  const double factor = varianceFactor(noises), referenceFactor = varianceFactor(reference.noises);
  Image bias = mean;
  forEachBlock(mean, [&](const std::vector<size_t>& samples) {
    // Difference of the sums over the block, and the variance that noise gives it.
    double difference = 0, variance = 0;
    for (const size_t i : samples) {
      difference += static_cast<double>(mean.pixels[i]) - static_cast<double>(reference.mean.pixels[i]);
      variance += factor * varianceAt(noises, i) + referenceFactor * varianceAt(reference.noises, i);
    }
    const bool significant = std::abs(difference) > kSignificant * std::sqrt(variance);
    const double value = significant ? difference / static_cast<double>(samples.size()) : 0;
    for (const size_t i : samples) bias.pixels[i] = static_cast<float>(value);
  });
  return bias;
}

double encoded(double linear) { return srgbEncode(std::clamp(linear, 0.0, 1.0)); }

// The mean of four images with a part of its local variance taken away: of the noise's share. power: 0.5 leaves the
// variance that the truth has, 1 is Wiener's filter. Works on codes, as SSIM does; what is too bright for them stays.
Image withLessNoise(const Image& mean, const NoiseSamples& noises, double power) {
  const size_t count = mean.pixels.size();
  std::vector<double> codes(count), noise(count, 0.0);
  for (size_t i = 0; i < count; ++i) {
    const double value = mean.pixels[i];
    codes[i] = encoded(value);
    for (const Image& sample : noises) {
      const double off = static_cast<double>(sample.pixels[i]);
      noise[i] += std::pow(0.5 * (encoded(value + off) - encoded(value - off)), 2) / 3;
    }
  }
  Image out = mean;
  const int width = static_cast<int>(mean.width), height = static_cast<int>(mean.height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        const auto at = [&](int column, int row) {
          return 3 * (static_cast<size_t>(row) * mean.width + static_cast<size_t>(column)) +
                 static_cast<size_t>(channel);
        };
        // Mean and variance of the window, and how much of the latter is noise.
        double sum = 0, squares = 0, variance = 0, n = 0;
        for (int row = std::max(0, y - kWindow); row <= std::min(height - 1, y + kWindow); ++row) {
          for (int column = std::max(0, x - kWindow); column <= std::min(width - 1, x + kWindow); ++column) {
            const size_t i = at(column, row);
            sum += codes[i];
            squares += codes[i] * codes[i];
            variance += noise[i];
            ++n;
          }
        }
        const double middle = sum / n, all = std::max(squares / n - middle * middle, 0.0);
        const double gain = all > 0 ? std::pow(std::max(all - variance / n, 0.0) / all, power) : 1;
        const size_t i = at(x, y);
        if (codes[i] < 1) out.pixels[i] = static_cast<float>(srgbDecode(middle + gain * (codes[i] - middle)));
      }
    }
  }
  return out;
}

PreparedReference prepared(const char* name, Image image) {
  return PreparedReference(name, {std::move(image), Encoding::linear, {}});
}

double ssimOf(const PreparedReference& reference, Image image) {
  const ComparedImage test = reference.prepareTest("prediction", {std::move(image), Encoding::linear, {}});
  return reference.ssim().compare(test.codes).mean;
}

// What 1 - SSIM is on average with these samples of noise, times a factor, added to the reference.
double meanLoss(const PreparedReference& reference, std::span<const Image> noises, double factor) {
  double sum = 0;
  for (const Image& noise : noises) {
    Image image = linearLight(reference.image().file);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += static_cast<float>(factor * noise.pixels[i]);
    sum += 1 - ssimOf(reference, std::move(image));
  }
  return sum / static_cast<double>(noises.size());
}

// With twice the samples, noise of a smaller amplitude lies on more pixels. Logarithm of the factor by which that makes
// up for amplitude, in the eyes of SSIM: noise of two parts, shrunken to the amplitude of four, is compared with that
// of four. 0 for noise that is alike everywhere.
double spreadOf(const PreparedReference& reference, const Pilot& pilot, const NoiseSamples& ofFour) {
  constexpr double kStep = 1.2, kLeastLoss = 1e-5, kMost = 0.3;
  std::array<Image, 2> ofTwo{pilot.parts[0], pilot.parts[2]};
  for (size_t pair = 0; pair < 2; ++pair) {
    const Image& other = pilot.parts[2 * pair + 1];
    for (size_t i = 0; i < other.pixels.size(); ++i) {
      float& value = ofTwo[pair].pixels[i];
      value = static_cast<float>((static_cast<double>(value) - static_cast<double>(other.pixels[i])) / std::sqrt(8));
    }
  }
  const double two = meanLoss(reference, ofTwo, 1), more = meanLoss(reference, ofTwo, kStep);
  const double four = meanLoss(reference, ofFour, 1);
  if (two < kLeastLoss || more <= two) return 0;
  return std::clamp(std::log(four / two) * std::log(kStep) / std::log(more / two), 0.0, kMost);
}

// SSIM of the image as it will be.
class Future {
 public:
  Future(const PreparedReference& reference, const Pilot& pilot, const Image& bias, const Image& noise, double spread)
      : reference_(reference), pilot_(pilot), bias_(bias), noise_(noise), spread_(spread) {}

  // SSIM after so many seconds. Noise that spreads does so as excess kurtosis falls, with the inverse of time: as much
  // is to come as was between two parts and four. Noise and bias fall with their own powers from what a part of the
  // pilot has. The mean of its four parts has the bias of one, and half the noise.
  double ssimAt(double seconds) const {
    const double times = 0.25 * pilot_.seconds / seconds;
    const double spread = std::exp(spread_ * std::max(0.0, 1 - pilot_.seconds / seconds));
    const double noise = 2 * spread * std::pow(times, pilot_.noiseExponent);
    const double bias = std::pow(times, pilot_.biasExponent);
    Image image = linearLight(reference_.image().file);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      image.pixels[i] += static_cast<float>(bias * bias_.pixels[i] + noise * noise_.pixels[i]);
    }
    return ssimOf(reference_, std::move(image));
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
  const double spread_;
};

// The interval of a time that three samples of the noise gave, by Student's t with two degrees of freedom over their
// logarithms.
Interval ofThree(double meanLogarithm, double meanSquare) {
  constexpr double kStudent = 4.303;
  static_assert(kIntervalLevel == 0.95);
  // deviation is the standard error of the mean of three logarithms.
  const double deviation = std::sqrt(std::max(meanSquare - meanLogarithm * meanLogarithm, 0.0) / 2);
  return {std::exp(meanLogarithm - kStudent * deviation), std::exp(meanLogarithm + kStudent * deviation)};
}

}  // namespace

PilotReference::PilotReference(const Pilot& pilot)
    : mean(meanOf(pilot)),
      noises(noisesOf(pilot)),
      noisy(prepared("reference", mean)),
      likely(prepared("reference", withLessNoise(mean, noises, 0.5))),
      smooth(prepared("reference", withLessNoise(mean, noises, 1))) {
  Image again = mean;
  for (size_t i = 0; i < again.pixels.size(); ++i) again.pixels[i] += noises[0].pixels[i];
  ssim = ssimOf(noisy, std::move(again));
}

Prediction predict(const PilotReference& reference, const Pilot& pilot, double targetSsim) {
  // Mean, noise and bias of the pilot.
  const Image mean = meanOf(pilot);
  const NoiseSamples noises = noisesOf(pilot);
  Image bias = mean;
  if (pilot.biased) {
    bias = significantBias(mean, noises, reference);
  } else {
    std::fill(bias.pixels.begin(), bias.pixels.end(), 0.0f);
  }
  // SSIM of the pilot, and what is left of bias after kLongestSeconds.
  Prediction result;
  result.ssimNow = ssimOf(reference.noisy, mean);
  result.ssimLimit = Future(reference.likely, pilot, bias, noises[0], 0).ssimAt(kLongestSeconds);
  // Seconds until the target with each sample of the noise. The target must be reached with every sample.
  double sum = 0, squares = 0;
  for (const Image& noise : noises) {
    const std::optional<double> seconds = Future(reference.likely, pilot, bias, noise, 0).secondsUntil(targetSsim);
    if (!seconds) return result;
    sum += std::log(*seconds) / 3;
    squares += std::pow(std::log(*seconds), 2) / 3;
  }
  result.seconds = std::exp(sum);
  result.interval = ofThree(sum, squares);
  // The other readings of the reference.
  const auto reading = [&](const PreparedReference& other, double spread) {
    return Future(other, pilot, bias, noises[0], spread)
        .secondsUntil(targetSsim)
        .value_or(std::numeric_limits<double>::infinity());
  };
  const double early = reading(reference.noisy, 0),
               late = reading(reference.smooth, spreadOf(reference.likely, pilot, noises));
  const double beyond = std::max(std::log(*result.seconds / pilot.seconds), 0.0);
  const double model = std::exp(kModelError + kModelErrorPerE * beyond);
  result.interval.low = std::min({result.interval.low, early, late}) / model + pilot.onceSeconds;
  const double unseen = pilot.biasExponent > 0 && pilot.noiseExponent < 0.5 ? kUnseenBias : 1;
  result.interval.high = std::max({result.interval.high, early, late}) * model * unseen * unseen + pilot.onceSeconds;
  *result.seconds = *result.seconds * unseen + pilot.onceSeconds;
  return result;
}

}  // namespace wavecrest
