// A material and a number of edges as one number of a VertexRow: as bits in float, which are only moved, and as an
// integer in double.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE Float packTag(UInt material, uint32_t edges, Float) {
  return fromBits(material | UInt(edges << kMaterialBits));
}
WAVECREST_INLINE Double packTag(UInt material, uint32_t edges, Double) {
  return to<Double>(toFloat(material)) + Double(static_cast<double>(edges) * kMaxMaterials);
}

WAVECREST_INLINE UInt materialOfTag(Float tag) { return bits(tag) & UInt(kMaxMaterials - 1); }
WAVECREST_INLINE Float edgesOfTag(Float tag) { return toFloat(shiftRight<kMaterialBits>(bits(tag))); }
WAVECREST_INLINE Double edgesOfTag(Double tag) { return floor(tag * Double(1.0 / kMaxMaterials)); }
WAVECREST_INLINE UInt materialOfTag(Double tag) {
  return toUInt(to<Float>(tag - edgesOfTag(tag) * Double(kMaxMaterials)));
}

WAVECREST_SIMD_END
