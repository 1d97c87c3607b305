#include "engine/compile/mesh_faces.h"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/scene/vector_math.h"
#include "kernels/extend/corner_weld.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Only small meshes are searched for parallelograms: in larger ones they gain nothing.
constexpr size_t kMergeLimit = 4096;
Double3 position(const Mesh& mesh, uint32_t vertex) { return widened(mesh.positions[vertex]); }

using Edge = std::pair<uint32_t, uint32_t>;

// Whether the triangles (a, b, c) and (d, otherC, otherB), which share the edge b-c, are one parallelogram with a
// continuous parameterisation: d = b + c - a in position, uv and normal, and the same on both sides of the edge. d is
// no farther off than CornerWeld makes good. For copies it is exact: rounding their vertices may take up all of that.
bool formParallelogram(const Mesh& mesh, const FaceCorners& triangle, const FaceCorners& other, const Double3& origin,
                       bool copied) {
  const auto [a, b, c] = triangle;
  const auto [d, otherC, otherB] = other;
  const Double3 e1 = position(mesh, b) - position(mesh, a), e2 = position(mesh, c) - position(mesh, a);
  const Double3 gap = position(mesh, d) - position(mesh, a) - e1 - e2;
  if (length(gap) > 1e-6 * (length(e1) + length(e2))) return false;
  const double limit = copied ? 0 : kQuadUnits * kUnitRoundoff * reachOf(position(mesh, a) - origin, e1, e2);
  if (std::ranges::any_of(gap, [limit](double along) { return std::abs(along) > limit; })) return false;
  if (!mesh.uvs.empty()) {
    const auto& uvs = mesh.uvs;
    for (size_t i = 0; i < 2; ++i) {
      if (std::abs(uvs[d][i] + uvs[a][i] - uvs[b][i] - uvs[c][i]) > 1e-5f) return false;
      if (std::abs(uvs[otherB][i] - uvs[b][i]) + std::abs(uvs[otherC][i] - uvs[c][i]) > 1e-5f) return false;
    }
  }
  // Vertex normals have to be the face's: the record of a quad has only three of them.
  if (!mesh.normals.empty()) {
    const Double3 face = normalized(cross(e1, e2));
    for (const uint32_t vertex : {a, b, c, d, otherB, otherC}) {
      if (dot(widened(mesh.normals[vertex]), face) < 1 - 1e-6) return false;
    }
  }
  return true;
}

// Vertices at the same place count as one when edges are matched: cubes split theirs for flat normals.
std::vector<uint32_t> weldedVertices(const Mesh& mesh) {
  std::map<Float3, uint32_t> first;
  std::vector<uint32_t> welded(mesh.positions.size());
  for (uint32_t i = 0; i < welded.size(); ++i) welded[i] = first.try_emplace(mesh.positions[i], i).first->second;
  return welded;
}

// Whether the cross product of two edges is not zero, in double.
bool hasArea(const Mesh& mesh, const FaceCorners& corners) {
  const Double3 p0 = position(mesh, corners[0]);
  return length(cross(position(mesh, corners[1]) - p0, position(mesh, corners[2]) - p0)) > 0;
}

// Quads of pairs of triangles that form parallelograms, then the triangles that are left. A triangle takes its partner
// among the earlier ones, across its first edge that has one.
MeshFaces pairFaces(const Mesh& mesh, const Double3& origin, bool copied) {
  MeshFaces faces;
  const auto count = static_cast<uint32_t>(mesh.triangles.size());
  const std::vector<uint32_t> welded = weldedVertices(mesh);
  std::map<Edge, uint32_t> open;  // directed edge of an unpaired triangle -> 3 * triangle + index of opposite corner
  std::vector<bool> used(count, false);
  for (uint32_t i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[i];
    // Look for a partner across each edge, which the partner has in the opposite direction.
    for (uint32_t k = 0; k < 3 && !used[i]; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];  // edge b-c opposite a
      const auto twin = open.find({welded[c], welded[b]});
      if (twin == open.end()) continue;
      const uint32_t other = twin->second / 3, d = twin->second % 3;
      const auto& o = mesh.triangles[other];
      if (used[other]) continue;
      if (!formParallelogram(mesh, {a, b, c}, {o[d], o[(d + 1) % 3], o[(d + 2) % 3]}, origin, copied)) continue;
      used[i] = used[other] = true;
      faces.quads.push_back({a, b, c});
    }
    // Without a partner, offer the edges to later triangles.
    for (uint32_t k = 0; k < 3 && !used[i]; ++k) {
      open[{welded[t[(k + 1) % 3]], welded[t[(k + 2) % 3]]}] = 3 * i + k;
    }
  }
  for (uint32_t i = 0; i < count; ++i) {
    if (!used[i]) faces.triangles.push_back(i);
  }
  return faces;
}

}  // namespace

MeshFaces facesOf(const Mesh& mesh, bool usesUv, const Double3& origin, bool copied, const ParallelFor& parallelFor) {
  // Without texture coordinates each triangle has its own (u, v), which depend on the order of its corners.
  const bool canTurn = !usesUv || !mesh.uvs.empty(), merges = canTurn && mesh.triangles.size() <= kMergeLimit;
  MeshFaces faces = merges ? pairFaces(mesh, origin, copied) : MeshFaces{};
  faces.canTurn = canTurn;
  if (merges) {
    std::erase_if(faces.quads, [&](const FaceCorners& quad) { return !hasArea(mesh, quad); });
    std::erase_if(faces.triangles, [&](uint32_t i) { return !hasArea(mesh, mesh.triangles[i]); });
    return faces;
  }
  // A large mesh keeps its own list of triangles, unless one of them has no area.
  faces.allTriangles =
      !anyIndex(parallelFor, mesh.triangles.size(), [&](size_t i) { return !hasArea(mesh, mesh.triangles[i]); });
  for (uint32_t i = 0; i < mesh.triangles.size() && !faces.allTriangles; ++i) {
    if (hasArea(mesh, mesh.triangles[i])) faces.triangles.push_back(i);
  }
  return faces;
}

}  // namespace wavecrest
