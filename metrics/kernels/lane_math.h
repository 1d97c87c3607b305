// Logarithm, exponential and power of positive numbers, to about 2 ulp of single precision.
#pragma once

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

// log2 of a positive normal number; zero and denormals give about -127.
// The mantissa is brought to [sqrt(1/2), sqrt(2)]; there log(m) = 2 atanh((m - 1) / (m + 1)), an odd series.
WAVECREST_INLINE Float log2(Float x) {
  const UInt raw = bits(x);
  const Float mantissa = fromBits((raw & UInt(0x007fffffu)) | UInt(0x3f800000u));
  const Mask upper = mantissa > Float(1.41421356f);
  const Float m = select(upper, mantissa * Float(0.5f), mantissa);
  const Float exponent = toFloat(shiftRight<23>(raw)) - select(upper, Float(126.0f), Float(127.0f));
  const Float s = (m - Float(1.0f)) / (m + Float(1.0f)), z = s * s;
  Float tail = mulAdd(z, Float(0.320598534f), Float(0.412198583f));  // 2 / (9 ln 2), 2 / (7 ln 2)
  tail = mulAdd(tail, z, Float(0.577078017f));                       // 2 / (5 ln 2)
  tail = mulAdd(tail, z, Float(0.961796694f));                       // 2 / (3 ln 2)
  tail = mulAdd(tail, z, Float(2.88539008f));                        // 2 / ln 2
  return mulAdd(tail, s, exponent);
}

// 2^x; below -126 it is 0, above 127 it is held there.
// Taylor's series of 2^f for the fraction f in [-1/2, 1/2]; the whole part becomes the exponent.
WAVECREST_INLINE Float exp2(Float x) {
  const Mask underflow = x < Float(-126.0f);
  const Float clamped = min(max(x, Float(-126.0f)), Float(127.0f));
  const Float whole = floor(clamped + Float(0.5f));
  const Float f = clamped - whole;
  Float sum = mulAdd(f, Float(1.52527338e-5f), Float(1.54035304e-4f));
  sum = mulAdd(sum, f, Float(1.33335581e-3f));
  sum = mulAdd(sum, f, Float(9.61812911e-3f));
  sum = mulAdd(sum, f, Float(5.55041087e-2f));
  sum = mulAdd(sum, f, Float(2.40226507e-1f));
  sum = mulAdd(sum, f, Float(6.93147181e-1f));
  sum = mulAdd(sum, f, Float(1.0f));
  const Float scale = fromBits(shiftLeft<23>(toUInt(whole + Float(127.0f))));
  return zeroUnless(!underflow, sum * scale);
}

// x^exponent for x >= 0 and a positive exponent; 0 gives exactly 0.
WAVECREST_INLINE Float pow(Float x, Float exponent) {
  return zeroUnless(x > Float(1.17549435e-38f), exp2(exponent * log2(x)));
}

WAVECREST_SIMD_END
