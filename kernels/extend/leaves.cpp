#include "kernels/extend/leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavecrest {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

size_t quadsAmong(const PrimitiveRecord<double>* primitives, size_t count) {
  size_t quads = 0;
  while (quads < count && static_cast<PrimitiveKind>(primitives[quads].kind) == PrimitiveKind::quad) ++quads;
  return quads;
}

FaceKind faceKindOf(uint32_t id) { return static_cast<FaceKind>(id >> kFaceKindShift); }

uint32_t makeId(size_t primitive, FaceKind kind) {
  return static_cast<uint32_t>(primitive) | static_cast<uint32_t>(kind) << kFaceKindShift;
}

Box boxOfCorners(const std::array<Corner, 3>& corners) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
    box.high[axis] = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
  }
  return box;
}
Box boxOfSphere(const PrimitiveRecord<double>& record) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::nextafter(static_cast<float>(record.p0[axis] - record.e1[0]), -kUnbounded);
    box.high[axis] = std::nextafter(static_cast<float>(record.p0[axis] + record.e1[0]), kUnbounded);
  }
  return box;
}

}  // namespace

Box unionOf(const Box* boxes, size_t count) {
  Box all = boxes[0];
  for (size_t i = 1; i < count; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      all.low[axis] = std::min(all.low[axis], boxes[i].low[axis]);
      all.high[axis] = std::max(all.high[axis], boxes[i].high[axis]);
    }
  }
  return all;
}

LeafMaker::LeafMaker(const PrimitiveRecord<double>* primitives, size_t count)
    : primitives_(primitives), weld_(primitives, quadsAmong(primitives, count)) {
  faces_.ids.reserve(count);
  faces_.boxes.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    switch (static_cast<PrimitiveKind>(primitives[i].kind)) {
      case PrimitiveKind::triangle:
        addFace(i, FaceKind::triangle);
        break;
      case PrimitiveKind::quad:
        addFace(i, FaceKind::lowerHalf);
        addFace(i, FaceKind::upperHalf);
        break;
      case PrimitiveKind::sphere:
        spheres_.ids.push_back(makeId(i, FaceKind::sphere));
        spheres_.boxes.push_back(boxOfSphere(primitives[i]));
        break;
    }
  }
}

void LeafMaker::addFace(size_t primitive, FaceKind kind) {
  faces_.ids.push_back(makeId(primitive, kind));
  faces_.boxes.push_back(boxOfCorners(cornersOf(faces_.ids.back())));
}

LeafMaker::Triangle LeafMaker::cornersOf(uint32_t id) const {
  const auto& record = primitives_[id & kFacePrimitiveMask];
  const auto at = [&](double u, double v) { return weld_(cornerAt(record, u, v)); };
  if (faceKindOf(id) == FaceKind::lowerHalf) return {at(0, 0), at(1, 0), at(1, 1)};
  if (faceKindOf(id) == FaceKind::upperHalf) return {at(0, 0), at(1, 1), at(0, 1)};
  return {at(0, 0), at(1, 0), at(0, 1)};
}

FaceLeaf LeafMaker::faceLeaf(const uint32_t* items, size_t count) const {
  FaceLeaf leaf;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const uint32_t id = leaf.id[slot] = faces_.ids[items[std::min(slot, count - 1)]];
    const Triangle corners = cornersOf(id);
    for (size_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3; ++axis) leaf.corner[k][axis][slot] = corners[k][axis];
    }
  }
  return leaf;
}

SphereLeaf LeafMaker::sphereLeaf(const uint32_t* items, size_t count) const {
  SphereLeaf leaf;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const uint32_t id = leaf.id[slot] = spheres_.ids[items[std::min(slot, count - 1)]];
    const auto& record = primitives_[id & kFacePrimitiveMask];
    for (size_t axis = 0; axis < 3; ++axis) leaf.center[axis][slot] = static_cast<float>(record.p0[axis]);
    leaf.radius[slot] = static_cast<float>(record.e1[0]);
  }
  return leaf;
}

double rayReach(const Box& scene, const double (&eye)[3]) {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double low = std::min(eye[axis], double{scene.low[axis]});
    const double high = std::max(eye[axis], double{scene.high[axis]});
    reach = std::max({reach, std::abs(low), std::abs(high), 3 * (high - low)});
  }
  return reach;
}

}  // namespace wavecrest
