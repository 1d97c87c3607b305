// Elementary functions of lanes, for Real = Float or Double.
//
// Errors are the largest found by tests/kernels/math_test.cpp against long double, over the stated range, on every
// instruction set (those without fused multiply-add decide). Highway's functions where they are good; own ones where
// the renderer needs less than they do (angles in turns) or both results at once.
#pragma once

#include <hwy/contrib/math/math-inl.h>

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kInvPi = 1 / kPi;

// ---- sine and cosine ------------------------------------------------------------------------------------------------

template <class Real>
struct SinCos {
  Real sin, cos;
};

// For |x| <= pi/4: minimax polynomials (Remez exchange; relative error below 2^-27 and 2^-57). Error 1.3 ulp.
WAVECREST_INLINE SinCos<Float> sinCosFirstOctant(Float x) {
  const Float z = x * x;
  const Float sinTail = mulAdd(mulAdd(Float(-1.95152796e-4f), z, Float(8.33216074e-3f)), z, Float(-1.66666546e-1f));
  const Float cosTail = mulAdd(mulAdd(Float(2.44331543e-5f), z, Float(-1.38873162e-3f)), z, Float(4.16666457e-2f));
  return {mulAdd(x * z, sinTail, x), mulAdd(z * z, cosTail, negMulAdd(Float(0.5f), z, Float(1)))};
}
WAVECREST_INLINE SinCos<Double> sinCosFirstOctant(Double x) {
  const Double z = x * x;
  Double sinTail(1.58962283057308720e-10);
  for (const double c : {-2.50507477326622996e-08, 2.75573136212076634e-06, -1.98412698295890889e-04,
                         8.33333333332211823e-03, -1.66666666666666297e-01}) {
    sinTail = mulAdd(sinTail, z, Double(c));
  }
  Double cosTail(-1.13585351962735750e-11);
  for (const double c : {2.08757008172418644e-09, -2.75573141791225319e-07, 2.48015872888511346e-05,
                         -1.38888888888730557e-03, 4.16666666666665950e-02}) {
    cosTail = mulAdd(cosTail, z, Double(c));
  }
  return {mulAdd(x * z, sinTail, x), mulAdd(z * z, cosTail, negMulAdd(Double(0.5), z, Double(1.0)))};
}

// The sine and cosine of x + quadrant * pi/2 from those of x; quadrant is a whole number in [0, 4].
WAVECREST_INLINE SinCos<Float> turnByQuadrants(SinCos<Float> x, Float quadrant) {
  const UInt q = toUInt(quadrant);
  const Mask swap = hasBit(q, 0);
  const UInt sinSign = shiftLeft<30>(q & UInt(2u));
  const UInt cosSign = shiftLeft<30>((q + UInt(1u)) & UInt(2u));
  return {fromBits(bits(select(swap, x.cos, x.sin)) ^ sinSign), fromBits(bits(select(swap, x.sin, x.cos)) ^ cosSign)};
}
WAVECREST_INLINE SinCos<Double> turnByQuadrants(SinCos<Double> x, Double quadrant) {
  const Mask one = quadrant == Double(1.0);
  const Mask two = quadrant == Double(2.0);
  const Mask three = quadrant == Double(3.0);
  const Double sine = select(one | three, x.cos, x.sin);
  const Double cosine = select(one | three, x.sin, x.cos);
  return {select(two | three, -sine, sine), select(one | two, -cosine, cosine)};
}

// The sine and cosine of 2 pi u for u in [0,1]: no reduction modulo pi. Error 2^-23 and 2^-52 (absolute).
template <class Real>
WAVECREST_INLINE SinCos<Real> sinCos2Pi(Real u) {
  const Real quadrant = floor(mulAdd(Real(4), u, Real(0.5)));
  const Real rest = negMulAdd(Real(0.25), quadrant, u);  // in [-1/8, 1/8], exact
  return turnByQuadrants(sinCosFirstOctant(rest * Real(2 * kPi)), quadrant);
}

// The sine and cosine of x radians, |x| <= 8192 (Float) or 2^20 (Double). Error 2^-23 and 2^-52 (absolute).
WAVECREST_INLINE Float subtractHalfPis(Float x, Float n) {
  // pi/2 in three parts, the first two short enough for their product with n to be exact (Cody and Waite 1980).
  const Float r = negMulAdd(n, Float(4.8375129699707031e-4f), negMulAdd(n, Float(1.5703125f), x));
  return negMulAdd(n, Float(7.5497899548918821e-8f), r);
}
WAVECREST_INLINE Double subtractHalfPis(Double x, Double n) {
  const Double r = negMulAdd(n, Double(6.07710050630396597660e-11), negMulAdd(n, Double(1.57079632673412561417), x));
  return negMulAdd(n, Double(2.02226624879595063154e-21), r);
}
template <class Real>
WAVECREST_INLINE SinCos<Real> sinCos(Real x) {
  const Real n = round(x * Real(2 / kPi));
  const Real quadrant = negMulAdd(Real(4), floor(n * Real(0.25)), n);
  return turnByQuadrants(sinCosFirstOctant(subtractHalfPis(x, n)), quadrant);
}
template <class Real>
WAVECREST_INLINE Real sin(Real x) {
  return sinCos(x).sin;
}
template <class Real>
WAVECREST_INLINE Real cos(Real x) {
  return sinCos(x).cos;
}

// ---- functions of Highway -------------------------------------------------------------------------------------------

#define WAVECREST_HIGHWAY_FUNCTION(NAME, FUNCTION)                                              \
  WAVECREST_INLINE Float NAME(Float a) { return {hn::FUNCTION(FloatTag(), a.v)}; }              \
  WAVECREST_INLINE Double NAME(Double a) {                                                      \
    return mapParts([](auto x) WAVECREST_LAMBDA { return hn::FUNCTION(DoubleTag(), x); }, a.v); \
  }
WAVECREST_HIGHWAY_FUNCTION(log, Log)      // positive, finite a. 1 ulp.
WAVECREST_HIGHWAY_FUNCTION(log2, Log2)    // positive, finite a. 2 ulp.
WAVECREST_HIGHWAY_FUNCTION(log1p, Log1p)  // log(1 + a), finite a > -1. 2.5 ulp.
WAVECREST_HIGHWAY_FUNCTION(exp, Exp)      // a <= 88 and 706; 0 far below. 1 ulp.
WAVECREST_HIGHWAY_FUNCTION(expm1, Expm1)  // exp(a) - 1, the same range. 4 ulp.
WAVECREST_HIGHWAY_FUNCTION(acos, Acos)    // a in [-1,1]. 1.5 ulp.
WAVECREST_HIGHWAY_FUNCTION(atan, Atan)    // finite a. 2.5 ulp.
#undef WAVECREST_HIGHWAY_FUNCTION

// The angle of (x, y) in [-pi, pi]; 0 at the origin. 2.5 ulp.
template <class Real>
WAVECREST_INLINE Real atan2(Real y, Real x) {
  const Real absX = abs(x), absY = abs(y);
  const Real greater = max(absX, absY);
  const Real ratio = zeroUnless(greater > Real(0), min(absX, absY) / greater);
  const Real octant = atan(ratio);
  const Real quadrant = select(absY > absX, Real(kPi / 2) - octant, octant);
  return copySign(select(x < Real(0), Real(kPi) - quadrant, quadrant), y);
}

// ---- powers ---------------------------------------------------------------------------------------------------------

// 2^n for whole n: 0 at the format's exponent for zero, infinity at the one for infinity.
WAVECREST_INLINE Float powerOf2(Float n) { return fromBits(shiftLeft<23>(toUInt(n + Float(127)))); }
WAVECREST_INLINE Double powerOf2(Double n) {
  return mapParts(
      [](auto biased)
          WAVECREST_LAMBDA { return hn::BitCast(DoubleTag(), hn::ShiftLeft<52>(hn::ConvertTo(LongTag(), biased))); },
      (n + Double(1023.0)).v);
}

// 2^a. Above 127.5 (1023.5) infinity, below -126.5 (-1022.5) zero: no subnormal results. 1.2 ulp.
WAVECREST_INLINE Float exp2(Float a) {
  const Float x = min(max(a, Float(-127)), Float(128));
  const Float n = round(x);
  const Float f = x - n;
  Float p(1.534578902e-04f);
  for (const float c :
       {1.339993086e-03f, 9.618489048e-03f, 5.550328778e-02f, 2.402264689e-01f, 6.931472057e-01f, 1.0f}) {
    p = mulAdd(p, f, Float(c));
  }
  return p * powerOf2(n);
}
WAVECREST_INLINE Double exp2(Double a) {
  const Double x = min(max(a, Double(-1023.0)), Double(1024.0));
  const Double n = round(x);
  return exp((x - n) * Double(0.69314718055994530942)) * powerOf2(n);
}

// a^b for a >= 0; 0^0 is 1. The relative error is that of b * log2(a), rounded: (2 + 2 |b log2(a)|) ulp.
template <class Real>
WAVECREST_INLINE Real pow(Real a, Real b) {
  const Real power = exp2(b * log2(a));
  const Real ofZero = select(b == Real(0), Real(1), Real(0));
  return select(a > Real(0), power, ofZero);
}

WAVECREST_SIMD_END
