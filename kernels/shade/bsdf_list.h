// The list of BSDFs. A new one is a file beside this, an include and a name here, and a kind in kernels/scene_view.h.
#pragma once

WAVECREST_SIMD_BEGIN

template <class... Bsdfs>
struct BsdfList {};

using AllBsdfs = BsdfList<DiffuseBsdf>;

WAVECREST_SIMD_END
