#include "engine/compile/bounds.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/vector_math.h"

namespace wavecrest {

void Extent::include(const Double3& p) {
  for (size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], p[axis]);
    high[axis] = std::max(high[axis], p[axis]);
  }
}

void Extent::include(const Extent& other) {
  include(other.low);
  include(other.high);
}

template <class S>
void Extent::include(const PrimitiveRecord<S>& record) {
  const auto kind = static_cast<PrimitiveKind>(record.kind);
  for (size_t axis = 0; axis < 3; ++axis) {
    const double p = record.p0[axis];
    const auto add = [&](double x) {
      low[axis] = std::min(low[axis], x);
      high[axis] = std::max(high[axis], x);
    };
    if (kind == PrimitiveKind::sphere) {
      add(p - record.e1[0]);
      add(p + record.e1[0]);
      continue;
    }
    // The corners of a face; a quad has a fourth.
    const double u = p + record.e1[axis], v = p + record.e2[axis];
    for (const double x : {p, u, v}) add(x);
    if (kind == PrimitiveKind::quad) add(u + v - p);
  }
}
template void Extent::include(const PrimitiveRecord<float>&);
template void Extent::include(const PrimitiveRecord<double>&);

BoundingSphere Extent::sphere() const {
  BoundingSphere bounds;
  for (size_t axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = low[axis];
    bounds.high[axis] = high[axis];
    bounds.center[axis] = (low[axis] + high[axis]) / 2;
  }
  bounds.radius = length(high - low) / 2 * 1.0001;
  return bounds;
}

Box boxOf(const Extent& extent) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{};
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::nextafter(static_cast<float>(extent.low[axis]), -kInfinity);
    box.high[axis] = std::nextafter(static_cast<float>(extent.high[axis]), kInfinity);
  }
  return box;
}

Double3 originOf(const BoundingSphere& bounds) {
  constexpr double kFarRadii = 8;
  Double3 origin{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double center = bounds.center[axis];
    if (std::abs(center) > kFarRadii * bounds.radius) origin[axis] = static_cast<float>(center);
  }
  return origin;
}

}  // namespace wavecrest
