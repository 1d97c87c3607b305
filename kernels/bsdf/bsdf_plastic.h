// Smooth plastic: a smooth dielectric boundary over a diffuse base, with all reflections between the two summed up. As
// Mitsuba 3's `plastic`; the boundary's diffuse reflectance from inside is integrated rather than fitted.
//
// A delta lobe F and f = (1-F(wi)) (1-F(wo)) rho / (pi eta^2 (1 - X F_inside)), where X = rho if multiple scattering
// may shift the colour (`nonlinear`), else 1. The delta lobe is chosen with
//   P = F w / (F w + (1-F) (1-w)),  w the share of the specular colour (specularPick in the record).
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/bsdf/fresnel_lanes.h"
#include "kernels/sampling/warp_lanes.h"

WAVECREST_SIMD_BEGIN

// rho / (eta^2 (1 - X F_inside)): albedo of the base as seen through a boundary that lets everything pass.
template <class P, bool kTextured>
WAVECREST_INLINE Vec3<typename P::Real> baseAlbedo(const BsdfInput<P, kTextured>& input) {
  using Real = typename P::Real;
  const Real one(1);
  const Vec3<Real> rho = input.reflectance();
  const Real inside = to<Real>(input.at(input.materials->internalDiffuse));
  const Mask nonlinear = (input.flags & UInt(kNonlinear)) == UInt(kNonlinear);
  const Vec3<Real> again = select(nonlinear, rho, {one, one, one}) * inside;
  const Real inverseEta = reciprocal(input.eta());
  const Real inverseEta2 = inverseEta * inverseEta;
  return {rho.x * inverseEta2 * reciprocal(one - again.x), rho.y * inverseEta2 * reciprocal(one - again.y),
          rho.z * inverseEta2 * reciprocal(one - again.z)};
}

// Probability of the specular lobe where the boundary reflects the given share of the light.
template <class P, bool kTextured>
WAVECREST_INLINE typename P::Real specularProbability(const BsdfInput<P, kTextured>& input,
                                                      typename P::Real reflectance) {
  using Real = typename P::Real;
  const Real one(1);
  const Real weight = to<Real>(input.at(input.materials->specularPick));
  const Real specular = reflectance * weight, diffuse = (one - reflectance) * (one - weight);
  return specular * reciprocal(max(specular + diffuse, Real(1e-30f)));
}

struct PlasticBsdf {
  static constexpr BsdfKind kKind = BsdfKind::plastic;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = true;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const Mask front = (wi.z > zero) & (wo.z > zero);
    const Real wiFresnel = fresnelDielectric<P>(abs(wi.z), input.eta()).reflectance;
    const Real woFresnel = fresnelDielectric<P>(abs(wo.z), input.eta()).reflectance;
    const Real transmitted = (one - wiFresnel) * (one - woFresnel) * Real(kInvPi);
    const Real pdf = (one - specularProbability(input, wiFresnel)) * wo.z * Real(kInvPi);
    const Real pdfReverse = (one - specularProbability(input, woFresnel)) * wi.z * Real(kInvPi);
    return {zeroUnless(front, baseAlbedo(input) * transmitted), zeroUnless(front, pdf), zeroUnless(front, pdfReverse)};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const Real one(1), tiny(1e-30f);
    const Real wiFresnel = fresnelDielectric<P>(abs(wi.z), input.eta()).reflectance;
    const Real all = specularProbability(input, wiFresnel);
    const Real pick = input.lobes == Lobes::specularOnly ? one : all;
    const Mask specular = to<Real>(u.a) < pick;

    const Vec3<Real> diffuse = cosineHemisphere<Real>(to<Real>(u.b), to<Real>(u.c));
    const Real woFresnel = fresnelDielectric<P>(diffuse.z, input.eta()).reflectance;
    const Real notPicked = max(one - pick, tiny);
    const Vec3<Real> diffuseWeight =
        baseAlbedo(input) * ((one - wiFresnel) * (one - woFresnel) * reciprocal(notPicked));
    const Vec3<Real> specularWeight = input.specular() * (wiFresnel * reciprocal(max(pick, tiny)));
    const Real reversePick = specularProbability(input, woFresnel);
    return {.wo = select(specular, {-wi.x, -wi.y, wi.z}, diffuse),
            .weight = zeroUnless(wi.z > Real(0), select(specular, specularWeight, diffuseWeight)),
            .pdf = select(specular, pick, notPicked * diffuse.z * Real(kInvPi)),
            .pdfReverse = select(specular, pick, (one - reversePick) * abs(wi.z) * Real(kInvPi)),
            .etaRatio = one,
            .specular = specular};
  }
};

WAVECREST_SIMD_END
