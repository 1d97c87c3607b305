// Elementary functions of lanes, for Real = Float or Double.
#pragma once

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct SinCos {
  Real sin, cos;
};

// ---- sine and cosine ------------------------------------------------------------------------------------------------
// Minimax polynomials for |x| <= pi/4 (Remez exchange, relative error below 2^-27 in Float and 2^-57 in Double), and
// the symmetries of the circle for everything else.

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
  const Mask swap = (q & UInt(1u)) == UInt(1u);
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

// The sine and cosine of 2 pi u for u in [0,1].
template <class Real>
WAVECREST_INLINE SinCos<Real> sinCos2Pi(Real u) {
  const Real quadrant = floor(mulAdd(Real(4), u, Real(0.5)));
  const Real rest = negMulAdd(Real(0.25), quadrant, u);  // in [-1/8, 1/8], exact
  return turnByQuadrants(sinCosFirstOctant(rest * Real(6.28318530717958648)), quadrant);
}

WAVECREST_SIMD_END
