// Passages: how much light goes straight on through a surface, as if it were not there (METHODS 3.10). A mask lets
// through what its opacity leaves, a boundary between equal indices everything but what tints it, a blend the sum of
// what its parts do.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/surface/texture_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct Passage {
  Real stop;          // the probability that a walk meets the surface instead of passing
  Vec3<Real> colour;  // of the light that passes, over that which arrives
};

// Lanes whose materials have passages. The others stop every walk and all light.
template <class S>
WAVECREST_INLINE Mask passesLight(const SceneView<S>& scene, UInt material) {
  return (MaterialLanes(scene, material)(scene.materials->flags) & UInt(kPasses)) == UInt(kPasses);
}

// Of materials that are no blends, at texture coordinates (u, v). The scene has passages.
template <class P>
WAVECREST_INLINE Passage<typename P::Real> passageOfOne(const SceneView<typename P::Storage>& scene, UInt material,
                                                        Float u, Float v) {
  const PassageRecord& fields = *scene.passages;
  const RecordLanes<PassageRecord> at(scene.passages, material);
  const auto factor = [&](const uint32_t& slot)
                          WAVECREST_LAMBDA { return textureFactor(scene.textures, scene.texels, at(slot), u, v); };
  const Float zero(0), one(1);
  const Float opacity = min(max(at(fields.opacity) * factor(fields.opacityTexture).x, zero), one);
  const Mask matched = at(fields.matched) == UInt(1u);
  const Vec3<Float> tint = at(fields.tint) * factor(fields.tintTexture) * zeroUnless(matched, opacity);
  const Float absent = one - opacity;
  return {to<typename P::Real>(select(matched, zero, opacity)),
          to<typename P::Real>(tint + Vec3<Float>{absent, absent, absent})};
}

// Of any material; of those without passages everything stops. In bsdf_complete.cpp, which knows blends.
template <class P>
Passage<typename P::Real> passageOf(const SceneView<typename P::Storage>& scene, UInt material, Mask active, Float u,
                                    Float v);

WAVECREST_SIMD_END
