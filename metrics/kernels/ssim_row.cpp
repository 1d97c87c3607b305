// ssimRow: separable window sums down, then across, then the SSIM of each window. Returns the sum over the row.
// in: 11 rows of d and y, moments of the reference; out: map [windows]. metrics/kernels/ssim_row.h.
#include "metrics/kernels/ssim_row.h"

#include "kernels/simd/double_lanes.h"
#include "metrics/plane.h"

WAVECREST_SIMD_BEGIN

namespace {

// C1 and C2 of Wang et al. 2004 for codes 0..255.
constexpr double kC1 = 6.5025, kC2 = 58.5225;

// Column sums of d, d^2 and y^2 into three scratch rows (the mean of y follows from those of x and d).
void sumColumns(const SsimRow& row, double* d, double* dd, double* yy, size_t count) {
  for (size_t x = 0; x < count; x += kLanes) {
    Double sumD(0.0), sumDD(0.0), sumYY(0.0);
    for (size_t offset = 0; offset <= kSsimRadius; ++offset) {
      const size_t above = kSsimRadius - offset, below = kSsimRadius + offset;
      const Float dAbove = loadUnaligned(row.difference[above] + x), dBelow = loadUnaligned(row.difference[below] + x);
      const Float yAbove = loadUnaligned(row.test[above] + x), yBelow = loadUnaligned(row.test[below] + x);
      // The centre row is its own mirror image and would count twice.
      const Double weight(offset == 0 ? 0.5 * row.taps[0] : row.taps[offset]);
      sumD = mulAdd(weight, toDouble(dAbove + dBelow), sumD);
      sumDD = mulAdd(weight, toDouble(mulAdd(dAbove, dAbove, dBelow * dBelow)), sumDD);
      sumYY = mulAdd(weight, toDouble(mulAdd(yAbove, yAbove, yBelow * yBelow)), sumYY);
    }
    storeUnaligned(sumD, d + x);
    storeUnaligned(sumDD, dd + x);
    storeUnaligned(sumYY, yy + x);
  }
}

// The window sum that starts at the given column.
WAVECREST_INLINE Double sumAcross(const SsimRow& row, const double* columns) {
  Double sum = Double(row.taps[0]) * loadUnaligned(columns + kSsimRadius);
  for (size_t offset = 1; offset <= kSsimRadius; ++offset) {
    const Double pair = loadUnaligned(columns + kSsimRadius - offset) + loadUnaligned(columns + kSsimRadius + offset);
    sum = mulAdd(Double(row.taps[offset]), pair, sum);
  }
  return sum;
}

}  // namespace

double ssimRow(const SsimRow& row) {
  const size_t columns = roundUpToLanes(row.windows + kSsimTaps - 1);
  double* d = row.scratch;
  double* dd = d + columns + kPlaneLanes;
  double* yy = dd + columns + kPlaneLanes;
  sumColumns(row, d, dd, yy, columns);
  for (size_t x = 0; x < row.windows; x += kLanes) {
    const Double meanD = sumAcross(row, d + x);
    const Double meanX = loadUnaligned(row.referenceMean + x), meanY = meanX - meanD;
    const Double varianceD = sumAcross(row, dd + x) - meanD * meanD;
    const Double varianceY = sumAcross(row, yy + x) - meanY * meanY;
    const Double luminance = mulAdd(meanX, meanX, mulAdd(meanY, meanY, Double(kC1)));
    const Double structure = loadUnaligned(row.referenceVariance + x) + varianceY + Double(kC2);
    const Float a = toFloat(negMulAdd(meanD, meanD, luminance) / luminance);
    const Float b = toFloat((structure - varianceD) / structure);
    storeUnaligned(a * b, row.map + x);
  }
  double sum = 0;
  for (size_t x = 0; x < row.windows; ++x) sum += double{row.map[x]};
  return sum;
}

WAVECREST_SIMD_END
