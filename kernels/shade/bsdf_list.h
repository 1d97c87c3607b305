// The list of BSDFs. A new one is a file beside this, an include and a name here, and a kind in kernels/scene_view.h.
#pragma once

#include "kernels/shade/bsdf_conductor.h"
#include "kernels/shade/bsdf_dielectric.h"
#include "kernels/shade/bsdf_diffuse.h"
#include "kernels/shade/bsdf_phong.h"
#include "kernels/shade/bsdf_plastic.h"
#include "kernels/shade/bsdf_rough_conductor.h"
#include "kernels/shade/bsdf_rough_dielectric.h"
#include "kernels/shade/bsdf_rough_plastic.h"
#include "kernels/shade/bsdf_thin_dielectric.h"

WAVECREST_SIMD_BEGIN

template <class... Bsdfs>
struct BsdfList {};

using AllBsdfs = BsdfList<DiffuseBsdf, ConductorBsdf, DielectricBsdf, RoughConductorBsdf, ThinDielectricBsdf,
                          RoughDielectricBsdf, PlasticBsdf, RoughPlasticBsdf, PhongBsdf>;

WAVECREST_SIMD_END
