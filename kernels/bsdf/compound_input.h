// What compound BSDFs may ask about the surface: besides what others may, the numbers of their CompoundRecord, the
// direction of dp/du, and other materials at the same place, which a blend is made of.
#pragma once

#include "kernels/bsdf/bsdf_textures.h"

WAVECREST_SIMD_BEGIN

// Of the feature sets with compound BSDFs. A BSDF of another kind sees the BsdfInput in it.
template <class P>
struct CompoundInput : BsdfInput<P, true> {
  using Real = typename P::Real;
  const SceneView<typename P::Storage>* scene;
  RecordLanes<CompoundRecord> compound;
  Float u, v;               // texture coordinates
  Real tangentX, tangentY;  // dp/du in the shading frame, unit

  WAVECREST_INLINE CompoundInput(const SceneView<typename P::Storage>& view, UInt material)
      : BsdfInput<P, true>(view, material),
        scene(&view),
        compound(view.compounds, material),
        u(Float(0)),
        v(Float(0)),
        tangentX(Real(1)),
        tangentY(Real(0)) {}

  WAVECREST_INLINE void setTangent(Vec3<Real> dpDu, const Frame<Real>& frame) {
    const Real x = dot(dpDu, frame.s), y = dot(dpDu, frame.t);
    const Real inverse = Real(1) / sqrt(max(mulAdd(x, x, y * y), Real(1e-30f)));
    tangentX = x * inverse;
    tangentY = y * inverse;
  }
  // From the shading frame to the one with x along dp/du, and back.
  WAVECREST_INLINE Vec3<Real> toTangent(Vec3<Real> w) const {
    return {mulAdd(w.x, tangentX, w.y * tangentY), mulSub(w.y, tangentX, w.x * tangentY), w.z};
  }
  WAVECREST_INLINE Vec3<Real> fromTangent(Vec3<Real> w) const {
    return {mulSub(w.x, tangentX, w.y * tangentY), mulAdd(w.x, tangentY, w.y * tangentX), w.z};
  }

  // A parameter within [0, most]. Only for lanes of compound BSDFs; the others get any number.
  WAVECREST_INLINE Real parameter(CompoundParameter name, float most = 1) const {
    const auto k = static_cast<size_t>(name);
    const CompoundRecord& fields = *scene->compounds;
    const Float factor = textureFactor(scene->textures, scene->texels, compound(fields.texture[k]), u, v).x;
    return to<Real>(min(max(compound(fields.value[k]) * factor, Float(0)), Float(most)));
  }

  // Another material at the same place, seen by the same walk.
  WAVECREST_INLINE CompoundInput part(UInt material) const {
    CompoundInput other(*scene, material);
    other.walk = this->walk;
    other.lobes = this->lobes;
    other.u = u;
    other.v = v;
    other.tangentX = tangentX;
    other.tangentY = tangentY;
    readTextureFactors<P>(*scene, other, u, v);
    return other;
  }
};

WAVECREST_SIMD_END
