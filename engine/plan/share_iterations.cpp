#include "engine/plan/share_iterations.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace wavecrest {
namespace {

constexpr uint64_t kEndless = std::numeric_limits<uint64_t>::max();

// A round of the image's iterations, and what the share has of it.
struct Round {
  uint64_t begin, length;            // in the image
  uint64_t shareBegin, shareLength;  // in the image; the length is 0 of shares that a short last round does not reach
};

// Round `index` of an image of `all` iterations; there is one only if it begins before the end.
Round roundOf(unsigned index, uint64_t all, uint64_t part, uint64_t parts) {
  const uint64_t unit = uint64_t{1} << index, begin = parts * (unit - 1);
  const uint64_t length = std::min(parts * unit, all - std::min(all, begin));
  const uint64_t first = beginOfShare(length, static_cast<uint32_t>(part), static_cast<uint32_t>(parts));
  const uint64_t end = beginOfShare(length, static_cast<uint32_t>(part + 1), static_cast<uint32_t>(parts));
  return {begin, length, begin + first, end - first};
}

// Rounds beyond this one have more iterations than 64 bits count.
unsigned mostRounds(uint64_t parts) { return 63 - static_cast<unsigned>(std::bit_width(parts)); }

}  // namespace

ShareIterations::ShareIterations(const RenderSettings& settings)
    : rounds_(settings.share.rounds),
      first_(settings.firstIteration),
      part_(settings.share.part),
      parts_(settings.share.parts),
      all_(settings.share.iterations.value_or(kEndless)) {}

ShareIterations::Place ShareIterations::runWith(uint64_t own) const {
  if (!rounds_) return {first_ + own, kEndless - own};
  // Before round j the share has 1 + 2 + ... + 2^(j-1) iterations.
  const auto index = std::min(static_cast<unsigned>(std::bit_width(own + 1)) - 1, mostRounds(parts_));
  const Round round = roundOf(index, all_, part_, parts_);
  const uint64_t before = own - ((uint64_t{1} << index) - 1);
  return {round.shareBegin + before, std::max<uint64_t>(round.shareLength - std::min(before, round.shareLength), 1)};
}

std::vector<ShareIterations::Run> ShareIterations::runs(uint64_t count) const {
  std::vector<Run> runs;
  for (uint64_t own = 0; own < count;) {
    const Place place = runWith(own);
    const uint64_t length = std::min(place.left, count - own);
    runs.emplace_back(place.number, place.number + length);
    own += length;
  }
  return runs;
}

uint64_t iterationsInRounds(uint64_t all, uint32_t part, uint32_t parts) {
  uint64_t count = 0;
  for (unsigned index = 0; index <= mostRounds(parts); ++index) {
    const Round round = roundOf(index, all, part, parts);
    if (round.length == 0) break;
    count += round.shareLength;
  }
  return count;
}

}  // namespace wavecrest
