// Beckmann's distribution of microfacet normals, with the interface of microfacet_lanes.h: slopes are normally
// distributed, D(m) = exp(-tan^2 / alpha^2) / (pi alpha^2 m_z^4).
//
// f has Walter's rational fit of G1 (2007, within 0.35 %), as Mitsuba 3; densities have the exact G1, since that is
// what sampling follows.
#pragma once

#include "kernels/bsdf/microfacet_lanes.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

// erf within 1.5e-7 (Abramowitz and Stegun, 7.1.26).
WAVECREST_INLINE Float erf(Float x) {
  const Float z = abs(x);
  const Float t = Float(1) / mulAdd(Float(0.3275911f), z, Float(1));
  Float sum(1.061405429f);
  for (const float c : {-1.453152027f, 1.421413741f, -0.284496736f, 0.254829592f}) sum = mulAdd(sum, t, Float(c));
  return copySign(negMulAdd(sum * t, exp(-(z * z)), Float(1)), x);
}

// The inverse of erf on (-1, 1), within 4e-6 relative (Giles, "Approximating the erfinv Function", 2012).
WAVECREST_INLINE Float erfInverse(Float x) {
  const Float w = -log(max((Float(1) - x) * (Float(1) + x), Float(1e-30f)));
  const Float central = w - Float(2.5f), tail = sqrt(max(w, Float(0))) - Float(3);
  Float a(2.81022636e-08f), b(-0.000200214257f);
  for (const float c : {3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f, -0.00125372503f,
                        -0.00417768164f, 0.246640727f, 1.50140941f}) {
    a = mulAdd(a, central, Float(c));
  }
  for (const float c : {0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f, -0.0076224613f,
                        0.00943887047f, 1.00167406f, 2.83297682f}) {
    b = mulAdd(b, tail, Float(c));
  }
  return select(w < Float(5), a, b) * x;
}

// Slope along the direction of view of a visible normal for alpha = 1. Jakob, "An Improved Visible Normal Sampling
// Routine for the Beckmann Distribution", 2014: in the variable b = erf(slope) the cumulative distribution is
//   (1 + b + tan(theta) exp(-slope^2) / sqrt(pi)) / its value at slope = cot(theta),
// nearly linear, and Newton's method from the solution at grazing incidence needs three steps.
WAVECREST_INLINE Float sampleVisibleSlope(Float cosTheta, Float u) {
  const Float one(1), inverseSqrtPi(0.5641895835f);
  const Float cosine = min(max(cosTheta, Float(1e-6f)), Float(0.9999999f));
  const Float tangent = sqrt((one - cosine) * (one + cosine)) / cosine, cotangent = one / tangent;
  const Float number = min(max(u, Float(1e-6f)), Float(1 - 1e-6f));
  const Float highest = erf(cotangent);
  const Float total = one + highest + inverseSqrtPi * tangent * exp(-(cotangent * cotangent));
  Float b = negMulAdd(highest + one, erf(sqrt(-log(number))), highest);
  for (int step = 0; step < 3; ++step) {
    const Float slope = erfInverse(b);
    const Float excess = one + b + inverseSqrtPi * tangent * exp(-(slope * slope)) - number * total;
    b = b - excess / (one - slope * tangent);
    b = min(max(b, Float(-0.9999999f)), Float(0.9999999f));
  }
  return erfInverse(b);
}

template <class P>
struct BeckmannNormals {
  using Real = typename P::Real;
  Real alpha, alpha2;

  static WAVECREST_INLINE BeckmannNormals fromAlpha(Real alpha) {
    const Real a = max(alpha, Real(kSmallestAlpha));
    return {a, a * a};
  }
  template <bool kTextured>
  static WAVECREST_INLINE BeckmannNormals of(const BsdfInput<P, kTextured>& input) {
    return fromAlpha(input.alpha());
  }

  // With a = cot(theta) / alpha: G1 = (3.535 a + 2.181 a^2) / (1 + 2.276 a + 2.577 a^2) below a = 1.6, else 1.
  WAVECREST_INLINE Real masking(Vec3<Real> v) const {
    const Real z = abs(v.z), width = widthOf(v);
    const Real a = z * reciprocal(max(width, Real(1e-20f)));
    const Real below =
        mulAdd(mulAdd(Real(2.577f), a, Real(2.276f)), a, Real(1)) * reciprocal(mulAdd(Real(2.181f), a, Real(3.535f)));
    return Real(2) * select(a < Real(1.6f), width * below, z);
  }

  WAVECREST_INLINE Real densityFactor(Vec3<Real> v) const { return masking(v) * reciprocal(exactMasking(v)); }
  WAVECREST_INLINE Real weightFactor(Vec3<Real> v) const { return exactMasking(v) * reciprocal(masking(v)); }

  WAVECREST_INLINE Real density(Vec3<Real> h, Real h2) const {
    const Real tangential2 = mulAdd(h.x, h.x, h.y * h.y);
    const Real inverseZ2 = reciprocal(max(h.z * h.z, h2 * Real(1e-9f)));
    const Real ratio = h2 * inverseZ2;
    return exp(-(tangential2 * inverseZ2) * reciprocal(alpha2)) * ratio * ratio * Real(kInvPi) * reciprocal(alpha2);
  }

  // Slopes are drawn in Float: their numbers have 24 bits.
  WAVECREST_INLINE Vec3<Real> sampleVisible(Vec3<Real> v, Real u1, Real u2) const {
    const Real x = alpha * v.x, y = alpha * v.y;
    const Real across2 = mulAdd(x, x, y * y);
    const Real inverseLength = reciprocalSqrt(max(mulAdd(v.z, v.z, across2), Real(1e-30f)));
    const Real along = to<Real>(sampleVisibleSlope(toFloat(abs(v.z) * inverseLength), toFloat(u1)));
    const Real across =
        to<Real>(erfInverse(min(max(mulSub(Float(2), toFloat(u2), Float(1)), Float(-0.9999999f)), Float(0.9999999f))));
    // Back from the frame in which v lies in the xz plane; the pole has none of its own.
    const Mask pole = !(across2 > Real(1e-30f));
    const Real inverseAcross = reciprocalSqrt(max(across2, Real(1e-30f)));
    const Real cosine = select(pole, Real(1), x * inverseAcross), sine = select(pole, Real(0), y * inverseAcross);
    return normalize(Vec3<Real>{-alpha * mulSub(cosine, along, sine * across),
                                -alpha * mulAdd(sine, along, cosine * across), Real(1)});
  }

 private:
  // alpha sin(theta)
  WAVECREST_INLINE Real widthOf(Vec3<Real> v) const { return alpha * sqrt(mulAdd(v.x, v.x, v.y * v.y)); }

  // S of G1 = 2 / (1 + erf(a) + exp(-a^2) / (a sqrt(pi))).
  WAVECREST_INLINE Real exactMasking(Vec3<Real> v) const {
    const Real z = abs(v.z), width = widthOf(v);
    const Real a = min(z * reciprocal(max(width, Real(1e-20f))), Real(8));
    return mulAdd(z, Real(1) + to<Real>(erf(toFloat(a))), width * Real(0.56418958354775629) * exp(-(a * a)));
  }
};

WAVECREST_SIMD_END
