// ssimRow: separable window sums down, then across, then the SSIM of each window. Returns the sum over the row.
// in: 11 rows of d and y, moments of the reference; out: map [windows]. metrics/kernels/ssim_row.h.
#include "metrics/kernels/ssim_row.h"

#include "kernels/simd/lanes.h"
#include "metrics/plane.h"

WAVECREST_SIMD_BEGIN

namespace {

// C1 and C2 of Wang et al. 2004 for codes 0..255.
constexpr float kC1 = 6.5025f, kC2 = 58.5225f;

// Column sums of d, d^2 and y^2 into three scratch rows (the mean of y follows from those of x and d).
void sumColumns(const SsimRow& row, float* d, float* dd, float* yy, size_t count) {
  for (size_t x = 0; x < count; x += kLanes) {
    Float sumD(0.0f), sumDD(0.0f), sumYY(0.0f);
    for (size_t i = 0; i < kSsimTaps; ++i) {
      const Float weight(row.taps[i]);
      const Float difference = loadUnaligned(row.difference[i] + x), test = loadUnaligned(row.test[i] + x);
      const Float weighted = weight * difference;
      sumD = sumD + weighted;
      sumDD = mulAdd(weighted, difference, sumDD);
      sumYY = mulAdd(weight * test, test, sumYY);
    }
    storeUnaligned(sumD, d + x);
    storeUnaligned(sumDD, dd + x);
    storeUnaligned(sumYY, yy + x);
  }
}

WAVECREST_INLINE Float sumAcross(const float* columns, const float* taps) {
  Float sum(0.0f);
  for (size_t i = 0; i < kSsimTaps; ++i) sum = mulAdd(Float(taps[i]), loadUnaligned(columns + i), sum);
  return sum;
}

}  // namespace

double ssimRow(const SsimRow& row) {
  const size_t columns = roundUpToLanes(row.windows + kSsimTaps - 1);
  float* d = row.scratch;
  float* dd = d + columns + kPlaneLanes;
  float* yy = dd + columns + kPlaneLanes;
  sumColumns(row, d, dd, yy, columns);
  for (size_t x = 0; x < row.windows; x += kLanes) {
    const Float meanD = sumAcross(d + x, row.taps);
    const Float meanX = loadUnaligned(row.referenceMean + x), meanY = meanX - meanD;
    const Float shiftedY = meanY - Float(kSsimShift);
    const Float varianceD = sumAcross(dd + x, row.taps) - meanD * meanD;
    const Float varianceY = sumAcross(yy + x, row.taps) - shiftedY * shiftedY;
    const Float luminance = mulAdd(meanX, meanX, mulAdd(meanY, meanY, Float(kC1)));
    const Float structure = loadUnaligned(row.referenceVariance + x) + varianceY + Float(kC2);
    const Float ssim = (luminance - meanD * meanD) * (structure - varianceD) / (luminance * structure);
    storeUnaligned(ssim, row.map + x);
  }
  double sum = 0;
  for (size_t x = 0; x < row.windows; ++x) sum += double{row.map[x]};
  return sum;
}

WAVECREST_SIMD_END
