// Warps: from numbers in [0,1) to points on discs, spheres, cones and triangles.
//
// Directions are in a local frame whose z axis is the normal or the axis. Points are uniform, except on the
// hemisphere, where their density is proportional to the cosine. The maps are continuous but for foldOntoTriangle, so
// that well distributed numbers stay well distributed.
#pragma once

#include "kernels/simd/math.h"
#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct Vec2 {
  Real x, y;
};

// ---- unit disc ------------------------------------------------------------------------------------------------------
// Shirley and Chiu, "A Low Distortion Map Between Disk and Square", 1997; the centre of the square goes to the centre.

template <class Real>
WAVECREST_INLINE Vec2<Real> concentricDisc(Real u, Real v) {
  const Real a = mulSub(Real(2), u, Real(1));
  const Real b = mulSub(Real(2), v, Real(1));
  // The wedge |a| > |b| is measured from the x axis, the other from the y axis: the angle stays within pi/4.
  const Mask alongX = abs(a) > abs(b);
  const Real radius = select(alongX, a, b);
  const Real ratio = zeroUnless(abs(radius) > Real(0), select(alongX, b, a) / radius);
  const SinCos<Real> angle = sinCosFirstOctant(ratio * Real(kPi / 4));
  const Real along = radius * angle.cos;
  const Real across = radius * angle.sin;
  return {select(alongX, along, across), select(alongX, across, along)};
}

// ---- hemisphere, proportional to the cosine -------------------------------------------------------------------------

// z = sqrt(1 - u) is formed from the number itself, not from x and y, and is never zero.
template <class Real>
WAVECREST_INLINE Vec3<Real> cosineHemisphere(Real u, Real v) {
  const SinCos<Real> azimuth = sinCos2Pi(v);
  const Real radius = sqrt(u);
  return {radius * azimuth.cos, radius * azimuth.sin, sqrt(Real(1) - u)};
}

// ---- sphere ---------------------------------------------------------------------------------------------------------

// sin theta = 2 sqrt(u - u^2) keeps its digits at the poles.
template <class Real>
WAVECREST_INLINE Vec3<Real> uniformSphere(Real u, Real v) {
  const SinCos<Real> azimuth = sinCos2Pi(v);
  const Real sinTheta = Real(2) * sqrt(u * (Real(1) - u));
  return {sinTheta * azimuth.cos, sinTheta * azimuth.sin, negMulAdd(Real(2), u, Real(1))};
}

// ---- cone around the z axis -----------------------------------------------------------------------------------------

// 1 - cos of a cone's half angle, from the squared sine: without the cancellation that makes it 0 for far light
// sources.
template <class Real>
WAVECREST_INLINE Real oneMinusCosFromSin2(Real sin2) {
  return sin2 / (Real(1) + sqrt(max(Real(1) - sin2, Real(0))));
}
template <class Real>
WAVECREST_INLINE Vec3<Real> uniformCone(Real u, Real v, Real oneMinusCosMax) {
  const SinCos<Real> azimuth = sinCos2Pi(v);
  const Real oneMinusCos = u * oneMinusCosMax;
  const Real sinTheta = sqrt(oneMinusCos * (Real(2) - oneMinusCos));
  return {sinTheta * azimuth.cos, sinTheta * azimuth.sin, Real(1) - oneMinusCos};
}

// ---- triangle -------------------------------------------------------------------------------------------------------

// In these lanes the unit square's far half is folded back, onto the triangle u + v <= 1.
template <class Real>
WAVECREST_INLINE void foldOntoTriangle(Mask triangle, Real& u, Real& v) {
  const Mask fold = triangle & (u + v > Real(1));
  u = select(fold, Real(1) - u, u);
  v = select(fold, Real(1) - v, v);
}

WAVECREST_SIMD_END
