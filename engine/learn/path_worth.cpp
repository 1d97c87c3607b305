#include "engine/learn/path_worth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/learn/integer_sums.h"

namespace wavecrest {
namespace {

// A record stands for at most 20 paths, so it adds less than 2^45 to the squares and less than 2^13 to the count. A
// block has 2^20 first vertices, or one for each pixel, at most 2^28: the squares reach kSumLimit at a mean square of
// 2^34, more than kMostWorth allows, or 2^26.
constexpr int kSquareBits = 8;
constexpr float kMostWorth = 0x1p16f;
// A wave's own sum of squares joins the others as soon as it reaches this, so it stays below kAddendLimit.
constexpr uint64_t kMostPending = uint64_t{1} << 50;
// A run of pixels counts as at least this part of the image's mean brightness.
constexpr double kDarkest = 0.05;
// Root mean square of the worths at the first vertices. With less, paths end that would bring more than they cost
// (measured; METHODS 12.6).
constexpr double kFirstWorth = 12;

}  // namespace

void PathWorth::gather(const DirectionRecords& records) {
  uint64_t count = 0, squares = 0;
  for (size_t i = 0; i < records.size; ++i) {
    const double worth = static_cast<double>(std::min(records.worth[i], kMostWorth));
    if (!(worth > 0)) continue;
    // A path that went on stands for those that ended there, too.
    const double paths = 1 / static_cast<double>(records.survival[i]);
    count += toAddend(std::ldexp(paths, kSquareBits));
    squares += toAddend(std::ldexp(worth * worth * paths, kSquareBits));
    if (squares >= kMostPending) [[unlikely]]
      addTo(squares_, std::exchange(squares, 0));
  }
  addTo(count_, count);
  addTo(squares_, squares);
}

void PathWorth::fold(std::span<const float> luminance) {
  if (squares_ > 0) {
    norm_ *= std::sqrt(static_cast<double>(squares_) / static_cast<double>(count_)) / kFirstWorth;
    hasNorm_ = true;
  }
  squares_ = count_ = 0;
  const double mean = std::accumulate(luminance.begin(), luminance.end(), 0.0) / static_cast<double>(luminance.size());
  for (size_t run = 0; run < perBrightness_.size(); ++run) {
    const size_t begin = run * kWorthRun, count = std::min<size_t>(kWorthRun, luminance.size() - begin);
    const auto pixels = luminance.subspan(begin, count);
    const double brightness = std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(count);
    const double per = kFirstWorth / (norm_ * std::max(brightness, kDarkest * mean));
    // 0, unknown, where the image is black, or negative by a filter with negative lobes.
    perBrightness_[run] = per > 0 && std::isfinite(per) ? static_cast<float>(per) : 0;
  }
  hasBrightness_ = true;
}

void PathWorth::showIn(GuideView& guide) const {
  if (!hasBrightness_) return;
  guide.perBrightness = perBrightness_.data();
  guide.decidesSurvival = hasNorm_;
}

void PathWorth::save(StateWriter& out) const {
  out.value(squares_);
  out.value(count_);
  out.value(norm_);
  out.value(uint64_t{hasBrightness_});
  out.value(uint64_t{hasNorm_});
  out.items(perBrightness_.data(), perBrightness_.size());
}

void PathWorth::restore(StateReader& in) {
  squares_ = in.value<uint64_t>();
  count_ = in.value<uint64_t>();
  norm_ = in.value<double>();
  hasBrightness_ = in.value<uint64_t>() != 0;
  hasNorm_ = in.value<uint64_t>() != 0;
  in.items(perBrightness_.data(), perBrightness_.size());
  const bool sound = norm_ > 0 && std::isfinite(norm_) &&
                     std::all_of(perBrightness_.begin(), perBrightness_.end(),
                                 [](float per) { return per >= 0 && std::isfinite(per); });
  if (!sound) throw StateError("what it has learned is damaged");
}

}  // namespace wavecrest
