// The contract between stages and BSDFs.
//
// A BSDF works in the shading frame (z along the shading normal, on the side that the material calls outside): `wi`
// points back along the path, `wo` is the generated direction, both away from the surface. f contains no cosine.
// Densities are per solid angle, lobe choice included, roulette not.
//
// f is the radiance BSDF from the light's side to the eye's side; which of wi and wo is which follows from the walk.
// Only refraction tells the two apart: f(l, e) / eta_e^2 = f(e, l) / eta_l^2 (Veach 1997, 5.2).
//
// A kind is a struct with
//   static constexpr BsdfKind kKind;
//   static constexpr uint32_t kFeature;  // Feature bit that its kernels need; 0: part of every feature set
//   static constexpr bool kHasDelta;     // may sample a delta lobe
//   template <class P, bool kTextured>
//   static BsdfValue<Real> eval(const BsdfInput<P, kTextured>&, Vec3<Real> wi, Vec3<Real> wo);
//   template <class P, bool kTextured>
//   static BsdfSample<Real> sample(const BsdfInput<P, kTextured>&, Vec3<Real> wi, const Uniform4& u);
// in a file of its own, and a place in bsdf_list.h. eval covers the non-delta lobes only. sample uses u.a, u.b and u.c;
// u.d is left to roulette. Where wi or wo lie on sides that the BSDF does not join, the weight and f are zero and the
// densities are meaningless but finite. A draw that fails, because it leads to the wrong side, has a pdf of zero; a
// weight of zero does not tell, for black lobes have it always.
#pragma once

#include <type_traits>

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct BsdfValue {
  Vec3<Real> f;
  Real pdf;         // of wo given wi
  Real pdfReverse;  // of wi given wo
};

template <class Real>
struct BsdfSample {
  Vec3<Real> wo;
  Vec3<Real> weight;     // f |cos wo| / pdf; for a delta lobe its albedo over the lobe's probability
  Real pdf, pdfReverse;  // of a delta lobe: discrete probabilities
  Real etaRatio;         // eta_wi / eta_wo: 1 unless refracted
  Mask specular;         // a delta lobe was taken
  Mask absent = {};      // of these: the surface is absent (opacity_lanes.h)
};

// Which lobes sample() chooses from. specularOnly: the delta lobes, with their probabilities renormalised.
enum class Lobes { all, specularOnly };

// Values of the textures in a material's slots: 1 where a slot has none.
template <class Real>
struct TextureFactors {
  Vec3<Real> reflectance, specular, transmittance;
  Real alpha, opacity;
};
// The same in feature sets without textures, where constants stand alone.
struct NoTextureFactors {};

// What a BSDF may ask about the surface. Constants come from the material record of each lane; with kTextured they are
// multiplied by textures.
template <class P, bool kTextured>
struct BsdfInput {
  using Real = typename P::Real;
  const MaterialRecord* materials;
  MaterialLanes at;
  uint32_t kinds;  // SceneView::bsdfKinds
  UInt kind, flags;
  Walk walk = Walk::camera;  // from the eye, so that wo points to the light's side, or from a light
  Lobes lobes = Lobes::all;
  std::conditional_t<kTextured, TextureFactors<Real>, NoTextureFactors> textures;

  WAVECREST_INLINE BsdfInput(const SceneView<typename P::Storage>& scene, UInt index)
      : materials(scene.materials), at(scene, index), kinds(scene.bsdfKinds) {
    kind = at(materials->kind);
    const FourColumns<Float> first = at.four(materials->reflectance[0]);
    albedo_ = {first.a, first.b, first.c};
    flags = bits(first.d);
    if constexpr (kTextured) {
      const Real one(1);
      textures.reflectance = textures.specular = textures.transmittance = {one, one, one};
      textures.alpha = textures.opacity = one;
    }
  }
  WAVECREST_INLINE Vec3<Real> reflectance() const {
    const auto constant = to<Real>(albedo_);
    if constexpr (kTextured) return constant * textures.reflectance;
    return constant;
  }
  WAVECREST_INLINE Vec3<Real> specular() const {
    const auto constant = to<Real>(at(materials->specular));
    if constexpr (kTextured) return constant * textures.specular;
    return constant;
  }
  WAVECREST_INLINE Vec3<Real> transmittance() const {
    const auto constant = to<Real>(at(materials->transmittance));
    if constexpr (kTextured) return constant * textures.transmittance;
    return constant;
  }
  WAVECREST_INLINE Real alpha() const {
    const auto constant = to<Real>(at(materials->alpha));
    if constexpr (kTextured) return constant * textures.alpha;
    return constant;
  }
  // Interior over exterior index of a dielectric boundary.
  WAVECREST_INLINE Real eta() const { return to<Real>(at(materials->eta[0])); }
  WAVECREST_INLINE Real opacity() const {
    const auto constant = to<Real>(at(materials->opacity));
    if constexpr (kTextured) return min(max(constant * textures.opacity, Real(0)), Real(1));
    return constant;
  }

 private:
  Vec3<Float> albedo_;  // diffuse reflectance of the record
};

// Vertices whose BSDF has more than delta lobes: only those can be joined by next event, connections and merges.
WAVECREST_INLINE Mask hasNonDeltaLobes(UInt kind) {
  const auto is = [kind](BsdfKind k) WAVECREST_LAMBDA { return kind == UInt(static_cast<uint32_t>(k)); };
  return !(is(BsdfKind::conductor) | is(BsdfKind::dielectric) | is(BsdfKind::thinDielectric) |
           is(BsdfKind::deltaBlend));
}

// Real zero in all fields.
template <class Real>
WAVECREST_INLINE BsdfValue<Real> zeroBsdfValue() {
  const Real zero(0);
  return {{zero, zero, zero}, zero, zero};
}

// What kinds with nothing but delta lobes derive from.
struct DeltaLobes {
  static constexpr bool kHasDelta = true;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>&, Vec3<typename P::Real>,
                                                           Vec3<typename P::Real>) {
    return zeroBsdfValue<typename P::Real>();
  }
};

// Change of radiance across a refracting boundary, in the direction of a camera walk; a light walk carries power, which
// does not change (Veach 1997, 5.2).
template <class P, bool kTextured>
WAVECREST_INLINE typename P::Real radianceScale(const BsdfInput<P, kTextured>& input, typename P::Real etaRatio) {
  return input.walk == Walk::camera ? etaRatio * etaRatio : typename P::Real(1);
}

WAVECREST_SIMD_END
