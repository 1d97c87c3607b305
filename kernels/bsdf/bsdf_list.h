// The list of BSDFs. A new one is a file beside this, an include and a name here, and a kind in kernels/scene_view.h.
#pragma once

#include "kernels/bsdf/beckmann_lanes.h"
#include "kernels/bsdf/bsdf_conductor.h"
#include "kernels/bsdf/bsdf_dielectric.h"
#include "kernels/bsdf/bsdf_diffuse.h"
#include "kernels/bsdf/bsdf_phong.h"
#include "kernels/bsdf/bsdf_plastic.h"
#include "kernels/bsdf/bsdf_rough_conductor.h"
#include "kernels/bsdf/bsdf_rough_dielectric.h"
#include "kernels/bsdf/bsdf_rough_plastic.h"
#include "kernels/bsdf/bsdf_thin_dielectric.h"

WAVECREST_SIMD_BEGIN

template <class... Bsdfs>
struct BsdfList {};

using BeckmannConductorBsdf = RoughConductor<BeckmannNormals, BsdfKind::beckmannConductor, kLayeredBsdfs>;
using BeckmannDielectricBsdf = RoughDielectric<BeckmannNormals, BsdfKind::beckmannDielectric>;
using BeckmannPlasticBsdf = RoughPlastic<BeckmannNormals, BsdfKind::beckmannPlastic>;

using AllBsdfs = BsdfList<DiffuseBsdf, ConductorBsdf, DielectricBsdf, RoughConductorBsdf, ThinDielectricBsdf,
                          RoughDielectricBsdf, PlasticBsdf, RoughPlasticBsdf, PhongBsdf, BeckmannConductorBsdf,
                          BeckmannDielectricBsdf, BeckmannPlasticBsdf>;

WAVECREST_SIMD_END
