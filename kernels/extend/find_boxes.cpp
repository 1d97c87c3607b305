#include "kernels/extend/find_boxes.h"

#include <optional>
#include <utility>

#include "kernels/extend/face_edges.h"

namespace wavecrest {
namespace {

// A parallelogram by its centre and two edges.
struct Quad {
  D3 center, e1, e2;
};
Quad quadOf(const PrimitiveRecord<double>& record) {
  const D3 e1 = vec(record.e1), e2 = vec(record.e2);
  return {vec(record.p0) + (e1 + e2) * 0.5, e1, e2};
}

// Whether two edges are the same or opposite vectors, coordinate by coordinate.
bool parallel(const D3& a, const D3& b, double tolerance) {
  return largest(a - b) <= tolerance || largest(a + b) <= tolerance;
}
// Whether two quads have the same corners, whatever their order.
bool coincide(const Quad& a, const Quad& b, double tolerance) {
  return largest(a.center - b.center) <= tolerance &&
         ((parallel(a.e1, b.e1, tolerance) && parallel(a.e2, b.e2, tolerance)) ||
          (parallel(a.e1, b.e2, tolerance) && parallel(a.e2, b.e1, tolerance)));
}

struct Parallelepiped {
  D3 center, edge[3];

  // The face across edge[axis], at its beginning (side 0) or its end (side 1).
  Quad face(size_t axis, size_t side) const {
    return {center + edge[axis] * (side == 0 ? -0.5 : 0.5), edge[(axis + 1) % 3], edge[(axis + 2) % 3]};
  }
  // kSameCorner, relative to a bound on the coordinates of all corners.
  double tolerance() const {
    return kSameCorner * (largest(center) + (largest(edge[0]) + largest(edge[1]) + largest(edge[2])) / 2);
  }
};

std::vector<Edge> edgesOf(const Quad& quad) {
  const D3 corner = quad.center - (quad.e1 + quad.e2) * 0.5;
  return {{corner, quad.e1}, {corner, quad.e2}, {corner + quad.e1, quad.e2}, {corner + quad.e2, quad.e1}};
}

// Takes each quad in turn for the base of a box. A quad that has become a face of one is in no other.
class BoxFinder {
 public:
  BoxFinder(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles) : free_(quads, true) {
    quads_.reserve(quads);
    for (size_t i = 0; i < quads; ++i) quads_.push_back(quadOf(faces[i]));
    for (size_t i = 0; i < quads + triangles; ++i) edges_.push_back(edgesOf(faces[i]));
  }

  std::vector<FoundBox> find() {
    std::vector<FoundBox> boxes;
    for (size_t i = 0; i < quads_.size(); ++i) {
      if (const std::optional<FoundBox> box = boxOn(i)) {
        box->forEachQuad([this](uint32_t quad) { free_[quad] = false; });
        boxes.push_back(*box);
      }
    }
    return boxes;
  }

 private:
  // A box of which this quad is a face. Any other that shares an edge with it says where the opposite face would be.
  std::optional<FoundBox> boxOn(size_t base) const {
    const Quad& bottom = quads_[base];
    for (size_t i = 0; i < quads_.size() && free_[base]; ++i) {
      if (i == base || !free_[i]) continue;
      for (const auto& [shared, across] : {std::pair{bottom.e1, bottom.e2}, std::pair{bottom.e2, bottom.e1}}) {
        for (const double side : {-1.0, 1.0}) {
          // If quad i stands on the edge of the base at this side of `across`, its centre is that of the base plus
          // (side * across + up) / 2.
          const D3 up = (quads_[i].center - bottom.center) * 2 - across * side;
          const Parallelepiped shape{bottom.center + up * 0.5, {bottom.e1, bottom.e2, up}};
          // Quad i stands there if its other edge is `up`.
          if (!coincide(quads_[i], {quads_[i].center, shared, up}, shape.tolerance())) continue;
          if (const std::optional<FoundBox> box = boxOf(shape)) return box;
        }
      }
    }
    return std::nullopt;
  }

  // The box of this shape, if free quads are all of its faces, or all but one.
  std::optional<FoundBox> boxOf(const Parallelepiped& shape) const {
    FoundBox box{};
    size_t missing = 0;
    Quad openSide{};
    for (size_t axis = 0; axis < 3; ++axis) {
      // The normal goes along the edge, so that side 1 is the high one.
      const D3 across = cross(shape.edge[(axis + 1) % 3], shape.edge[(axis + 2) % 3]);
      const double volume = dot(across, shape.edge[axis]);
      if (volume == 0) return std::nullopt;
      box.normal[axis] = across * ((volume > 0 ? 1 : -1) / length(across));
      for (size_t side = 0; side < 2; ++side) {
        const Quad face = shape.face(axis, side);
        const uint32_t quad = box.quad[axis][side] = freeQuadAt(face, shape.tolerance());
        if (quad == kNoIndex) {
          if (++missing > 1) return std::nullopt;
          openSide = face;
        }
        // The plane goes through the centre of the quad that is there. All corners of that quad have to lie in it.
        double& bound = side == 0 ? box.low[axis] : box.high[axis];
        bound = dot(box.normal[axis], quad == kNoIndex ? face.center : quads_[quad].center);
        if (quad != kNoIndex && !liesIn(quads_[quad], box.normal[axis], bound)) return std::nullopt;
      }
    }
    // An open side is moved to high[2]. Nothing else may meet its rim.
    if (missing == 0) return box;
    turnOpenSide(box);
    if (somethingMeets(edgesOf(openSide), box, 2 * shape.tolerance())) return std::nullopt;
    return box;
  }

  // Whether an edge of any face but the box's own lies along the rim of its open side.
  bool somethingMeets(const std::vector<Edge>& rim, const FoundBox& box, double tolerance) const {
    for (size_t i = 0; i < edges_.size(); ++i) {
      bool own = false;
      box.forEachQuad([&own, i](uint32_t quad) { own = own || quad == i; });
      if (!own && anyOverlap(edges_[i], rim, tolerance)) return true;
    }
    return false;
  }

  // The first free quad with the corners of this face, or kNoIndex.
  uint32_t freeQuadAt(const Quad& face, double tolerance) const {
    for (size_t i = 0; i < quads_.size(); ++i) {
      if (free_[i] && coincide(quads_[i], face, tolerance)) return static_cast<uint32_t>(i);
    }
    return kNoIndex;
  }

  // Whether all corners of the quad lie in the plane normal . p = bound, up to flatnessAt.
  static bool liesIn(const Quad& quad, const D3& normal, double bound) {
    for (const double u : {-0.5, 0.5}) {
      for (const double v : {-0.5, 0.5}) {
        const D3 corner = quad.center + quad.e1 * u + quad.e2 * v;
        if (std::abs(dot(normal, corner) - bound) > flatnessAt(normal, corner)) return false;
      }
    }
    return true;
  }

  // Reverses a normal or exchanges two axes where needed, so that the missing face is at high[2].
  static void turnOpenSide(FoundBox& box) {
    for (size_t axis = 0; axis < 3; ++axis) {
      auto& pair = box.quad[axis];
      if (pair[0] == kNoIndex) {
        std::swap(pair[0], pair[1]);
        std::swap(box.low[axis], box.high[axis]);
        box.low[axis] *= -1;
        box.high[axis] *= -1;
        box.normal[axis] = box.normal[axis] * -1;
      }
      if (pair[1] == kNoIndex && axis != 2) {
        std::swap(box.normal[axis], box.normal[2]);
        std::swap(box.low[axis], box.low[2]);
        std::swap(box.high[axis], box.high[2]);
        std::swap(box.quad[axis], box.quad[2]);
        return;
      }
    }
  }

  std::vector<Quad> quads_;
  std::vector<std::vector<Edge>> edges_;  // of quads, then triangles
  std::vector<bool> free_;
};

}  // namespace

std::vector<FoundBox> findBoxes(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles) {
  return BoxFinder(faces, quads, triangles).find();
}

}  // namespace wavecrest
