#include "bench/live/block_sample.h"

#include <algorithm>
#include <cmath>

namespace wavecrest {
namespace {

constexpr size_t kSide = BlockSample::kWidth;

// Fractional part of i times the golden ratio's inverse: any run of consecutive i is spread evenly over [0, 1).
double goldenStep(size_t i) {
  const double x = static_cast<double>(i) * 0.6180339887498949;
  return x - std::floor(x);
}

}  // namespace

BlockSample::BlockSample(size_t width, size_t height, size_t most)
    : width_(width), filmBlocks_((width / kSide) * (height / kSide)) {
  const size_t across = width / kSide, down = height / kSide;
  const auto add = [&](size_t column, size_t row) { blocks_.push_back(row * kSide * width + column * kSide); };
  if (filmBlocks_ <= most) {
    for (size_t row = 0; row < down; ++row) {
      for (size_t column = 0; column < across; ++column) add(column, row);
    }
    return;
  }
  // One block in each of `most` equal stretches of the blocks in reading order, at a place that differs from stretch to
  // stretch, so that no column of the film is preferred.
  for (size_t i = 0; i < most; ++i) {
    const double at = (static_cast<double>(i) + goldenStep(i)) * static_cast<double>(filmBlocks_);
    const size_t block = std::min(static_cast<size_t>(at / static_cast<double>(most)), filmBlocks_ - 1);
    add(block % across, block / across);
  }
}

std::vector<float> BlockSample::take(std::span<const float> film) const {
  std::vector<float> taken;
  taken.reserve(blocks_.size() * kSide * kSide * 3);
  for (const size_t corner : blocks_) {
    for (size_t row = 0; row < kSide; ++row) {
      const auto begin = film.subspan(3 * (corner + row * width_), 3 * kSide);
      taken.insert(taken.end(), begin.begin(), begin.end());
    }
  }
  return taken;
}

}  // namespace wavecrest
