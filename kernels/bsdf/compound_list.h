// The list of compound BSDFs, which bsdf_complete.cpp alone knows. Blends are no kinds of their own here.
#pragma once

#include "kernels/bsdf/bsdf_anisotropic.h"
#include "kernels/bsdf/bsdf_list.h"
#include "kernels/bsdf/bsdf_principled.h"
#include "kernels/bsdf/bsdf_principled_thin.h"

WAVECREST_SIMD_BEGIN

using CompoundBsdfs = BsdfList<AnisotropicConductor, AnisotropicDielectric, AnisotropicBeckmannConductor,
                               AnisotropicBeckmannDielectric, PrincipledBsdf, PrincipledThinBsdf>;

WAVECREST_SIMD_END
