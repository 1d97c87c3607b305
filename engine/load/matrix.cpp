#include "engine/load/matrix.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wavecrest {

Matrix4 identityMatrix() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}; }

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      for (size_t k = 0; k < 4; ++k) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

Matrix4 translation(const Double3& offset) {
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < 3; ++i) m[i][3] = offset[i];
  return m;
}

Matrix4 scaling(const Double3& factors) {
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < 3; ++i) m[i][i] = factors[i];
  return m;
}

// Rodrigues' formula: R = cos(a) I + (1 - cos(a)) n n^T + sin(a) [n]_x.
Matrix4 rotation(const Double3& axis, double degrees) {
  const Double3 n = normalized(axis);
  const double angle = degrees * (std::numbers::pi / 180), s = std::sin(angle), c = std::cos(angle);
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) m[i][j] = (1 - c) * n[i] * n[j] + (i == j ? c : 0);
  }
  for (size_t i = 0; i < 3; ++i) {
    m[(i + 1) % 3][(i + 2) % 3] -= s * n[i];
    m[(i + 2) % 3][(i + 1) % 3] += s * n[i];
  }
  return m;
}

Matrix4 lookAt(const Double3& origin, const Double3& target, const Double3& up) {
  const Double3 forward = normalized(target - origin), left = normalized(cross(up, forward)),
                newUp = cross(forward, left);
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < 3; ++i) {
    m[i][0] = left[i];
    m[i][1] = newUp[i];
    m[i][2] = forward[i];
    m[i][3] = origin[i];
  }
  return m;
}

double determinant3(const Matrix4& m) {
  const Double3 x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
  return dot(cross(x, y), z);
}

Matrix4 normalMatrix(const Matrix4& m) {
  const Double3 x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
  const double sign = determinant3(m) < 0 ? -1 : 1;
  const Double3 columns[3] = {sign * cross(y, z), sign * cross(z, x), sign * cross(x, y)};
  Matrix4 normal = identityMatrix();
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) normal[i][j] = columns[j][i];
  }
  return normal;
}

bool isFinite(const Matrix4& m) {
  return std::all_of(m.begin(), m.end(), [](const auto& row) {
    return std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
  });
}

bool hasInverse(const Matrix4& m) {
  // Next to the lengths of the columns a determinant this small is rounding.
  constexpr double kResidue = 1e-14;
  double size = 1;
  for (size_t j = 0; j < 3; ++j) size *= length(Double3{m[0][j], m[1][j], m[2][j]});
  const double determinant = determinant3(m);
  return isFinite(m) && std::abs(determinant) > kResidue * size && std::isfinite(1 / determinant);
}

bool isSimilarity(const Matrix4& m) {
  // The columns, the images of the axes, are perpendicular and of one length.
  constexpr double kTolerance = 1e-3;
  const auto product = [&](size_t i, size_t j) { return m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]; };
  const double length2 = (product(0, 0) + product(1, 1) + product(2, 2)) / 3;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      if (!(std::abs(product(i, j) - (i == j ? length2 : 0)) <= kTolerance * length2)) return false;
    }
  }
  return true;
}

bool isIdentity(const Matrix4& m) { return m == identityMatrix(); }

}  // namespace wavecrest
