// Materials to the records that BSDF kernels read.
#pragma once

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// What a material asks of the kernels: Feature bits (kernels/stages.h).
uint32_t materialFeatures(const Material& material, const Scene& scene);

// Whether the direction of dp/du matters to it.
bool isAnisotropic(const Material& material, const Scene& scene);

// Whether the BSDF's microfacet lobes are compiled as deltas, because their roughness is nearly zero. A textured or
// anisotropic roughness never is.
bool isSmooth(const Conductor& conductor);
bool isSmooth(const Dielectric& dielectric);
bool isSmooth(const Plastic& plastic);

// The scene is read for the means of textures, which decide how often a lobe is sampled, and for their greatest values,
// which limit plastic and phong. Throws SceneError for a nonlinear plastic that is too bright. passes: light goes
// straight on through it (passages.h), so the record is that of the rest of the surface.
MaterialRecord compileMaterial(const Material& material, const Scene& scene, bool passes = false);
// Parameters that only compound BSDFs have; empty for other materials.
CompoundRecord compileCompound(const Material& material);

// A smooth boundary between equal indices, which neither reflects nor bends light.
bool isIndexMatched(const Material& material);

// Reflectance of a smooth dielectric boundary for diffuse light: INT_0^1 F(c, eta) 2 c dc, by quadrature; eta is the
// index beyond the boundary over the index on the light's side.
double diffuseFresnelReflectance(double eta);

}  // namespace wavecrest
