// addSplats: adds a range of splats to the sums of their pixels.
//
// in: Splats [begin, end). out: sums (kernels/columns/splat_sums.h); counts of splats that are not finite, which are
// dropped, and of those that saturate a sum. The values of a block become integers in lanes; then every splat is added
// by itself, as two may be of one pixel. Pixels lie all over the film, so those of later splats are prefetched.
#include <algorithm>
#include <cmath>

#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Splats between asking for a pixel and adding to it.
constexpr size_t kPixelsAhead = 64;

WAVECREST_INLINE void prefetchPixel(const SplatSums& sums, uint32_t pixel) {
  const uint64_t* const low = sums.low + 3 * size_t{pixel};
  __builtin_prefetch(low, 1);
  __builtin_prefetch(low + 2, 1);  // three of eight pixels lie on two lines
}

// A splat that is large, negative or not finite.
WAVECREST_NOINLINE void addRareSplat(const SplatSums& sums, uint32_t pixel, const double (&rgb)[3],
                                     StageCounters& counters) {
  if (!(std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]))) {
    ++counters.nonFinite;
    return;
  }
  bool fits = true;
  for (size_t c = 0; c < 3; ++c) fits &= addToSplatSum(sums, 3 * size_t{pixel} + c, rgb[c]);
  if (!fits) ++counters.saturatedSplats;
}

}  // namespace

template <class S>
void addSplats(const Splats<S>& splats, size_t begin, size_t end, const SplatSums& sums, StageCounters& counters) {
  const uint32_t* const pixels = splats.pixel;
  size_t asked = begin;
  const Double scale(sums.scale), half(0.5), least(0.0), limit(kSmallSplatLimit);
  for (size_t i = begin; i < end; i += kLanes) {
    const size_t count = std::min(kLanes, end - i);
    for (const size_t until = std::min(end, i + kPixelsAhead + kLanes); asked < until; ++asked) {
      prefetchPixel(sums, pixels[asked]);
    }
    HWY_ALIGN int64_t values[3][kLanes];
    Mask small = allLanes();
    const auto toUnits = [&](const Column<S>& column, int64_t* units) WAVECREST_LAMBDA {
      const Double value = to<Double>(loadUnaligned(static_cast<const S*>(column) + i)) * scale;
      small = small & (value >= least) & (value < limit);
      storeTruncated(value + half, units);
    };
    toUnits(splats.red, values[0]);
    toUnits(splats.green, values[1]);
    toUnits(splats.blue, values[2]);
    if (all(small | !firstLanes(count))) {
      for (size_t k = 0; k < count; ++k) {
        const size_t first = 3 * size_t{pixels[i + k]};
        for (size_t c = 0; c < 3; ++c) {
          const auto units = static_cast<uint64_t>(values[c][k]);
          uint64_t& low = sums.low[first + c];
          low += units;
          if (low < units) [[unlikely]]
            ++sums.high[first + c];
        }
      }
      continue;
    }
    for (size_t k = 0; k < count; ++k) {
      const double rgb[3] = {static_cast<double>(splats.red[i + k]), static_cast<double>(splats.green[i + k]),
                             static_cast<double>(splats.blue[i + k])};
      addRareSplat(sums, pixels[i + k], rgb, counters);
    }
  }
}
template void addSplats(const Splats<float>&, size_t, size_t, const SplatSums&, StageCounters&);
template void addSplats(const Splats<double>&, size_t, size_t, const SplatSums&, StageCounters&);

WAVECREST_SIMD_END
