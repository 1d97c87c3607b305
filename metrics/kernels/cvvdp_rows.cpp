// cvvdpContrastRow, cvvdpDifferenceRow: see metrics/kernels/cvvdp_rows.h for what goes in and out.
// cvvdpDifferenceRow returns the sum of pow(D, 2) over the row for each channel.
#include "metrics/kernels/cvvdp_rows.h"

#include "kernels/simd/lanes.h"
#include "metrics/kernels/lane_math.h"

WAVECREST_SIMD_BEGIN

void cvvdpContrastRow(const CvvdpContrastRow& row) {
  for (size_t x = 0; x < row.width; x += kLanes) {
    const Float background = max(loadUnaligned(row.coarse[0] + x), Float(row.leastBackground));
    for (size_t c = 0; c < kCvvdpChannels; ++c) {
      const Float band = loadUnaligned(row.fine[c] + x) - loadUnaligned(row.coarse[c] + x);
      const Float contrast = min(band / background, Float(row.greatestContrast));
      const Float test = contrast * loadUnaligned(row.sensitivity[c] + x);
      storeUnaligned(test, row.test[c] + x);
      storeUnaligned(min(abs(test), abs(loadUnaligned(row.reference[c] + x))), row.mutual[c] + x);
    }
  }
}

namespace {

// (x + offset)^exponent - offset^exponent.
class OffsetPower {
 public:
  OffsetPower(float offset, float exponent)
      : offset_(offset), exponent_(exponent), atZero_(pow(Float(offset), Float(exponent))) {}
  WAVECREST_INLINE Float operator()(Float x) const { return pow(x + offset_, exponent_) - atZero_; }

 private:
  Float offset_, exponent_, atZero_;
};

}  // namespace

CvvdpChannels<double> cvvdpDifferenceRow(const CvvdpDifferenceRow& row) {
  const OffsetPower differencePower(row.offset, row.differenceExponent);
  const OffsetPower maskPower[] = {OffsetPower(row.offset, row.maskExponent[0]),
                                   OffsetPower(row.offset, row.maskExponent[1]),
                                   OffsetPower(row.offset, row.maskExponent[2])};
  Float sums[] = {Float(0.0f), Float(0.0f), Float(0.0f)};
  for (size_t x = 0; x < row.width; x += kLanes) {
    Float masks[] = {Float(1.0f), Float(1.0f), Float(1.0f)};
    for (size_t k = 0; k < kCvvdpChannels; ++k) {
      const Float mutual = maskPower[k](Float(row.maskGain) * loadUnaligned(row.mutual[k] + x));
      for (size_t c = 0; c < kCvvdpChannels; ++c) masks[c] = mulAdd(Float(row.crossMasking[k][c]), mutual, masks[c]);
    }
    const Mask inside = firstLanes(row.width - x);
    for (size_t c = 0; c < kCvvdpChannels; ++c) {
      const Float distance = abs(loadUnaligned(row.test[c] + x) - loadUnaligned(row.reference[c] + x));
      const Float masked = differencePower(distance) / masks[c];
      const Float difference = Float(row.greatest) * masked / (Float(row.greatest) + masked);
      // pow(D, 2) without its rounding at small D: (D + offset)^2 - offset^2.
      sums[c] = sums[c] + zeroUnless(inside, difference * (difference + Float(2.0f * row.offset)));
      if (row.difference[c] != nullptr) storeUnaligned(difference, row.difference[c] + x);
    }
  }
  CvvdpChannels<double> totals{};
  for (size_t c = 0; c < kCvvdpChannels; ++c) {
    float lanes[kLanes];
    storeUnaligned(sums[c], lanes);
    for (const float lane : lanes) totals[c] += double{lane};
  }
  return totals;
}

WAVECREST_SIMD_END
