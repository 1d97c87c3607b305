// flipAppearanceRow, flipFeatureRow, flipErrorRow: see metrics/kernels/flip_rows.h for what goes in and out.
#include "metrics/kernels/flip_rows.h"

#include "metrics/kernels/lane_math.h"

WAVECREST_SIMD_BEGIN

namespace {

WAVECREST_INLINE Float dot(const float* row, Float x, Float y, Float z) {
  return mulAdd(Float(row[0]), x, mulAdd(Float(row[1]), y, Float(row[2]) * z));
}

// CIE 1976: cube root with a linear foot.
WAVECREST_INLINE Float labCurve(Float t) {
  constexpr float kDelta = 6.0f / 29.0f;
  const Float root = exp2(Float(1.0f / 3.0f) * log2(max(t, Float(kDelta * kDelta * kDelta))));
  return select(t > Float(kDelta * kDelta * kDelta), root,
                mulAdd(t, Float(1 / (3 * kDelta * kDelta)), Float(4.0f / 29.0f)));
}

WAVECREST_INLINE Float clampToUnit(Float v) { return min(max(v, Float(0.0f)), Float(1.0f)); }

}  // namespace

void flipAppearanceRow(const FlipAppearanceRow& row) {
  for (size_t i = 0; i < row.width; i += kLanes) {
    // Opponent colours to relative XYZ: Y = 116 y - 16, Cx = 500 (x - y), Cz = 200 (y - z).
    const Float y = mulAdd(loadUnaligned(row.y + i), Float(1.0f / 116.0f), Float(16.0f / 116.0f));
    const Float x = mulAdd(loadUnaligned(row.cx + i), Float(1.0f / 500.0f), y);
    const Float z = negMulAdd(loadUnaligned(row.cz + i), Float(1.0f / 200.0f), y);
    const float* toRgb = row.rgbFromXyz.data();
    const Float red = clampToUnit(dot(toRgb, x, y, z));
    const Float green = clampToUnit(dot(toRgb + 3, x, y, z));
    const Float blue = clampToUnit(dot(toRgb + 6, x, y, z));
    const float* toXyz = row.xyzFromRgb.data();
    const Float fx = labCurve(dot(toXyz, red, green, blue));
    const Float fy = labCurve(dot(toXyz + 3, red, green, blue));
    const Float fz = labCurve(dot(toXyz + 6, red, green, blue));
    // Hunt's effect: colourfulness grows with lightness.
    const Float lightness = mulSub(Float(116.0f), fy, Float(16.0f));
    const Float hunt = Float(0.01f) * lightness;
    storeUnaligned(lightness, row.lightness + i);
    storeUnaligned(hunt * (Float(500.0f) * (fx - fy)), row.a + i);
    storeUnaligned(hunt * (Float(200.0f) * (fy - fz)), row.b + i);
  }
}

void flipFeatureRow(const FlipFeatureRow& row) {
  for (size_t i = 0; i < row.width; i += kLanes) {
    const Float ex = loadUnaligned(row.edgeX + i), ey = loadUnaligned(row.edgeY + i);
    const Float px = loadUnaligned(row.pointX + i), py = loadUnaligned(row.pointY + i);
    storeUnaligned(sqrt(mulAdd(ex, ex, ey * ey)), row.edge + i);
    storeUnaligned(sqrt(mulAdd(px, px, py * py)), row.point + i);
  }
}

void flipErrorRow(const FlipErrorRow& row) {
  // Colour differences up to 0.4 of the maximum use 0.95 of the range.
  constexpr float kKnee = 0.4f, kKneeError = 0.95f;
  const float knee = kKnee * row.colourMaximum;
  for (size_t i = 0; i < row.width; i += kLanes) {
    const auto difference = [&](const float* FlipRow::*channel) HWY_ATTR {
      return abs(loadUnaligned(row.reference.*channel + i) - loadUnaligned(row.test.*channel + i));
    };
    // HyAB: city-block in lightness, Euclidean in chroma (Abasi, Tehran, Fairchild 2020).
    const Float da = difference(&FlipRow::a), db = difference(&FlipRow::b);
    const Float hyab = difference(&FlipRow::lightness) + sqrt(mulAdd(da, da, db * db));
    const Float colour = pow(hyab, Float(kFlipColourExponent));
    const Float low = colour * Float(kKneeError / knee);
    const Float high =
        mulAdd(colour - Float(knee), Float((1 - kKneeError) / (row.colourMaximum - knee)), Float(kKneeError));
    const Float colourError = min(select(colour < Float(knee), low, high), Float(1.0f));
    // The stronger of the two features, in 0..1, raises the colour error towards 1.
    const Float feature = max(difference(&FlipRow::edge), difference(&FlipRow::point));
    const Float featureError = min(sqrt(Float(0.707106781f) * feature), Float(1.0f));
    const Float error = pow(colourError, Float(1.0f) - featureError);
    // 0^0: no colour difference is no error, whatever the features.
    storeUnaligned(max(loadUnaligned(row.error + i), zeroUnless(colourError > Float(0.0f), error)), row.error + i);
  }
}

WAVECREST_SIMD_END
