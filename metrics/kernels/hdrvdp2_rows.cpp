// The rows of HDR-VDP-2: photoreceptorRow, logMeanRow, sensitivityRow, mutualMaskRow, differenceRow.
// See metrics/kernels/hdrvdp2_rows.h for what goes in and out.
#include "metrics/kernels/hdrvdp2_rows.h"

#include "metrics/kernels/lane_math.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr float kLog10Of2 = 0.301029996f;

// Linear interpolation in a table of kNodes values over log10 of the light, which is from -5 to 5.
template <size_t kNodes>
WAVECREST_INLINE Float interpolate(const float* table, Float logLight) {
  const Float position = (logLight + Float(5.0f)) * Float((kNodes - 1) / 10.0f);
  const Float node = min(floor(max(position, Float(0.0f))), Float(static_cast<float>(kNodes - 2)));
  const UInt index = toUInt(node);
  const Float low = gather(table, index), high = gather(table + 1, index);
  return mulAdd(position - node, high - low, low);
}

// log10 of light that is clamped to the range of the tables.
WAVECREST_INLINE Float log10OfLight(Float light) {
  return Float(kLog10Of2) * log2(min(max(light, Float(1e-5f)), Float(1e5f)));
}

}  // namespace

void photoreceptorRow(const PhotoreceptorRow& row) {
  for (size_t x = 0; x < row.width; x += kLanes) {
    const Float l = loadUnaligned(row.lCone + x), m = loadUnaligned(row.mCone + x), r = loadUnaligned(row.rod + x);
    storeUnaligned(l + m, row.adaptation + x);
    const Float cones = interpolate<kVdpLightNodes>(row.coneTable, log10OfLight(l)) +
                        interpolate<kVdpLightNodes>(row.coneTable, log10OfLight(m));
    storeUnaligned(cones + interpolate<kVdpLightNodes>(row.rodTable, log10OfLight(r)), row.response + x);
  }
}

void logMeanRow(const LogMeanRow& row) {
  for (size_t x = 0; x < row.width; x += kLanes) {
    const Float mean = Float(0.5f) * (loadUnaligned(row.first + x) + loadUnaligned(row.second + x));
    storeUnaligned(log10OfLight(mean), row.out + x);
  }
}

void sensitivityRow(const SensitivityRow& row) {
  for (size_t x = 0; x < row.width; x += kLanes) {
    const Float logLuminance = min(max(loadUnaligned(row.logLuminance + x), Float(-5.0f)), Float(5.0f));
    // Both powers share one logarithm.
    const Float log2S = log2(interpolate<kVdpSensitivityNodes>(row.table, logLuminance));
    storeUnaligned(exp2(Float(row.q) * log2S), row.toQ + x);
    storeUnaligned(exp2(Float(-row.twoP) * log2S), row.toMinusTwoP + x);
  }
}

void mutualMaskRow(const MutualMaskRow& row) {
  // Down: three rows, those outside the band being zero.
  for (size_t x = 0; x < row.width; x += kLanes) {
    Float sum(0.0f);
    for (size_t i = 0; i < 3; ++i) {
      if (!row.test[i]) continue;
      sum = sum + min(abs(loadUnaligned(row.test[i] + x)), abs(loadUnaligned(row.reference[i] + x)));
    }
    storeUnaligned(zeroUnless(firstLanes(row.width - x), sum), row.scratch + x);
  }
  // The samples on either side of the row count as zero.
  row.scratch[-1] = 0;
  row.scratch[row.width] = 0;
  // Across.
  for (size_t x = 0; x < row.width; x += kLanes) {
    const float* s = row.scratch + x;
    const Float sum = loadUnaligned(s - 1) + loadUnaligned(s) + loadUnaligned(s + 1);
    storeUnaligned(sum * Float(1.0f / 9.0f), row.out + x);
  }
}

double differenceRow(const DifferenceRow& row) {
  Float total(0.0f);
  for (size_t x = 0; x < row.width; x += kLanes) {
    // The masks: of this orientation, of all orientations of the band, and of the neighbouring bands.
    const Float self = loadUnaligned(row.self + x);
    Float all(0.0f);
    for (const float* sibling : row.siblings) {
      if (sibling) all = all + loadUnaligned(sibling + x);
    }
    Float neighbours(0.0f);
    // Cubic resampling may fall below zero, where powers are not defined.
    if (row.finer) neighbours = Float(row.finerScale) * max(loadUnaligned(row.finer + x), Float(0.0f));
    if (row.coarser) {
      const Float coarser = max(loadUnaligned(row.coarser + x), Float(0.0f));
      neighbours = mulAdd(Float(row.coarserScale), coarser, neighbours);
    }
    // N_mask, with the common factor N^-q = S^q outside the sum.
    const Float q(row.q);
    Float mask = Float(row.kSelf) * pow(self, q);
    mask = mulAdd(Float(row.kXo), pow(max(all - self, Float(0.0f)), q), mask);
    mask = mulAdd(Float(row.kXn), pow(neighbours, q), mask);
    mask = Float(row.scale) * loadUnaligned(row.sensitivityToQ + x) * mask;

    // D^2 = n_b^2 |d / n_b|^2p / (N^2p + N_mask^2). Only squares are pooled; the map alone needs D.
    const Float difference = loadUnaligned(row.test + x) - loadUnaligned(row.reference + x);
    const Float excitation = pow(abs(difference) * Float(1.0f / row.scale), Float(row.twoP));
    const Float noise = mulAdd(mask, mask, loadUnaligned(row.sensitivityToMinusTwoP + x));
    const Float visible = Float(row.scale * row.scale) * excitation / noise;
    if (row.difference) storeUnaligned(copySign(sqrt(visible), difference), row.difference + x);
    const Float pixelMask = loadUnaligned(row.pixelMask + x);
    total = total + zeroUnless(firstLanes(row.width - x), visible * pixelMask * pixelMask);
  }
  // The lanes are added in double.
  float lanes[kLanes];
  storeUnaligned(total, lanes);
  double sum = 0;
  for (float lane : lanes) sum += double{lane};
  return sum;
}

WAVECREST_SIMD_END
