// 4x4 matrices in double precision, acting on column vectors: what placing shapes, lights and cameras needs.
#pragma once

#include "engine/scene/vector_math.h"

namespace wavecrest {

Matrix4 identityMatrix();
Matrix4 multiply(const Matrix4& a, const Matrix4& b);
Matrix4 translation(const Double3& offset);
Matrix4 scaling(const Double3& factors);
Matrix4 rotation(const Double3& axis, double degrees);
// Camera space to world: +z from origin to target, +y near up, +x to the left (right-handed), as Mitsuba's look_at.
Matrix4 lookAt(const Double3& origin, const Double3& target, const Double3& up);

double determinant3(const Matrix4& m);  // of the linear part
// A matrix proportional to the inverse transpose of the linear part, for normals: the cofactors times the sign of the
// determinant. Needs no division, so it holds for singular matrices too.
Matrix4 normalMatrix(const Matrix4& m);
// Whether the linear part has an inverse, and both are numbers.
bool hasInverse(const Matrix4& m);
// Whether the linear part is a rotation, or a mirror image of one, times one scale, to within the rounding of numbers
// in a file.
bool isSimilarity(const Matrix4& m);
bool isFinite(const Matrix4& m);
bool isIdentity(const Matrix4& m);

}  // namespace wavecrest
