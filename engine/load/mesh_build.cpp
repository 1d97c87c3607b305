#include "engine/load/mesh_build.h"

#include <algorithm>
#include <cmath>

namespace wavecrest {

namespace {

Double3 toDouble(const Float3& v) { return {v[0], v[1], v[2]}; }
Float3 toFloat(const Double3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
bool isFinite(const Float3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

// Transforms positions to world space. LoadError if one leaves the range of float.
void placePositions(std::vector<Float3>& positions, const Matrix4& toWorld, const SourceLocation& where) {
  if (isIdentity(toWorld)) return;
  for (Float3& p : positions) {
    p = toFloat(transformPoint(toWorld, toDouble(p)));
    if (!isFinite(p)) {
      throw LoadError(where, "to_world moves a vertex beyond the range of float; expected smaller coordinates");
    }
  }
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

// Angle between two vectors, accurate when they are nearly parallel (Kahan, "How Futile are Mindless Assessments of
// Roundoff", 2006, section 12).
double angleBetween(const Double3& a, const Double3& b) {
  const Double3 u = length(b) * a, v = length(a) * b;
  return 2 * std::atan2(length(u - v), length(u + v));
}

}  // namespace

// The mean of the face normals weighted by the angle at the vertex (Thürmer and Wüthrich, "Computing Vertex Normals
// from Polygonal Facets", JGT 3(1), 1998).
std::vector<Float3> smoothNormals(const Mesh& mesh) {
  std::vector<Double3> sums(mesh.positions.size(), Double3{0, 0, 0});
  for (const std::array<uint32_t, 3>& t : mesh.triangles) {
    const Double3 p[3] = {toDouble(mesh.positions[t[0]]), toDouble(mesh.positions[t[1]]),
                          toDouble(mesh.positions[t[2]])};
    const Double3 normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
    for (size_t i = 0; i < 3; ++i) {
      const double angle = angleBetween(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
      sums[t[i]] = sums[t[i]] + angle * normal;
    }
  }
  std::vector<Float3> normals;
  normals.reserve(sums.size());
  for (const Double3& sum : sums) {
    // Opposite faces cancel, and an unused vertex has none: any direction will do, Mitsuba takes x.
    const double size = length(sum);
    normals.push_back(size > 1e-20 ? toFloat((1 / size) * sum) : Float3{1, 0, 0});
  }
  return normals;
}

Float3 placedNormal(const Matrix4& normalMatrix, const Float3& normal) {
  const Double3 placed = transformVector(normalMatrix, toDouble(normal));
  const double size = length(placed);
  return size > 0 && std::isfinite(size) ? toFloat((1 / size) * placed) : Float3{0, 0, 0};
}

namespace {

// Replaces normals that are zero by smooth normals.
void fillMissingNormals(Mesh& mesh) {
  const std::vector<Float3> smooth = smoothNormals(mesh);
  for (size_t i = 0; i < smooth.size(); ++i) {
    if (mesh.normals[i] == Float3{0, 0, 0}) mesh.normals[i] = smooth[i];
  }
}

void placeNormals(std::vector<Float3>& normals, const Matrix4& toWorld) {
  const Matrix4 matrix = normalMatrix(toWorld);
  for (Float3& n : normals) n = placedNormal(matrix, n);
}

// Reverses triangles whose winding contradicts their normals, so that both name the same front side. Mitsuba shades and
// emits by the normals; a mirroring transform or a careless exporter leaves the winding behind.
void windAlongNormals(Mesh& mesh) {
  for (std::array<uint32_t, 3>& t : mesh.triangles) {
    const Double3 a = toDouble(mesh.positions[t[0]]);
    const Double3 facing = cross(toDouble(mesh.positions[t[1]]) - a, toDouble(mesh.positions[t[2]]) - a);
    const Double3 sum = toDouble(mesh.normals[t[0]]) + toDouble(mesh.normals[t[1]]) + toDouble(mesh.normals[t[2]]);
    if (dot(facing, sum) < 0) std::swap(t[1], t[2]);
  }
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
  context.scene.droppedTriangles += dropTrianglesWithoutArea(mesh, soup.attribute);
  // Take no normals, those of the file, or smooth ones. A normal of zero is missing and is replaced.
  if (placement.faceNormals) {
    mesh.normals.clear();
  } else if (!mesh.normals.empty()) {
    placeNormals(mesh.normals, placement.toWorld);
    windAlongNormals(mesh);
    const bool complete = std::find(mesh.normals.begin(), mesh.normals.end(), Float3{0, 0, 0}) == mesh.normals.end();
    if (!complete) fillMissingNormals(mesh);
  } else {
    mesh.normals.assign(mesh.positions.size(), Float3{0, 0, 0});
    fillMissingNormals(mesh);
  }
  // Turn the mesh around if asked, and bake its attribute into a bitmap.
  if (placement.flipNormals) turnAround(mesh);
  if (!soup.attribute.values.empty()) context.attributeBitmap = bakeMeshAttribute(soup.attribute, mesh);
  return mesh;
}

}  // namespace wavecrest
