#include "bench/score/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/film/pixel_blocks.h"
#include "metrics/image/srgb.h"
#include "metrics/ssim.h"

namespace wavecrest {
namespace {

// Deviations of darker blocks are relative to this part of the mean over all blocks.
constexpr double kDarkBlock = 0.01;

// The mean of each block of a map that has one value per pixel.
std::vector<double> meansOfBlocks(const std::vector<float>& map, uint32_t width) {
  const size_t pixels = map.size();
  const PixelBlocks blocks = PixelBlocks::of(3 * pixels, width);
  std::vector<double> sums(blocks.count()), counts(blocks.count());
  for (size_t i = 0; i < pixels; ++i) {
    const size_t block = blocks.ofSample(3 * i);
    sums[block] += map[i];
    ++counts[block];
  }
  for (size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

double meanOf(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// |own - expected| / scale; infinite where that is no number.
double relativeOff(double own, double expected, double scale) {
  if (own == expected) return 0;
  const double off = std::abs(own - expected) / scale;
  return std::isfinite(off) ? off : std::numeric_limits<double>::infinity();
}

constexpr PictureTolerance kTolerance{
    .ssim = 0.995, .worstBlockSsim = 0.92, .meanOff = 0.003, .worstBlockMeanOff = 0.06};
constexpr PictureTolerance kChainTolerance{
    .ssim = 0.97, .worstBlockSsim = 0.85, .meanOff = 0.003, .worstBlockMeanOff = 0.15};

}  // namespace

Image reduced(const Image& film, uint32_t width) {
  const uint32_t side = film.width / width;
  if (side <= 1) return film;
  Image small{.width = width, .height = film.height / side, .channels = 3, .pixels = {}};
  small.pixels.resize(size_t{3} * small.width * small.height);
  const float scale = 1.0f / static_cast<float>(side * side);
  for (uint32_t y = 0; y < small.height * side; ++y) {
    for (uint32_t x = 0; x < small.width * side; ++x) {
      for (uint32_t channel = 0; channel < 3; ++channel) {
        const size_t to = 3 * (size_t{y / side} * small.width + x / side) + channel;
        small.pixels[to] += scale * film.pixels[3 * (size_t{y} * film.width + x) + channel];
      }
    }
  }
  return small;
}

ScorePicture pictureOf(const Image& film) {
  assert(film.width % kPictureWidth == 0 && film.width / kPictureWidth == film.height / kPictureHeight);
  const Image small = reduced(film, kPictureWidth);
  // Light of each pixel, summed over channels.
  std::vector<float> light(small.pixelCount());
  for (size_t i = 0; i < light.size(); ++i) {
    light[i] = small.pixels[3 * i] + small.pixels[3 * i + 1] + small.pixels[3 * i + 2];
  }
  const std::vector<double> means = meansOfBlocks(light, small.width);
  return {.codes = encodeSrgb8(small), .blockMeans = {means.begin(), means.end()}};
}

PictureDifference differenceOf(const ScorePicture& own, const ScorePicture& expected) {
  PictureDifference difference;
  // Structure: SSIM of the sRGB pixels.
  const SsimResult ssim = PreparedSsim(expected.codes).compare(own.codes, true);
  difference.ssim = ssim.mean;
  const std::vector<double> blocks = meansOfBlocks(ssim.map, expected.codes.width);
  difference.worstBlockSsim = *std::min_element(blocks.begin(), blocks.end());
  // Brightness. The mean of all blocks is the mean of the image, as all blocks have the same size.
  const double mean = meanOf(expected.blockMeans);
  difference.meanOff = relativeOff(meanOf(own.blockMeans), mean, mean);
  for (size_t i = 0; i < own.blockMeans.size(); ++i) {
    const double block = expected.blockMeans[i];
    const double off = relativeOff(own.blockMeans[i], block, std::max(block, kDarkBlock * mean));
    difference.worstBlockMeanOff = std::max(difference.worstBlockMeanOff, off);
  }
  return difference;
}

PictureTolerance toleranceOf(Method method) { return method == Method::mlt ? kChainTolerance : kTolerance; }

bool isWithin(const PictureDifference& difference, const PictureTolerance& tolerance) {
  return difference.ssim >= tolerance.ssim && difference.worstBlockSsim >= tolerance.worstBlockSsim &&
         difference.meanOff <= tolerance.meanOff && difference.worstBlockMeanOff <= tolerance.worstBlockMeanOff;
}

std::string toText(const PictureDifference& d) {
  return fmt::format("worst block: SSIM {:.4f}, mean off by {:.2g} %; image: SSIM {:.4f}, mean off by {:.2g} %",
                     d.worstBlockSsim, 100 * d.worstBlockMeanOff, d.ssim, 100 * d.meanOff);
}

std::string whatExceeds(const PictureDifference& difference, const PictureTolerance& tolerance) {
  std::string text;
  const auto add = [&](const std::string& one) { text += (text.empty() ? "" : "; ") + one; };
  const auto ssim = [&](const char* of, double value, double least) {
    if (!(value >= least)) add(fmt::format("{}: SSIM {:.4f}, at least {:g}", of, value, least));
  };
  const auto mean = [&](const char* of, double off, double most) {
    if (!(off <= most)) add(fmt::format("{}: mean off by {:.2g} %, at most {:g} %", of, 100 * off, 100 * most));
  };
  ssim("worst block", difference.worstBlockSsim, tolerance.worstBlockSsim);
  mean("worst block", difference.worstBlockMeanOff, tolerance.worstBlockMeanOff);
  ssim("image", difference.ssim, tolerance.ssim);
  mean("image", difference.meanOff, tolerance.meanOff);
  return text;
}

}  // namespace wavecrest
