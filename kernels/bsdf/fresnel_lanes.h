// Fresnel reflectance of unpolarised light, in forms that keep their digits near eta = 1 and at grazing angles.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct DielectricFresnel {
  Real reflectance;
  Real g;  // eta cos(theta_t), 0 under total reflection
};

// cosine = |cos theta_i|, eta = eta_t / eta_i > 0. With g = eta cos(theta_t) = sqrt(eta^2 - 1 + cosine^2):
//   r_s = (c - g) / (c + g) = (1 - eta^2) / (c + g)^2,   r_p = r_s (c g - sin^2) / (c g + sin^2),
// without a difference of nearly equal numbers: exactly 0 at eta = 1. The second is r_p of Cook and Torrance (1982).
template <class P>
WAVECREST_INLINE DielectricFresnel<typename P::Real> fresnelDielectric(typename P::Real cosine, typename P::Real eta) {
  using Real = typename P::Real;
  const Real one(1), zero(0);
  const Real c = min(cosine, one);
  const Real change = (eta - one) * (eta + one);
  const Real g2 = mulAdd(c, c, change);
  const Real g = sqrt(max(g2, zero));
  const Real sin2 = (one - c) * (one + c);
  const Real sum = c + g;
  // The floor only matters at grazing incidence with eta = 1, where c = g = 0.
  const Real rs = -change * reciprocal(max(sum * sum, Real(1e-30f)));
  const Real rp = rs * (mulSub(c, g, sin2) * reciprocal(mulAdd(c, g, sin2)));
  const Real mean = Real(0.5) * mulAdd(rs, rs, rp * rp);
  // At critical incidence g2 is 0 from either side, where the mean is 1.
  return {select(g2 < zero, one, min(mean, one)), g};
}

// One channel of a boundary to a metal of index eta + i k relative to the outside; cosine = cos theta_i >= 0.
//   a^2 + b^2 = |(eta + i k)^2 - sin^2|,  a^2 - b^2 = eta^2 - k^2 - sin^2,  a b = eta k
//   R_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2),  R_p = R_s (... sin^2 ...)   (Moeller, Optics, 1988)
// eta = 0 makes a = 0 and the reflectance exactly 1: a perfect mirror.
template <class P>
WAVECREST_INLINE typename P::Real fresnelConductor(typename P::Real cosine, typename P::Real eta, typename P::Real k) {
  using Real = typename P::Real;
  const Real one(1), zero(0), tiny(1e-30f);
  const Real c = min(cosine, one);
  const Real c2 = c * c;
  const Real sin2 = (one - c) * (one + c);
  const Real etaK = eta * k;
  const Real difference = mulSub(eta - k, eta + k, sin2);
  const Real modulus = sqrt(mulAdd(difference, difference, Real(4) * etaK * etaK));
  // The larger of a and b is a sum of positives; the other follows from the product, not from a difference.
  const Real larger = sqrt(max(Real(0.5) * (modulus + abs(difference)), tiny));
  const Real a = select(difference > zero, larger, etaK * reciprocal(larger));
  const Real twoAc = Real(2) * a * c;
  const Real s = modulus + c2;
  const Real rs = (s - twoAc) * reciprocal(s + twoAc);
  const Real p = mulAdd(modulus, c2, sin2 * sin2);
  const Real twoAcSin2 = twoAc * sin2;
  const Real rp = rs * ((p - twoAcSin2) * reciprocal(p + twoAcSin2));
  return min(Real(0.5) * (rs + rp), one);
}

template <class P>
WAVECREST_INLINE Vec3<typename P::Real> fresnelConductor(typename P::Real cosine, Vec3<typename P::Real> eta,
                                                         Vec3<typename P::Real> k) {
  return {fresnelConductor<P>(cosine, eta.x, k.x), fresnelConductor<P>(cosine, eta.y, k.y),
          fresnelConductor<P>(cosine, eta.z, k.z)};
}

WAVECREST_SIMD_END
