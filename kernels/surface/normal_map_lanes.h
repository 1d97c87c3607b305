// Bump and normal maps: which normal a surface shows to whom, and how much of the light reaches it. As Mitsuba 3.9's
// `bumpmap` and `normalmap` with `flip_invalid_normals` and `use_shadowing_function`.
//
// A normal that faces away from the eye where the surface does not is mirrored at the surface's own (Schuessler et al.
// 2017). So it belongs to a direction: N(w) is what a walk that comes from w samples with, and f is taken with N(w_e),
// whichever end the walk began at. Light that N(w_e) and the surface see from different sides is not scattered, and
// what is left is softened near the terminator (Estevez et al. 2019). Both depend on which end is the eye: f is not
// symmetric, but it is one function of (w_l, w_e), which is all that weights and methods ask for.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct NormalMapLanes {
  bool present = false;         // some lane has a map; else the rest is not set
  Mask lanes;                   // that have one
  Mask flips;                   // N(w) faces w
  Mask softens;                 // the terminator
  Mask mirrorsBack;             // two-sided around the map: the back is the front's mirror image
  Vec3<Real> wi, base, mapped;  // direction back along the walk; normals without and with the map

  // Where two-sidedness turns what is seen from w.
  WAVECREST_INLINE Mask turns(Vec3<Real> w) const { return mirrorsBack & (dot(w, base) < Real(0)); }

  // N(w).
  WAVECREST_INLINE Vec3<Real> normalFor(Vec3<Real> w) const {
    const Real height = dot(base, mapped), facing = dot(w, base);
    const Mask turned = turns(w);
    const Vec3<Real> normal = mapped - base * zeroUnless(turned, height + height);
    const Real upright = select(turned, -height, height);
    const Mask away = (dot(w, normal) * select(turned, -facing, facing)) <= Real(0);
    return select(flips & away, base * (upright + upright) - normal, normal);
  }

  // The two normals of a point are each other's mirror images.
  WAVECREST_INLINE Vec3<Real> otherOf(Vec3<Real> normal) const {
    const Real height = dot(base, normal);
    return base * (height + height) - normal;
  }
  // Whether w faces `normal` rather than its mirror image.
  WAVECREST_INLINE Mask sees(Vec3<Real> w, Vec3<Real> normal) const {
    const Vec3<Real> seen = normalFor(w);
    return dot(seen, normal) >= dot(seen, otherOf(normal));
  }
  // The probability with which a walk that comes from the light at w samples with `normal`. A normal that faces away
  // from the light scatters none of it. The mirror image is for directions behind the mapped normal; of a cosine
  // hemisphere they have about sin^2 of its tilt, and where two densities share out disjoint sets, variance is least
  // with shares like the roots of their measures.
  WAVECREST_INLINE Real lightShare(Vec3<Real> normal, Vec3<Real> w) const {
    const Real zero(0), one(1), height = dot(base, mapped);
    const Mask turned = turns(w);
    const Vec3<Real> first = mapped - base * zeroUnless(turned, height + height), second = otherOf(first);
    const Real facing = select(turned, -dot(w, base), dot(w, base));
    const Mask firstIsLit = (dot(w, first) * facing) > zero;
    const Mask secondIsLit = flips & ((dot(w, second) * facing) > zero);
    const Real tilt = sqrt(max(one - height * height, zero));
    const Real share = zeroUnless(secondIsLit, select(firstIsLit, tilt / (one + tilt), one));
    return select(dot(normal, first) >= dot(normal, second), one - share, share);
  }

  // What the map does to f between light and eye, with normal = N(toEye): 0 where the two normals disagree about the
  // light, else the shadowing term, G1 of a rough surface that the map might have come from.
  WAVECREST_INLINE Real lightFactor(Vec3<Real> normal, Vec3<Real> toLight, Vec3<Real> toEye) const {
    const Real one(1), tiny(1e-12f);
    const Real height = dot(base, normal), cosine = dot(base, toLight);
    const Real agreement = dot(normal, toLight) * cosine;
    const Mask lit = select(turns(toEye), -agreement, agreement) > Real(0);
    const Real height2 = max(height * height, tiny), cosine2 = max(cosine * cosine, tiny);
    const Real alpha2 = min(Real(0.125f) * max(one - height2, Real(0)) / height2, one);
    const Real masking = Real(2) / (one + sqrt(one + alpha2 * max(one - cosine2, Real(0)) / cosine2));
    return zeroUnless(lit, select(softens, masking, one));
  }
};
struct NoNormalMaps {};

WAVECREST_SIMD_END
