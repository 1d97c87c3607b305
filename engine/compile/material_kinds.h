// Which kernel evaluates a material, and what lobes that kernel has.
#pragma once

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// By its roughness, distribution and anisotropy, or by the lobes of a blend. passes: as in compileMaterial.
BsdfKind kindOf(const Material& material, const Scene& scene, bool passes = false);

// Feature bits of the kernels that have a BSDF.
uint32_t featureOf(BsdfKind kind);

// The lobes of a BSDF itself: kHasDelta and kHasFinite.
uint32_t lobesOf(BsdfKind kind);
// The lobes of all parts of a blend together: kHasDelta and kHasFinite. passes: without what lets light straight on.
uint32_t lobesOf(const Blend& blend, const Scene& scene, bool passes);

}  // namespace wavecrest
