// Cheaper elementary functions for the `fast` precision policy: Float only, errors of about 1e-5 instead of 1e-7.
//
// Worth it where a shading model is all transcendental functions (Phong lobes). The errors are checked by
// tests/kernels/math_test.cpp.
#pragma once

#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

// log2(a) for positive, normal a. Relative error 8e-6, also near a = 1.
WAVECREST_INLINE Float fastLog2(Float a) {
  // a = 2^exponent * m with m in [sqrt(1/2), sqrt(2)): the bits of sqrt(1/2) split the mantissas evenly.
  constexpr uint32_t kSqrtHalf = 0x3f3504f3;
  const UInt shifted = bits(a) - UInt(kSqrtHalf);
  const Float exponent = toFloat(shiftRight<23>(shifted + UInt(127u << 23))) - Float(127);
  const Float t = fromBits((shifted & UInt(0x007fffffu)) + UInt(kSqrtHalf)) - Float(1);
  Float p(-2.061924123e-01f);
  for (const float c : {3.182006951e-01f, -3.664915736e-01f, 4.798117744e-01f, -7.212063951e-01f, 1.442701619e+00f}) {
    p = mulAdd(p, t, Float(c));
  }
  return mulAdd(p, t, exponent);
}

// 2^a, with the limits of exp2. Relative error 3e-6.
WAVECREST_INLINE Float fastExp2(Float a) {
  const Float x = min(max(a, Float(-127)), Float(128));
  const Float n = round(x);
  const Float f = x - n;
  Float p(9.570085887e-03f);
  for (const float c : {5.591785809e-02f, 2.402474527e-01f, 6.931218155e-01f, 9.999992614e-01f})
    p = mulAdd(p, f, Float(c));
  return p * powerOf2(n);
}

// a^b for a > 0. Relative error (3 + 6 |b log2(a)|) 1e-6.
WAVECREST_INLINE Float fastPow(Float a, Float b) { return fastExp2(b * fastLog2(a)); }

WAVECREST_SIMD_END
