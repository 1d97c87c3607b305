#include "kernels/extend/small_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wavecrest {
namespace {

using D3 = std::array<double, 3>;

D3 vec(const double (&a)[3]) { return {a[0], a[1], a[2]}; }
double dot(const D3& a, const D3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
D3 cross(const D3& a, const D3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
D3 scaled(const D3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }

void assign(float (&out)[3], const D3& a) {
  for (size_t i = 0; i < 3; ++i) out[i] = static_cast<float>(a[i]);
}

// Bound on the rounding error of axis . p + offset for points with coordinates up to `reach`: the point itself carries
// some 8 roundings from origin + t direction with an approximate t, the sum 4 more.
double coordinateError(const D3& axis, double offset, double reach) {
  const double magnitude = (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2])) * reach + std::abs(offset);
  return 16 * 0x1p-24 * magnitude;
}

}  // namespace

SmallScene::SmallScene(const PrimitiveRecord<double>* primitives, size_t count) {
  double reach = 0;
  for (size_t i = 0; i < count; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto& p = primitives[i];
      reach = std::max(reach, std::abs(p.p0[axis]) + std::abs(p.e1[axis]) + std::abs(p.e2[axis]));
    }
  }
  for (size_t i = 0; i < count; ++i) {
    const auto& primitive = primitives[i];
    switch (static_cast<PrimitiveKind>(primitive.kind)) {
      case PrimitiveKind::quad:
        ++view_.quadCount;
        break;
      case PrimitiveKind::triangle:
        ++view_.triangleCount;
        break;
      case PrimitiveKind::sphere:
        ++view_.sphereCount;
        break;
    }
    if (static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::sphere) {
      SphereForm& sphere = spheres_.emplace_back();
      assign(sphere.center, vec(primitive.p0));
      sphere.radius = static_cast<float>(primitive.e1[0]);
    } else {
      addPlane(primitive, reach);
    }
  }
  view_.planes = planes_.data();
  view_.limits = limits_.data();
  view_.spheres = spheres_.data();
}

void SmallScene::addPlane(const PrimitiveRecord<double>& primitive, double reach) {
  const D3 p0 = vec(primitive.p0), e1 = vec(primitive.e1), e2 = vec(primitive.e2), n = vec(primitive.normal);
  // The dual basis of (e1, e2) in the plane: uAxis . e1 = 1, uAxis . e2 = 0.
  const D3 acrossU = cross(e2, n), acrossV = cross(n, e1);
  D3 uAxis = scaled(acrossU, 1 / dot(e1, acrossU)), vAxis = scaled(acrossV, 1 / dot(e2, acrossV));
  double uOffset = -dot(uAxis, p0), vOffset = -dot(vAxis, p0);
  const double uError = coordinateError(uAxis, uOffset, reach), vError = coordinateError(vAxis, vOffset, reach);

  const double gapError = 4 * 0x1p-24 * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2])) * reach;
  PlaneLimits& limits = limits_.emplace_back();
  limits.grazing =
      static_cast<float>(4 * gapError * std::max(std::sqrt(dot(uAxis, uAxis)), std::sqrt(dot(vAxis, vAxis))));
  limits.margin = static_cast<float>(2 * std::max(uError, vError));
  if (static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::quad) {
    const double uHalf = 0.5 + uError, vHalf = 0.5 + vError;
    uAxis = scaled(uAxis, 1 / uHalf);
    vAxis = scaled(vAxis, 1 / vHalf);
    uOffset = (uOffset - 0.5) / uHalf;
    vOffset = (vOffset - 0.5) / vHalf;
    limits.uScale = static_cast<float>(uHalf);
    limits.vScale = static_cast<float>(vHalf);
  }
  PlaneForm& plane = planes_.emplace_back();
  assign(plane.normal, n);
  plane.distance = static_cast<float>(dot(n, p0));
  assign(plane.uAxis, uAxis);
  assign(plane.vAxis, vAxis);
  plane.uOffset = static_cast<float>(uOffset);
  plane.vOffset = static_cast<float>(vOffset);
}

}  // namespace wavecrest
