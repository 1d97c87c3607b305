#include "kernels/extend/leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wavecrest {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

// All quads of the source in one array, as CornerWeld takes them.
std::vector<PrimitiveRecord<double>> quadsOf(const PrimitiveSource& primitives) {
  std::vector<PrimitiveRecord<double>> quads(primitives.quads.count);
  for (size_t i = 0; i < quads.size(); ++i) quads[i] = primitives.at(primitives.quads.first + i);
  return quads;
}

// The ids of FaceLeaf and SphereLeaf: the index of the primitive, with the FaceKind in the upper two bits.
FaceKind faceKindOf(uint32_t id) { return static_cast<FaceKind>(id >> kFaceKindShift); }

uint32_t makeId(size_t primitive, FaceKind kind) {
  return static_cast<uint32_t>(primitive) | static_cast<uint32_t>(kind) << kFaceKindShift;
}

// A triangle with its box. The corners are in float already, so the box is exact.
Piece pieceOf(uint32_t id, const std::array<Corner, 3>& corners) {
  Piece piece{.low = {}, .id = id, .high = {}, .unused = 0};
  for (size_t axis = 0; axis < 3; ++axis) {
    piece.low[axis] = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
    piece.high[axis] = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
  }
  return piece;
}
// A sphere (centre p0, radius e1.x) with its box, rounded outwards.
Piece pieceOf(uint32_t id, const PrimitiveRecord<double>& sphere) {
  Piece piece{.low = {}, .id = id, .high = {}, .unused = 0};
  for (size_t axis = 0; axis < 3; ++axis) {
    piece.low[axis] = std::nextafter(static_cast<float>(sphere.p0[axis] - sphere.e1[0]), -kUnbounded);
    piece.high[axis] = std::nextafter(static_cast<float>(sphere.p0[axis] + sphere.e1[0]), kUnbounded);
  }
  return piece;
}

}  // namespace

// count: at least 1.
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

Box boxAt(const double (&point)[3]) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) box.low[axis] = box.high[axis] = static_cast<float>(point[axis]);
  return box;
}

// Only corners of quads become points of the weld. Corners of all faces are moved to these points (corner_weld.h).
LeafMaker::LeafMaker(PrimitiveSource primitives, const ParallelFor& parallelFor)
    : primitives_(std::move(primitives)),
      weld_(quadsOf(primitives_)),
      faces_(2 * primitives_.quads.count + primitives_.triangles.count),
      spheres_(primitives_.spheres.count) {
  const auto [firstQuad, quads] = primitives_.quads;
  const auto [firstTriangle, triangles] = primitives_.triangles;
  const auto [firstSphere, spheres] = primitives_.spheres;
  // Boxes are made from the welded corners, which are the corners that leaves hold.
  const auto piece = [this](size_t primitive, FaceKind kind) {
    const uint32_t id = makeId(primitive, kind);
    return pieceOf(id, cornersOf(id));
  };
  // Two pieces for each quad come first in `faces_`, then the triangles. Spheres have pieces of their own.
  forEachRange(parallelFor, quads, [&, first = firstQuad](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      faces_.begin()[2 * i] = piece(first + i, FaceKind::lowerHalf);
      faces_.begin()[2 * i + 1] = piece(first + i, FaceKind::upperHalf);
    }
  });
  Piece* const ofTriangles = faces_.begin() + 2 * quads;
  forEachRange(parallelFor, triangles, [&, first = firstTriangle](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) ofTriangles[i] = piece(first + i, FaceKind::triangle);
  });
  forEachRange(parallelFor, spheres, [&, first = firstSphere](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      spheres_.begin()[i] = pieceOf(makeId(first + i, FaceKind::sphere), primitives_.at(first + i));
    }
  });
}

// The welded corners of a triangle, or of one half of a quad with the quad's own corner as the second one
// (intersectFaces). Their order fits coordinatesInFace (face_coordinates.h), which makes (u, v) from the weights of the
// second and third corner.
LeafMaker::Triangle LeafMaker::cornersOf(uint32_t id) const {
  const PrimitiveRecord<double> record = primitives_.at(id & kFacePrimitiveMask);
  const double edge2 = shortestEdge2(record);
  // A quad is cut along its diagonal from (0, 0) to (1, 1).
  const auto at = [&](double u, double v) { return weld_(cornerAt(record, u, v), edge2); };
  if (faceKindOf(id) == FaceKind::lowerHalf) return {at(0, 0), at(1, 0), at(1, 1)};
  if (faceKindOf(id) == FaceKind::upperHalf) return {at(1, 1), at(0, 1), at(0, 0)};
  return {at(0, 0), at(1, 0), at(0, 1)};
}

FaceLeaf LeafMaker::faceLeaf(const uint32_t* ids, size_t count) const {
  FaceLeaf leaf;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const size_t from = std::min(slot, count - 1);
    leaf.id[slot] = ids[from];
    // Slots past the last piece repeat it.
    if (from < slot) {
      for (auto& corner : leaf.corner) {
        for (auto& axis : corner) axis[slot] = axis[from];
      }
      continue;
    }
    const Triangle corners = cornersOf(ids[slot]);
    for (size_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3; ++axis) leaf.corner[k][axis][slot] = corners[k][axis];
    }
  }
  return leaf;
}

SphereLeaf LeafMaker::sphereLeaf(const uint32_t* ids, size_t count) const {
  SphereLeaf leaf;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const uint32_t id = leaf.id[slot] = ids[std::min(slot, count - 1)];
    const PrimitiveRecord<double> record = primitives_.at(id & kFacePrimitiveMask);
    for (size_t axis = 0; axis < 3; ++axis) leaf.center[axis][slot] = static_cast<float>(record.p0[axis]);
    leaf.radius[slot] = static_cast<float>(record.e1[0]);
  }
  return leaf;
}

double rayReach(const Box& scene, const Box& origins) {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double low = std::min(origins.low[axis], scene.low[axis]);
    const double high = std::max(origins.high[axis], scene.high[axis]);
    reach = std::max({reach, std::abs(low), std::abs(high), 3 * (high - low)});
  }
  return reach;
}

}  // namespace wavecrest
