#include "engine/compile/material_kinds.h"

#include "engine/compile/materials.h"
#include "engine/compile/overloaded.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// Which kernel evaluates a BSDF: that of its roughness, microfacet distribution and anisotropy.
BsdfKind kindOf(const Diffuse&) { return BsdfKind::diffuse; }
BsdfKind kindOf(const Conductor& conductor) {
  if (conductor.alphaV) {
    return conductor.distribution == Distribution::ggx ? BsdfKind::anisotropicConductor
                                                       : BsdfKind::anisotropicBeckmannConductor;
  }
  if (isSmooth(conductor)) return BsdfKind::conductor;
  return conductor.distribution == Distribution::ggx ? BsdfKind::roughConductor : BsdfKind::beckmannConductor;
}
BsdfKind kindOf(const Dielectric& dielectric) {
  if (dielectric.thin) return BsdfKind::thinDielectric;
  if (dielectric.alphaV) {
    return dielectric.distribution == Distribution::ggx ? BsdfKind::anisotropicDielectric
                                                        : BsdfKind::anisotropicBeckmannDielectric;
  }
  if (isSmooth(dielectric)) return BsdfKind::dielectric;
  return dielectric.distribution == Distribution::ggx ? BsdfKind::roughDielectric : BsdfKind::beckmannDielectric;
}
BsdfKind kindOf(const Plastic& plastic) {
  if (isSmooth(plastic)) return BsdfKind::plastic;
  return plastic.distribution == Distribution::ggx ? BsdfKind::roughPlastic : BsdfKind::beckmannPlastic;
}
BsdfKind kindOf(const Phong&) { return BsdfKind::phong; }
BsdfKind kindOf(const Principled& principled) {
  return principled.thin ? BsdfKind::principledThin : BsdfKind::principled;
}

}  // namespace

uint32_t lobesOf(const Blend& blend, const Scene& scene, bool passes) {
  uint32_t lobes = 0;
  for (const uint32_t index : blend.materials) {
    const Material& part = scene.materials[index];
    if (passes && isIndexMatched(part)) continue;
    lobes |= lobesOf(kindOf(part, scene)) | (part.opacity && !passes ? kHasDelta : 0u);
  }
  return lobes;
}
BsdfKind kindOf(const Material& material, const Scene& scene, bool passes) {
  return std::visit(Overloaded{[&](const Blend& blend) {
                                 return (lobesOf(blend, scene, passes) & kHasFinite) != 0 ? BsdfKind::blend
                                                                                          : BsdfKind::deltaBlend;
                               },
                               [](const auto& bsdf) { return kindOf(bsdf); }},
                    material.kind);
}

uint32_t featureOf(BsdfKind kind) {
  if ((bitOf(kind) & kCompoundKinds) != 0) return kCompoundBsdfs | kLayeredBsdfs | kSpecularBsdfs;
  switch (kind) {
    case BsdfKind::diffuse:
      return 0;
    case BsdfKind::conductor:
    case BsdfKind::dielectric:
    case BsdfKind::roughConductor:
      return kSpecularBsdfs;
    default:
      return kLayeredBsdfs | kSpecularBsdfs;  // kernels with the second have the first
  }
}

uint32_t lobesOf(BsdfKind kind) {
  switch (kind) {
    case BsdfKind::conductor:
    case BsdfKind::dielectric:
    case BsdfKind::thinDielectric:
    case BsdfKind::deltaBlend:
      return kHasDelta;
    case BsdfKind::plastic:
      return kHasDelta | kHasFinite;
    default:
      return kHasFinite;
  }
}

}  // namespace wavecrest
