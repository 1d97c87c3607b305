// Three doubles with the arithmetic that mesh generation needs; files receive floats.
#pragma once

#include "kernels/double_vectors.h"

namespace wavecrest::generate {

using Vec3 = D3;
inline Vec3 normalize(const Vec3& a) { return normalized(a); }

}  // namespace wavecrest::generate
