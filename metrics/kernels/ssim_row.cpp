// ssimRow: separable window sums, down and then across, then the SSIM of each window, block by block.
// in: 11 rows of d and y, moments of the reference; out: map [windows], sums of the map per channel.
#include "metrics/kernels/ssim_row.h"

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr size_t kMaxChannels = 3;
constexpr size_t kMaxLanes = 16;
constexpr size_t kBlockColumns = kSsimBlock + 2 * kSsimRadius * kMaxChannels + 2;  // a multiple of 16

// One number per channel, repeated so that a vector may start at any channel.
template <size_t kChannels>
class ChannelPattern {
 public:
  explicit ChannelPattern(const float* samples) {
    for (size_t i = 0; i < kMaxLanes + kMaxChannels; ++i) values_[i] = samples[i % kChannels];
  }
  // For the vector that starts at the given column of the block.
  WAVECREST_INLINE Float at(size_t column) const { return loadUnaligned(values_ + column % kChannels); }

 private:
  float values_[kMaxLanes + kMaxChannels];
};

// Weighted column sums of one block: of d and y relative to the block's middle, and of their squares.
struct ColumnSums {
  alignas(64) float d[kBlockColumns + kMaxLanes], dd[kBlockColumns + kMaxLanes];
  alignas(64) float y[kBlockColumns + kMaxLanes], yy[kBlockColumns + kMaxLanes];
};

template <size_t kChannels>
void sumColumns(const SsimRow& row, size_t first, const ChannelPattern<kChannels>& shiftD,
                const ChannelPattern<kChannels>& shiftY, ColumnSums& sums) {
  for (size_t column = 0; column < kBlockColumns; column += kLanes) {
    const size_t x = first + column;
    const Float middleD = shiftD.at(column), middleY = shiftY.at(column);
    const Float d0 = loadUnaligned(row.difference[kSsimRadius] + x) - middleD;
    const Float y0 = loadUnaligned(row.test[kSsimRadius] + x) - middleY;
    Float sumD = Float(row.taps[0]) * d0, sumDD = sumD * d0;
    Float sumY = Float(row.taps[0]) * y0, sumYY = sumY * y0;
    for (size_t offset = 1; offset <= kSsimRadius; ++offset) {
      const size_t above = kSsimRadius - offset, below = kSsimRadius + offset;
      const Float weight(row.taps[offset]);
      const Float dAbove = loadUnaligned(row.difference[above] + x) - middleD;
      const Float dBelow = loadUnaligned(row.difference[below] + x) - middleD;
      const Float yAbove = loadUnaligned(row.test[above] + x) - middleY;
      const Float yBelow = loadUnaligned(row.test[below] + x) - middleY;
      sumD = mulAdd(weight, dAbove + dBelow, sumD);
      sumDD = mulAdd(weight, mulAdd(dAbove, dAbove, dBelow * dBelow), sumDD);
      sumY = mulAdd(weight, yAbove + yBelow, sumY);
      sumYY = mulAdd(weight, mulAdd(yAbove, yAbove, yBelow * yBelow), sumYY);
    }
    store(sumD, sums.d + column);
    store(sumDD, sums.dd + column);
    store(sumY, sums.y + column);
    store(sumYY, sums.yy + column);
  }
}

// The window sums that start at the given columns.
template <size_t kChannels>
WAVECREST_INLINE Float sumAcross(const SsimRow& row, const float* columns) {
  const float* centre = columns + kSsimRadius * kChannels;
  Float sum = Float(row.taps[0]) * loadUnaligned(centre);
  for (size_t offset = 1; offset <= kSsimRadius; ++offset) {
    const size_t step = offset * kChannels;
    sum = mulAdd(Float(row.taps[offset]), loadUnaligned(centre - step) + loadUnaligned(centre + step), sum);
  }
  return sum;
}

template <size_t kChannels>
SsimSums ssimRowOf(const SsimRow& row) {
  ColumnSums sums;
  const Float c1(row.constants.luminance), c2(row.constants.structure);
  // One running sum for each channel that a vector may start with.
  Float totals[kMaxChannels] = {Float(0.0f), Float(0.0f), Float(0.0f)};
  for (size_t first = 0; first < row.windows; first += kSsimBlock) {
    // A pixel near the block's middle, still inside the row.
    const size_t windows = row.windows - first < kSsimBlock ? row.windows - first : kSsimBlock;
    const size_t middle = first + (windows / kChannels / 2 + kSsimRadius) * kChannels;
    const ChannelPattern<kChannels> shiftD(row.difference[kSsimRadius] + middle);
    const ChannelPattern<kChannels> shiftY(row.test[kSsimRadius] + middle);
    sumColumns(row, first, shiftD, shiftY, sums);
    for (size_t column = 0; column < windows; column += kLanes) {
      const size_t x = first + column;
      const Float relativeD = sumAcross<kChannels>(row, sums.d + column),
                  relativeY = sumAcross<kChannels>(row, sums.y + column);
      const Float meanD = relativeD + shiftD.at(column), meanY = relativeY + shiftY.at(column);
      const Float meanX = loadUnaligned(row.referenceMean + x);
      const Float varianceD = negMulAdd(relativeD, relativeD, sumAcross<kChannels>(row, sums.dd + column));
      const Float varianceY = negMulAdd(relativeY, relativeY, sumAcross<kChannels>(row, sums.yy + column));
      const Float luminance = mulAdd(meanX, meanX, mulAdd(meanY, meanY, c1));
      const Float structure = loadUnaligned(row.referenceVariance + x) + varianceY + c2;
      const Float ssim = negMulAdd(meanD, meanD, luminance) * (structure - varianceD) / (luminance * structure);
      storeUnaligned(ssim, row.map + x);
      Float& total = totals[column % kChannels];
      total = total + zeroUnless(firstLanes(windows - column), ssim);
    }
  }
  // A vector that starts at channel s holds channel (s + lane) modulo the channels.
  SsimSums channelSums{};
  for (size_t start = 0; start < kChannels; ++start) {
    float lanes[kLanes];
    storeUnaligned(totals[start], lanes);
    for (size_t lane = 0; lane < kLanes; ++lane) channelSums[(start + lane) % kChannels] += double{lanes[lane]};
  }
  return channelSums;
}

}  // namespace

SsimSums ssimRow(const SsimRow& row) { return row.channels == 1 ? ssimRowOf<1>(row) : ssimRowOf<3>(row); }

WAVECREST_SIMD_END
