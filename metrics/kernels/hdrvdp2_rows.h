// The pointwise and local steps of HDR-VDP-2, one row at a time. metrics/hdrvdp2/README.md has the formulas.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

constexpr size_t kVdpLightNodes = 2048;       // photoreceptor tables, over log10 of 1e-5 .. 1e5 cd/m2
constexpr size_t kVdpSensitivityNodes = 256;  // contrast sensitivity tables, over the same range

// Light that reaches L cones, M cones and rods -> adapting luminance and achromatic response.
struct PhotoreceptorRow {
  const float *lCone, *mCone, *rod;
  const float *coneTable, *rodTable;  // kVdpLightNodes each
  size_t width;
  float* adaptation;  // out: lCone + mCone
  float* response;    // out: J_cone(lCone) + J_cone(mCone) + J_rod(rod)
};

// log10 of the mean of two adapting luminances.
struct LogMeanRow {
  const float *first, *second;
  size_t width;
  float* out;
};

// Sensitivity S of a band at log10 luminance, raised to the two powers that masking needs.
struct SensitivityRow {
  const float* logLuminance;
  const float* table;  // kVdpSensitivityNodes
  size_t width;
  float q, twoP;
  float *toQ, *toMinusTwoP;  // out: S^q and S^(-2p)
};

// Mutual mask: 3x3 box mean of min(|test|, |reference|), zero outside the band.
struct MutualMaskRow {
  std::array<const float*, 3> test, reference;  // rows above, at and below; null where the band ends
  size_t width;
  float* scratch;  // width rounded up + 16, with 16 more readable in front
  float* out;
};

// Squared difference of two bands in units of the threshold, with masking and the pixel mask.
struct DifferenceRow {
  const float *test, *reference;
  const float* self;                     // mutual mask of this band
  std::array<const float*, 4> siblings;  // mutual masks of all orientations, this one included; null: fewer
  const float *finer, *coarser;          // mutual masks of the neighbours, resized to this band; null: none
  float finerScale, coarserScale;
  const float *sensitivityToQ, *sensitivityToMinusTwoP;
  const float* pixelMask;
  size_t width;
  float twoP, q;
  float scale;            // n_b = 2^b of band b = 0, 1, ...
  float kSelf, kXo, kXn;  // kSelf and kXo are divided by n_b^q beforehand
  float* difference;      // out: signed, not squared, without the pixel mask; or null
};

}  // namespace wavecrest
