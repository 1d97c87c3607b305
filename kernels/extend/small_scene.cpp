#include "kernels/extend/small_scene.h"

#include <algorithm>

#include "kernels/extend/find_boxes.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Bound on the rounding error of axis . p + offset for points with coordinates up to `reach`: the point itself carries
// some 8 roundings from origin + t direction with an approximate t, the sum 4 more.
double coordinateError(const D3& axis, double offset, double reach) {
  const double magnitude = (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2])) * reach + std::abs(offset);
  return 16 * kUnitRoundoff * magnitude;
}
// The same of a distance from a plane, at the ray's origin.
double gapError(const D3& normal, double reach) {
  return 4 * kUnitRoundoff * (std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2])) * reach;
}

PrimitiveKind kindOf(const PrimitiveRecord<double>& primitive) { return static_cast<PrimitiveKind>(primitive.kind); }

double reachOf(const PrimitiveRecord<double>* primitives, size_t count) {
  double reach = 0;
  for (size_t i = 0; i < count; ++i) {
    const auto& p = primitives[i];
    for (size_t axis = 0; axis < 3; ++axis) {
      reach = std::max(reach, std::abs(p.p0[axis]) + std::abs(p.e1[axis]) + std::abs(p.e2[axis]));
    }
  }
  return reach;
}

// The dual basis of (e1, e2) in the plane: u . e1 = 1, u . e2 = 0; both are 0 at p0.
struct DualBasis {
  D3 u, v;
  double uOffset, vOffset;
};
DualBasis dualBasis(const PrimitiveRecord<double>& primitive) {
  const D3 e1 = vec(primitive.e1), e2 = vec(primitive.e2), n = vec(primitive.normal), p0 = vec(primitive.p0);
  const D3 acrossU = cross(e2, n), acrossV = cross(n, e1);
  const D3 u = acrossU * (1 / dot(e1, acrossU)), v = acrossV * (1 / dot(e2, acrossV));
  return {u, v, -dot(u, p0), -dot(v, p0)};
}

FaceCoordinates inFloat(const DualBasis& basis) {
  FaceCoordinates coordinates;
  assign(coordinates.uAxis, basis.u);
  assign(coordinates.vAxis, basis.v);
  coordinates.uOffset = static_cast<float>(basis.uOffset);
  coordinates.vOffset = static_cast<float>(basis.vOffset);
  return coordinates;
}

}  // namespace

SmallScene::SmallScene(const PrimitiveRecord<double>* primitives, size_t count) {
  const double reach = reachOf(primitives, count);
  const auto ofKind = [&](PrimitiveKind kind) {
    return static_cast<uint32_t>(
        std::count_if(primitives, primitives + count, [kind](const auto& p) { return kindOf(p) == kind; }));
  };
  view_.firstTriangle = ofKind(PrimitiveKind::quad);
  view_.triangleCount = ofKind(PrimitiveKind::triangle);
  view_.firstSphere = view_.firstTriangle + view_.triangleCount;
  view_.sphereCount = ofKind(PrimitiveKind::sphere);

  std::vector<bool> inBox(count, false);
  std::vector<FoundBox> boxes = findBoxes(primitives, view_.firstTriangle);
  for (const bool open : {false, true}) {
    for (const FoundBox& box : boxes) {
      if (box.open() != open) continue;
      ++(open ? view_.openBoxCount : view_.closedBoxCount);
      addBox(box, reach);
      box.forEachQuad([&inBox](uint32_t quad) { inBox[quad] = true; });
    }
  }
  for (uint32_t i = 0; i < view_.firstSphere; ++i) {
    coordinates_.push_back(inFloat(dualBasis(primitives[i])));
    if (!inBox[i]) addPlane(primitives[i], i, reach);
  }
  view_.quadCount = static_cast<uint32_t>(planes_.size()) - view_.triangleCount;
  for (size_t i = view_.firstSphere; i < count; ++i) {
    SphereForm& sphere = spheres_.emplace_back();
    assign(sphere.center, vec(primitives[i].p0));
    sphere.radius = static_cast<float>(primitives[i].e1[0]);
  }
  view_.boxes = boxes_.data();
  view_.planes = planes_.data();
  view_.limits = limits_.data();
  view_.coordinates = coordinates_.data();
  view_.spheres = spheres_.data();
}

void SmallScene::addBox(const FoundBox& box, double reach) {
  BoxForm& form = boxes_.emplace_back();
  for (size_t axis = 0; axis < 3; ++axis) {
    SlabForm& slab = form.slabs[axis];
    // Faces reach out of an open side, so that they overlap whatever closes it.
    const double overlap = axis == 2 && box.open() ? 4 * gapError(box.normal[axis], reach) : 0;
    assign(slab.normal, box.normal[axis]);
    slab.low = static_cast<float>(box.low[axis]);
    slab.high = static_cast<float>(box.high[axis] + overlap);
    std::copy_n(box.quad[axis], 2, form.primitives[axis]);
  }
}

void SmallScene::addPlane(const PrimitiveRecord<double>& primitive, uint32_t index, double reach) {
  const D3 n = vec(primitive.normal);
  DualBasis basis = dualBasis(primitive);
  const double uError = coordinateError(basis.u, basis.uOffset, reach);
  const double vError = coordinateError(basis.v, basis.vOffset, reach);
  PlaneLimits& limits = limits_.emplace_back();
  limits.primitive = index;
  limits.grazing = static_cast<float>(4 * gapError(n, reach) * std::max(length(basis.u), length(basis.v)));
  limits.least = static_cast<float>(-2 * std::max(uError, vError));
  if (kindOf(primitive) == PrimitiveKind::quad) {
    const double uHalf = 0.5 + uError, vHalf = 0.5 + vError;
    basis = {basis.u * (1 / uHalf), basis.v * (1 / vHalf), (basis.uOffset - 0.5) / uHalf,
             (basis.vOffset - 0.5) / vHalf};
  }
  PlaneForm& plane = planes_.emplace_back();
  assign(plane.normal, n);
  plane.distance = static_cast<float>(dot(n, vec(primitive.p0)));
  plane.inside = inFloat(basis);
}

}  // namespace wavecrest
