#include "engine/compile/primitives.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// Only small meshes are searched for parallelograms: larger ones go to Embree, which is as fast on triangles.
constexpr size_t kMergeLimit = 4096;
// Segments that replace the curve of discs and cylinders.
constexpr uint32_t kSegments = 256;

Double3 position(const Mesh& mesh, uint32_t vertex) { return widened(mesh.positions[vertex]); }

// A triangle pair merged into a parallelogram: corner, then its neighbours along u and v.
struct Parallelogram {
  uint32_t corner, alongU, alongV;
};

using Edge = std::pair<uint32_t, uint32_t>;

// Whether the triangles (a, b, c) and (a', c', b') that share the edge b-c, a and d opposite, are one parallelogram
// with a continuous parameterisation: d = b + c - a in position, uv and normal.
bool formParallelogram(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  const Double3 e1 = position(mesh, b) - position(mesh, a), e2 = position(mesh, c) - position(mesh, a);
  const Double3 gap = position(mesh, d) - position(mesh, a) - e1 - e2;
  if (length(gap) > 1e-6 * (length(e1) + length(e2))) return false;
  if (!mesh.uvs.empty()) {
    for (size_t i = 0; i < 2; ++i) {
      if (std::abs(mesh.uvs[d][i] + mesh.uvs[a][i] - mesh.uvs[b][i] - mesh.uvs[c][i]) > 1e-5f) return false;
    }
  }
  if (!mesh.normals.empty()) {
    const Double3 face = normalized(cross(e1, e2));
    for (const uint32_t vertex : {a, b, c, d}) {
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

// Partitions a mesh: which triangles pair up, and the rest.
struct MeshFaces {
  std::vector<Parallelogram> quads;
  std::vector<uint32_t> triangles;
};

MeshFaces pairFaces(const Mesh& mesh) {
  MeshFaces faces;
  const auto count = static_cast<uint32_t>(mesh.triangles.size());
  if (count > kMergeLimit) {
    faces.triangles.resize(count);
    for (uint32_t i = 0; i < count; ++i) faces.triangles[i] = i;
    return faces;
  }
  const std::vector<uint32_t> welded = weldedVertices(mesh);
  std::map<Edge, uint32_t> open;  // directed edge of an unpaired triangle -> 3 * triangle + index of opposite corner
  std::vector<bool> used(count, false);
  for (uint32_t i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[i];
    for (uint32_t k = 0; k < 3 && !used[i]; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];  // edge b-c opposite a
      const auto twin = open.find({welded[c], welded[b]});
      if (twin == open.end()) continue;
      const uint32_t other = twin->second / 3, d = mesh.triangles[other][twin->second % 3];
      if (used[other] || !formParallelogram(mesh, a, b, c, d)) continue;
      used[i] = used[other] = true;
      faces.quads.push_back({a, b, c});
    }
    for (uint32_t k = 0; k < 3 && !used[i]; ++k) {
      open[{welded[t[(k + 1) % 3]], welded[t[(k + 2) % 3]]}] = 3 * i + k;
    }
  }
  for (uint32_t i = 0; i < count; ++i) {
    if (!used[i]) faces.triangles.push_back(i);
  }
  return faces;
}

// A disc as a fan, a cylinder as a ring of quads with the true normals at the vertices.
Mesh tessellated(const Disk& disk) {
  Mesh mesh;
  const auto add = [&](const Double3& p, float r, float angle) {
    mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    mesh.uvs.push_back({r, angle});
  };
  for (uint32_t i = 0; i < kSegments; ++i) {
    const auto angleOf = [](uint32_t k) { return 2 * std::numbers::pi * k / kSegments; };
    const auto rim = [&](double a) { return disk.center + disk.axisU * std::cos(a) + disk.axisV * std::sin(a); };
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    add(disk.center, 0, static_cast<float>(i) / kSegments);
    add(rim(angleOf(i)), 1, static_cast<float>(i) / kSegments);
    add(rim(angleOf(i + 1)), 1, static_cast<float>(i + 1) / kSegments);
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
  return mesh;
}

Mesh tessellated(const Cylinder& cylinder) {
  Mesh mesh;
  const Double3 axis = cylinder.p1 - cylinder.p0, x = cylinder.phi0, y = cylinder.phi90;
  const bool mirrored = dot(cross(x, y), axis) < 0;
  const double side = cylinder.flipNormals ? -1 : 1;
  for (uint32_t i = 0; i <= kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    const Double3 n = x * std::cos(angle) + y * std::sin(angle);
    for (uint32_t end = 0; end < 2; ++end) {
      const Double3 p = cylinder.p0 + axis * end + n * cylinder.radius;
      mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      mesh.normals.push_back(
          {static_cast<float>(n[0] * side), static_cast<float>(n[1] * side), static_cast<float>(n[2] * side)});
      mesh.uvs.push_back({static_cast<float>(i) / kSegments, static_cast<float>(end)});
    }
  }
  for (uint32_t i = 0; i < kSegments; ++i) {
    const uint32_t a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
    if (cylinder.flipNormals != mirrored) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({d, c, b});
    } else {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({d, b, c});
    }
  }
  return mesh;
}

// Collects the records of all shapes, one kind after the other.
template <class S>
class PrimitiveCollector {
 public:
  PrimitiveCollector(const Scene& scene, bool textured, const Double3& origin)
      : scene_(scene), textured_(textured), origin_(origin) {
    for (const Shape& shape : scene.shapes) emits_ = emits_ || shape.emitter != kNone;
  }

  Primitives<S> collect() {
    for (uint32_t i = 0; i < scene_.shapes.size(); ++i) {
      shape_ = i;
      std::visit([&](const auto& kind) { visit(kind); }, scene_.shapes[i].kind);
    }
    Primitives<S>& out = out_;
    out.counts = {static_cast<uint32_t>(quads_.size()), static_cast<uint32_t>(triangles_.size()),
                  static_cast<uint32_t>(spheres_.size())};
    for (auto* list : {&quads_, &triangles_, &spheres_}) {
      if (out.records.empty()) {
        out.records = std::move(*list);
      } else {
        out.records.insert(out.records.end(), list->begin(), list->end());
      }
    }
    for (auto* list : {&quadShapes_, &triangleShapes_, &sphereShapes_}) {
      out.shapeOf.insert(out.shapeOf.end(), list->begin(), list->end());
    }
    return std::move(out_);
  }

 private:
  PrimitiveRecord<S>& add(PrimitiveKind kind, const Double3& p0, const Double3& e1, const Double3& e2,
                          const Double3& normal) {
    auto& list = kind == PrimitiveKind::quad ? quads_ : kind == PrimitiveKind::triangle ? triangles_ : spheres_;
    auto& shapes = kind == PrimitiveKind::quad       ? quadShapes_
                   : kind == PrimitiveKind::triangle ? triangleShapes_
                                                     : sphereShapes_;
    PrimitiveRecord<S>& record = list.emplace_back();
    assign(record.p0, p0);
    assign(record.e1, e1);
    assign(record.e2, e2);
    assign(record.normal, normal);
    record.material = scene_.shapes[shape_].material;
    record.light = kNoIndex;
    record.kind = static_cast<uint32_t>(kind);
    record.attributes = kNoIndex;
    if (emits_) shapes.push_back(scene_.shapes[shape_].emitter != kNone ? shape_ : kNone);
    return record;
  }

  void addAttributes(PrimitiveRecord<S>& record, const Mesh& mesh, const std::array<uint32_t, 3>& corners) {
    if (mesh.normals.empty() && !textured_) return;
    record.attributes = static_cast<uint32_t>(out_.attributes.size());
    AttributeRecord& attributes = out_.attributes.emplace_back();
    attributes.hasNormals = mesh.normals.empty() ? 0 : 1;
    constexpr float kDefaultUv[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (size_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3 && attributes.hasNormals != 0; ++axis) {
        attributes.normal[k][axis] = mesh.normals[corners[k]][axis];
      }
      for (size_t axis = 0; axis < 2; ++axis) {
        attributes.uv[k][axis] = mesh.uvs.empty() ? kDefaultUv[k][axis] : mesh.uvs[corners[k]][axis];
      }
    }
  }

  void addFace(PrimitiveKind kind, const Mesh& mesh, const Double3& origin, const std::array<uint32_t, 3>& corners) {
    const Double3 p0 = position(mesh, corners[0]);
    const Double3 e1 = position(mesh, corners[1]) - p0, e2 = position(mesh, corners[2]) - p0;
    const Double3 across = cross(e1, e2);
    const double area = length(across);
    if (!(area > 0)) return;  // zero area: cannot be hit
    addAttributes(add(kind, p0 - origin, e1, e2, across * (1 / area)), mesh, corners);
  }

  void addMesh(const Mesh& mesh, const Double3& origin) {
    const MeshFaces faces = pairFaces(mesh);
    for (const Parallelogram& q : faces.quads) {
      addFace(PrimitiveKind::quad, mesh, origin, {q.corner, q.alongU, q.alongV});
    }
    triangles_.reserve(triangles_.size() + faces.triangles.size());
    for (const uint32_t t : faces.triangles) addFace(PrimitiveKind::triangle, mesh, origin, mesh.triangles[t]);
  }

  void visit(const Mesh& mesh) { addMesh(mesh, origin_); }
  void visit(const Rectangle& r) {
    PrimitiveRecord<S>& record =
        add(PrimitiveKind::quad, r.corner - origin_, r.edgeU, r.edgeV, normalized(cross(r.edgeU, r.edgeV)));
    if (!textured_) return;
    Mesh corners;
    corners.uvs =
        r.mirrored ? std::vector<Float2>{{1, 0}, {0, 0}, {1, 1}} : std::vector<Float2>{{0, 0}, {1, 0}, {0, 1}};
    addAttributes(record, corners, {0, 1, 2});
  }
  // Moved before their vertices are rounded to float.
  void visit(Disk disk) {
    disk.center = disk.center - origin_;
    addMesh(tessellated(disk), {});
  }
  void visit(Cylinder cylinder) {
    cylinder.p0 = cylinder.p0 - origin_;
    cylinder.p1 = cylinder.p1 - origin_;
    addMesh(tessellated(cylinder), {});
  }
  void visit(const Sphere& sphere) {
    const auto axis = [&](size_t j) {
      const Matrix4& m = sphere.toWorld;
      return normalized(Double3{m[0][j], m[1][j], m[2][j]});
    };
    const Double3 x = axis(0), z = axis(2);
    const double handedness = dot(cross(z, x), axis(1)) < 0 ? -1 : 1;
    add(PrimitiveKind::sphere, sphere.center - origin_, {sphere.radius, sphere.flipNormals ? -1.0 : 1.0, handedness}, z,
        x);
  }

  const Scene& scene_;
  const bool textured_;
  const Double3 origin_;
  bool emits_ = false;
  uint32_t shape_ = 0;
  Primitives<S> out_;
  std::vector<PrimitiveRecord<S>> quads_, triangles_, spheres_;
  std::vector<uint32_t> quadShapes_, triangleShapes_, sphereShapes_;
};

}  // namespace

template <class S>
Primitives<S> compilePrimitives(const Scene& scene, bool textured, const Double3& origin) {
  return PrimitiveCollector<S>(scene, textured, origin).collect();
}
template Primitives<float> compilePrimitives(const Scene&, bool, const Double3&);
template Primitives<double> compilePrimitives(const Scene&, bool, const Double3&);

template <class S>
BoundingSphere boundPrimitives(std::span<const PrimitiveRecord<S>> records) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Double3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
  const auto include = [&](size_t axis, double x) {
    low[axis] = std::min(low[axis], x);
    high[axis] = std::max(high[axis], x);
  };
  for (const auto& r : records) {
    const bool sphere = static_cast<PrimitiveKind>(r.kind) == PrimitiveKind::sphere;
    const bool quad = static_cast<PrimitiveKind>(r.kind) == PrimitiveKind::quad;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double p = r.p0[axis];
      if (sphere) {
        include(axis, p - r.e1[0]);
        include(axis, p + r.e1[0]);
        continue;
      }
      const double u = p + r.e1[axis], v = p + r.e2[axis];
      for (const double x : {p, u, v, quad ? u + v - p : p}) include(axis, x);
    }
  }
  BoundingSphere bounds;
  for (size_t axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = low[axis];
    bounds.high[axis] = high[axis];
    bounds.center[axis] = (low[axis] + high[axis]) / 2;
  }
  bounds.radius = length(high - low) / 2 * 1.0001;
  return bounds;
}
template BoundingSphere boundPrimitives(std::span<const PrimitiveRecord<float>>);
template BoundingSphere boundPrimitives(std::span<const PrimitiveRecord<double>>);

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
