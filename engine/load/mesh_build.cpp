#include "engine/load/mesh_build.h"

#include <algorithm>
#include <cmath>

#include "engine/tasks/parallel_for.h"
#include "kernels/columns/parallel_ranges.h"

namespace wavecrest {

namespace {

Double3 toDouble(const Float3& v) { return {v[0], v[1], v[2]}; }
Float3 toFloat(const Double3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
bool isFinite(const Float3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

// Calls function(value) for each value, from several threads.
template <class Value, class Function>
void forAll(std::vector<Value>& values, const Function& function) {
  forEachRange(parallelFor, values.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) function(values[i]);
  });
}
// Transforms positions to world space. LoadError if one leaves the range of float.
void placePositions(std::vector<Float3>& positions, const Matrix4& toWorld, const SourceLocation& where) {
  if (isIdentity(toWorld)) return;
  forAll(positions, [&](Float3& p) {
    p = toFloat(transformPoint(toWorld, toDouble(p)));
    if (!isFinite(p)) {
      throw LoadError(where, "to_world moves a vertex beyond the range of float; expected smaller coordinates");
    }
  });
}

// Differences of floats are nearly exact in double, so a cross product this small next to the edges is a rounding
// residue: the three points are on one line.
bool hasArea(const Double3& e1, const Double3& e2) {
  constexpr double kResidue = 1e-15;
  const double longest2 = std::max(dot(e1, e1), dot(e2, e2));
  return length(cross(e1, e2)) > kResidue * longest2;
}

// Removes triangles without area, and their values of a per-face attribute. Returns how many were removed.
uint64_t dropTrianglesWithoutArea(Mesh& mesh, MeshAttribute& attribute) {
  const auto hasNone = [&](const std::array<uint32_t, 3>& t) {
    const Double3 a = toDouble(mesh.positions[t[0]]);
    return !hasArea(toDouble(mesh.positions[t[1]]) - a, toDouble(mesh.positions[t[2]]) - a);
  };
  if (!anyIndex(parallelFor, mesh.triangles.size(), [&](size_t i) { return hasNone(mesh.triangles[i]); })) return 0;
  // Move the values of the remaining triangles to the front, in the order that erase_if keeps.
  if (attribute.perFace()) {
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (hasNone(mesh.triangles[i])) continue;
      for (size_t c = 0; c < attribute.channels; ++c) {
        attribute.values[kept * attribute.channels + c] = attribute.values[i * attribute.channels + c];
      }
      ++kept;
    }
  }
  return std::erase_if(mesh.triangles, hasNone);
}

// The unit normal of a triangle and the angles at its corners, in radians.
struct Facet {
  Double3 normal;
  double angle[3];
};

// Twice the area is the product of two edges and the sine of the angle between them, at each of the three corners, so
// one root serves all angles. atan2 is accurate for all of them, those near 0 and near pi too.
Facet facetOf(const Mesh& mesh, const std::array<uint32_t, 3>& triangle) {
  const Double3 p0 = toDouble(mesh.positions[triangle[0]]), p1 = toDouble(mesh.positions[triangle[1]]),
                p2 = toDouble(mesh.positions[triangle[2]]);
  const Double3 e01 = p1 - p0, e02 = p2 - p0, e12 = p2 - p1, across = cross(e01, e02);
  const double twiceArea = length(across);
  return {.normal = across * (1 / twiceArea),
          .angle = {std::atan2(twiceArea, dot(e01, e02)), std::atan2(twiceArea, -dot(e01, e12)),
                    std::atan2(twiceArea, dot(e02, e12))}};
}

}  // namespace

// The mean of the face normals weighted by the angle at the vertex (Thürmer and Wüthrich, "Computing Vertex Normals
// from Polygonal Facets", JGT 3(1), 1998).
std::vector<Float3> smoothNormals(const Mesh& mesh, std::span<const uint32_t> vertexOf) {
  const auto placeOf = [&](size_t vertex) { return vertexOf.empty() ? vertex : vertexOf[vertex]; };
  std::vector<Double3> sums(mesh.positions.size(), Double3{0, 0, 0});
  // The facets of some ranges at a time are found by all threads. One adds them in the order of the triangles, so that
  // the sums do not depend on threads.
  constexpr size_t kAtOnce = 16 * kRange;
  std::vector<Facet> facets(std::min(mesh.triangles.size(), kAtOnce));
  for (size_t first = 0; first < mesh.triangles.size(); first += kAtOnce) {
    const auto* const triangles = mesh.triangles.data() + first;
    const size_t count = std::min(kAtOnce, mesh.triangles.size() - first);
    forEachRange(parallelFor, count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) facets[i] = facetOf(mesh, triangles[i]);
    });
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        Double3& sum = sums[placeOf(triangles[i][k])];
        sum = sum + facets[i].angle[k] * facets[i].normal;
      }
    }
  }
  std::vector<Float3> normals(sums.size());
  forEachRange(parallelFor, sums.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      // Opposite faces cancel, and an unused vertex has none: any direction will do, Mitsuba takes x.
      const Double3& sum = sums[placeOf(i)];
      const double size = length(sum);
      normals[i] = size > 1e-20 ? toFloat((1 / size) * sum) : Float3{1, 0, 0};
    }
  });
  return normals;
}

Float3 placedNormal(const Matrix4& normalMatrix, const Float3& normal) {
  const Double3 placed = transformVector(normalMatrix, toDouble(normal));
  const double size = length(placed);
  return size > 0 && std::isfinite(size) ? toFloat((1 / size) * placed) : Float3{0, 0, 0};
}

namespace {

// Replaces normals that are zero by smooth normals.
void fillMissingNormals(Mesh& mesh, std::span<const uint32_t> vertexOf) {
  const std::vector<Float3> smooth = smoothNormals(mesh, vertexOf);
  for (size_t i = 0; i < smooth.size(); ++i) {
    if (mesh.normals[i] == Float3{0, 0, 0}) mesh.normals[i] = smooth[i];
  }
}

void placeNormals(std::vector<Float3>& normals, const Matrix4& toWorld) {
  const Matrix4 matrix = normalMatrix(toWorld);
  forAll(normals, [&](Float3& n) { n = placedNormal(matrix, n); });
}

// Reverses triangles whose winding contradicts their normals, so that both name the same front side. Mitsuba shades and
// emits by the normals; a mirroring transform or a careless exporter leaves the winding behind.
void windAlongNormals(Mesh& mesh) {
  forAll(mesh.triangles, [&](std::array<uint32_t, 3>& t) {
    const Double3 a = toDouble(mesh.positions[t[0]]);
    const Double3 facing = cross(toDouble(mesh.positions[t[1]]) - a, toDouble(mesh.positions[t[2]]) - a);
    const Double3 sum = toDouble(mesh.normals[t[0]]) + toDouble(mesh.normals[t[1]]) + toDouble(mesh.normals[t[2]]);
    if (dot(facing, sum) < 0) std::swap(t[1], t[2]);
  });
}

}  // namespace

void turnAround(Mesh& mesh) {
  for (std::array<uint32_t, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Float3& n : mesh.normals) n = {-n[0], -n[1], -n[2]};
}

Mesh buildMesh(LoadContext& context, TriangleSoup soup, const MeshPlacement& placement, const SourceLocation& where) {
  Mesh mesh{.positions = std::move(soup.positions),
            .normals = std::move(soup.normals),
            .uvs = std::move(soup.uvs),
            .triangles = std::move(soup.triangles)};
  // Move the mesh to world space. Triangles without area have no normal there and are dropped.
  placePositions(mesh.positions, placement.toWorld, where);
  context.scene.droppedTriangles += soup.droppedFaces + dropTrianglesWithoutArea(mesh, soup.attribute);
  // Take no normals, those of the file, or smooth ones. A normal of zero is missing and is replaced.
  if (placement.faceNormals) {
    mesh.normals.clear();
  } else if (!mesh.normals.empty()) {
    placeNormals(mesh.normals, placement.toWorld);
    windAlongNormals(mesh);
    const bool complete = std::find(mesh.normals.begin(), mesh.normals.end(), Float3{0, 0, 0}) == mesh.normals.end();
    if (!complete) fillMissingNormals(mesh, soup.vertexOf);
  } else {
    mesh.normals = smoothNormals(mesh, soup.vertexOf);
  }
  // Turn the mesh around if asked, and bake its attribute into a bitmap.
  if (placement.flipNormals) turnAround(mesh);
  if (!soup.attribute.values.empty()) context.attributeBitmap = bakeMeshAttribute(soup.attribute, mesh);
  return mesh;
}

}  // namespace wavecrest
