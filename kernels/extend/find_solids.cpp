#include "kernels/extend/find_solids.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "kernels/extend/face_edges.h"

namespace wavecrest {
namespace {

constexpr size_t kLeastFaces = 4;  // fewer cost as much as the planes that close them
// Normals at an angle below a thousandth are parallel. Two such faces must lie in one plane, or the faces are no solid:
// rounding would decide far from their edge which of them a ray meets.
constexpr double kParallel = 1 - 5e-7;

// A face's corners, in order around it, as indices of welded points.
using Loop = std::vector<uint32_t>;
using Key = std::pair<uint32_t, uint32_t>;  // an edge: its ends, the smaller index first
Key keyOf(uint32_t a, uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

// Welds corners, collects faces that are connected by shared edges, and tests whether each such body is convex.
class SolidFinder {
 public:
  SolidFinder(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles, const std::vector<bool>& taken)
      : count_(quads + triangles), taken_(taken) {
    for (size_t i = 0; i < count_; ++i) edges_.push_back(edgesOf(faces[i]));
    // The largest coordinate, from which the tolerance of welding follows. addLoop welds.
    for (size_t i = 0; i < count_; ++i) {
      for (const Edge& edge : edges_[i])
        reach_ = std::max({reach_, largest(edge.from), largest(edge.from + edge.along)});
    }
    for (size_t i = 0; i < count_; ++i) addLoop(faces[i], i < quads);
  }

  std::vector<FoundSolid> find() {
    std::vector<FoundSolid> solids;
    std::vector<bool> seen = taken_;
    for (uint32_t i = 0; i < count_; ++i) {
      if (seen[i]) continue;
      const std::vector<uint32_t> body = connectedTo(i, seen);
      if (body.size() < kLeastFaces) continue;
      if (std::optional<FoundSolid> solid = solidOf(body)) solids.push_back(std::move(*solid));
    }
    return solids;
  }

 private:
  double tolerance() const { return kSameCorner * reach_; }

  // The index of the point. Points within the tolerance of an earlier one share its index.
  uint32_t weld(const D3& point) {
    for (uint32_t i = 0; i < points_.size(); ++i) {
      if (largest(points_[i] - point) <= tolerance()) return i;
    }
    points_.push_back(point);
    return static_cast<uint32_t>(points_.size() - 1);
  }
  // Appends the corners of a face to loops_. A face that is not taken is also listed at each of its edges.
  void addLoop(const PrimitiveRecord<double>& face, bool quad) {
    const D3 p = vec(face.p0), a = p + vec(face.e1), b = p + vec(face.e2);
    Loop& loop = loops_.emplace_back();
    loop = {weld(p), weld(a)};
    if (quad) loop.push_back(weld(a + vec(face.e2)));
    loop.push_back(weld(b));
    const auto face32 = static_cast<uint32_t>(loops_.size() - 1);
    if (taken_[face32]) return;
    for (size_t k = 0; k < loop.size(); ++k) facesAt_[keyOf(loop[k], loop[(k + 1) % loop.size()])].push_back(face32);
  }
  // Calls function(key) for each edge of a face.
  template <class Function>
  void forEachKey(uint32_t face, Function function) const {
    const Loop& loop = loops_[face];
    for (size_t k = 0; k < loop.size(); ++k) function(keyOf(loop[k], loop[(k + 1) % loop.size()]));
  }

  // The faces that are connected to `start` by shared edges, `start` included. All of them are marked as seen.
  std::vector<uint32_t> connectedTo(uint32_t start, std::vector<bool>& seen) const {
    std::vector<uint32_t> body{start};
    seen[start] = true;
    for (size_t i = 0; i < body.size(); ++i) {
      forEachKey(body[i], [&](const Key& key) {
        for (const uint32_t face : facesAt_.at(key)) {
          if (!seen[face]) body.push_back(face);
          seen[face] = true;
        }
      });
    }
    return body;
  }

  // The solid that the faces bound, if they do.
  std::optional<FoundSolid> solidOf(const std::vector<uint32_t>& body) const {
    // Every edge joins two faces, or is part of the rim of an open side.
    std::map<uint32_t, Loop> rims;  // of each corner on a rim: its neighbours there
    Loop corners;
    for (const uint32_t face : body) {
      corners.insert(corners.end(), loops_[face].begin(), loops_[face].end());
      bool simple = true;
      forEachKey(face, [&](const Key& key) {
        const size_t sharing = facesAt_.at(key).size();
        simple = simple && sharing <= 2 && key.first != key.second;
        if (sharing != 1) return;
        rims[key.first].push_back(key.second);
        rims[key.second].push_back(key.first);
      });
      if (!simple) return std::nullopt;
    }
    // A point inside, if the body is convex: the mean of its corners. Normals are turned away from it.
    D3 middle{};
    for (const uint32_t corner : corners)
      middle = middle + points_[corner] * (1.0 / static_cast<double>(corners.size()));

    // The planes of all faces, then those that close the open sides.
    FoundSolid solid{{}, std::numeric_limits<double>::infinity()};
    for (const uint32_t face : body) {
      if (!addFace(face, middle, solid.planes)) return std::nullopt;
    }
    if (!addOpenSides(std::move(rims), middle, solid.planes)) return std::nullopt;
    if (!solid.planes.empty() && somethingMeetsRims(body)) return std::nullopt;

    // Convex: all corners are on the inner side of all planes. The thickness is the least extent across a plane.
    for (const SolidPlane& plane : solid.planes) {
      // The depth of the corner that is farthest from the plane.
      double depth = 0;
      for (const uint32_t corner : corners) {
        const double inside = plane.distance - dot(plane.normal, points_[corner]);
        const double allowed = plane.open() ? tolerance() : flatnessAt(plane.normal, points_[corner]);
        if (inside < -allowed) return std::nullopt;
        depth = std::max(depth, inside);
      }
      solid.thickness = std::min(solid.thickness, depth);
    }
    return solid;
  }

  // The plane of a loop of points, with its normal turned away from the middle. The normal is that of the loop's area,
  // the sum over a fan of triangles. It is NaN for a loop without area.
  SolidPlane planeOf(const Loop& loop, const D3& middle) const {
    const D3& base = points_[loop[0]];
    D3 area{};
    for (size_t k = 1; k + 1 < loop.size(); ++k) {
      area = area + cross(points_[loop[k]] - base, points_[loop[k + 1]] - base);
    }
    SolidPlane plane{area * (1 / length(area)), 0, kNoIndex, kNoIndex, {}, 0};
    plane.distance = dot(plane.normal, base);
    if (dot(plane.normal, middle) > plane.distance) {
      plane.normal = plane.normal * -1;
      plane.distance = -plane.distance;
    }
    return plane;
  }
  // Whether all corners of the loop lie in the plane, up to flatnessAt and the allowance.
  bool liesIn(const Loop& loop, const SolidPlane& plane, double allowance) const {
    return std::all_of(loop.begin(), loop.end(), [&](uint32_t corner) {
      const D3& p = points_[corner];
      return std::abs(dot(plane.normal, p) - plane.distance) <= flatnessAt(plane.normal, p) + allowance;
    });
  }

  // Adds the plane of a face. If a parallel plane is there already, the face becomes its second one. False if the faces
  // are no solid.
  bool addFace(uint32_t face, const D3& middle, std::vector<SolidPlane>& planes) const {
    SolidPlane plane = planeOf(loops_[face], middle);
    if (!(length(plane.normal) > 0.5) || !liesIn(loops_[face], plane, 0)) return false;
    for (SolidPlane& present : planes) {
      if (dot(present.normal, plane.normal) < kParallel) continue;
      return liesIn(loops_[face], present, 0) && !present.shared() && separate(present, face);
    }
    plane.face = face;
    planes.push_back(plane);
    return true;
  }
  // Tells a second face of the plane from the first by the edge that both have.
  bool separate(SolidPlane& plane, uint32_t second) const {
    std::optional<Key> shared;
    forEachKey(second, [&](const Key& key) {
      const auto& faces = facesAt_.at(key);
      if (std::find(faces.begin(), faces.end(), plane.face) != faces.end()) shared = key;
    });
    if (!shared) return false;
    // The separator goes through the shared edge, at right angles to the plane, and points to the second face.
    const D3& from = points_[shared->first];
    D3 across = cross(plane.normal, points_[shared->second] - from);
    D3 beyond{};
    for (const uint32_t corner : loops_[second]) beyond = beyond + (points_[corner] - from);
    if (dot(across, beyond) < 0) across = across * -1;
    plane.other = second;
    plane.separator = across * (1 / length(across));
    plane.separatorOffset = -dot(plane.separator, from);
    return true;
  }

  // Adds a plane for each open side, which is a loop of rim edges. rims: of each corner on a rim, its neighbours there.
  // False if the faces are no solid.
  bool addOpenSides(std::map<uint32_t, Loop> rims, const D3& middle, std::vector<SolidPlane>& planes) const {
    // Where two rims meet in a corner, their loops cannot be told apart.
    for (const auto& [corner, neighbours] : rims) {
      if (neighbours.size() != 2) return false;
    }
    while (!rims.empty()) {
      // Walk along the rim until it closes.
      Loop loop{rims.begin()->first};
      for (uint32_t from = kNoIndex, at = loop[0];;) {
        const Loop& neighbours = rims.at(at);
        const uint32_t next = neighbours[0] == from ? neighbours[1] : neighbours[0];
        from = at;
        at = next;
        if (at == loop[0]) break;
        loop.push_back(at);
      }
      for (const uint32_t corner : loop) rims.erase(corner);
      if (loop.size() < 3) return false;
      const SolidPlane plane = planeOf(loop, middle);
      if (!(length(plane.normal) > 0.5) || !liesIn(loop, plane, tolerance())) return false;
      for (const SolidPlane& present : planes) {  // a hole in a face is no open side
        if (dot(present.normal, plane.normal) >= kParallel) return false;
      }
      planes.push_back(plane);
    }
    return true;
  }

  // Whether an edge of any other face lies along a rim, an edge that only one face of the body has.
  bool somethingMeetsRims(const std::vector<uint32_t>& body) const {
    std::vector<Edge> rims;
    for (const uint32_t face : body) {
      forEachKey(face, [&](const Key& key) {
        if (facesAt_.at(key).size() == 1)
          rims.push_back({points_[key.first], points_[key.second] - points_[key.first]});
      });
    }
    for (uint32_t i = 0; i < count_; ++i) {
      const bool own = std::find(body.begin(), body.end(), i) != body.end();
      if (!own && anyOverlap(edges_[i], rims, 2 * tolerance())) return true;
    }
    return false;
  }

  size_t count_;
  const std::vector<bool>& taken_;
  double reach_ = 0;
  std::vector<std::vector<Edge>> edges_;
  std::vector<D3> points_;
  std::vector<Loop> loops_;                       // of each face
  std::map<Key, std::vector<uint32_t>> facesAt_;  // those that are not taken
};

}  // namespace

std::vector<FoundSolid> findSolids(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles,
                                   const std::vector<bool>& taken) {
  return SolidFinder(faces, quads, triangles, taken).find();
}

}  // namespace wavecrest
