// The values of a material's textures, for the BSDFs of feature sets with textures.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/surface/texture_lanes.h"

WAVECREST_SIMD_BEGIN

template <class P>
WAVECREST_INLINE void readTextureFactors(const SceneView<typename P::Storage>& scene, BsdfInput<P, true>& input,
                                         Float u, Float v) {
  using Real = typename P::Real;
  const MaterialRecord& slots = *scene.materials;
  const auto factor = [&](const uint32_t& slot) WAVECREST_LAMBDA {
    return to<Real>(textureFactor(scene.textures, scene.texels, input.at(slot), u, v));
  };
  input.textures.reflectance = factor(slots.reflectanceTexture);
  input.textures.specular = factor(slots.specularTexture);
  input.textures.transmittance = factor(slots.transmittanceTexture);
  input.textures.alpha = factor(slots.alphaTexture).x;
  input.textures.opacity = factor(slots.opacityTexture).x;
}

WAVECREST_SIMD_END
