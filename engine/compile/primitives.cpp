#include "engine/compile/primitives.h"

#include <algorithm>
#include <cmath>

#include "engine/compile/materials.h"
#include "engine/compile/tessellate.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "kernels/extend/leaves.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

template <class S>
void setFace(PrimitiveRecord<S>& record, const Double3& p0, const Double3& e1, const Double3& e2,
             const Double3& normal) {
  assign(record.p0, p0);
  assign(record.e1, e1);
  assign(record.e2, e2);
  assign(record.normal, normal);
}

// A sphere's record: e1 is the radius, the side of the normal (+1 outward, -1 inward) and the sense in which phi turns;
// e2 is the polar axis, `normal` the direction where phi is 0. placed: uniform, or nullptr; a mirrored copy keeps the
// side of its normal.
template <class S>
void setSphere(PrimitiveRecord<S>& record, const Sphere& sphere, const Affine* placed, const Double3& origin) {
  const auto axis = [&](size_t j) {
    const Matrix4& m = sphere.toWorld;
    const Double3 own{m[0][j], m[1][j], m[2][j]};
    return normalized(placed != nullptr ? placed->vector(own) : own);
  };
  const Double3 x = axis(0), z = axis(2);
  const double handedness = dot(cross(z, x), axis(1)) < 0 ? -1 : 1;
  const Double3 center = placed != nullptr ? placed->point(sphere.center) : sphere.center;
  const double radius = placed != nullptr ? placed->scale() * sphere.radius : sphere.radius;
  setFace(record, center - origin, {radius, sphere.flipNormals ? -1.0 : 1.0, handedness}, z, x);
}

// A vertex normal of a copy, for its AttributeRecord. All normals of a copy are scaled alike and not made unit vectors,
// so that what is interpolated between vertices is what the transform makes of the group's interpolated normal; their
// lengths are at most 1.
Float3 placedNormal(const Affine& placed, const Float3& normal) {
  // The Frobenius norm of the inverse bounds how much it lengthens a vector.
  double most = 0;
  for (const Double3& row : placed.inverse) most += dot(row, row);
  const Double3 there = placed.normal(widened(normal)) * (1 / std::sqrt(most));
  return {static_cast<float>(there[0]), static_cast<float>(there[1]), static_cast<float>(there[2])};
}

// Whether (u, v) or dp/du changes what the shape looks like.
bool usesUv(const Scene& scene, const Shape& shape) {
  if ((materialFeatures(scene.materials[shape.material], scene) & kTextures) != 0) return true;
  if (shape.emitter == kNone) return false;
  const auto* light = std::get_if<AreaEmitter>(&scene.emitters[shape.emitter].kind);
  return light != nullptr && light->radiance.texture != kNone;
}

}  // namespace

PrimitiveList::PrimitiveList(const Scene& scene, bool textured, const ParallelFor& parallelFor, const Double3& origin,
                             PrimitiveChoice choice)
    : scene_(scene), textured_(textured), parallelFor_(parallelFor), origin_(origin) {
  // The shapes of the chosen group, or those of no group for the world.
  std::vector<std::vector<uint32_t>> members(scene.groups.size());
  for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const uint32_t group = scene.shapes[i].group;
    if (group == choice.group) addShape(i, nullptr);
    if (group != kNone) members[group].push_back(i);
  }
  // A copy of each group's shapes for every instance.
  if (choice.group == kNone && choice.copies) {
    for (const Instance& instance : scene.instances) {
      const Affine& placed = placements_.emplace_back(instance.toWorld);
      for (const uint32_t shape : members[instance.group]) addShape(shape, &placed);
    }
  }
  orderRuns();
}

// Adds the runs of one shape: a rectangle or sphere is one primitive, any other shape the quads and triangles of a
// mesh.
void PrimitiveList::addShape(uint32_t shape, const Affine* placed) {
  const auto& kind = scene_.shapes[shape].kind;
  Run run{.shape = shape,
          .kind = PrimitiveKind::triangle,
          .first = 0,
          .count = 0,
          .firstAttribute = kNoIndex,
          .mesh = nullptr,
          .faces = nullptr,
          .moved = false,
          .placed = placed};
  if (std::holds_alternative<Rectangle>(kind) || std::holds_alternative<Sphere>(kind)) {
    run.kind = std::holds_alternative<Sphere>(kind) ? PrimitiveKind::sphere : PrimitiveKind::quad;
    return addRun(run, 1);
  }
  // Copies of a shape share its mesh.
  auto known = surfaces_.find(shape);
  if (known == surfaces_.end()) {
    known = surfaces_.emplace(shape, surfaceOf(scene_.shapes[shape], placed != nullptr)).first;
  }
  run.mesh = known->second.mesh;
  run.faces = known->second.faces;
  run.moved = known->second.moved;
  run.kind = PrimitiveKind::quad;
  addRun(run, run.faces->quads.size());
  run.kind = PrimitiveKind::triangle;
  addRun(run, run.faces->triangleCount(*run.mesh));
}

// The mesh of a shape that is not a rectangle or sphere, and its faces. Disks and cylinders are moved to the origin in
// double, before their vertices are rounded to float. Those of copies are not: their place comes from the instance.
PrimitiveList::Surface PrimitiveList::surfaceOf(const Shape& shape, bool copied) {
  Surface surface;
  const Double3 origin = copied ? Double3{} : origin_;
  if (const auto* mesh = std::get_if<Mesh>(&shape.kind)) surface.mesh = mesh;
  if (const auto* disk = std::get_if<Disk>(&shape.kind)) {
    Disk there = *disk;
    there.center = there.center - origin;
    surface.mesh = &tessellations_.emplace_back(tessellated(there));
    surface.moved = !copied;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.kind)) {
    Cylinder there = *cylinder;
    there.p0 = there.p0 - origin;
    there.p1 = there.p1 - origin;
    surface.mesh = &tessellations_.emplace_back(tessellated(there));
    surface.moved = !copied;
  }
  surface.faces = &faces_.emplace_back(
      facesOf(*surface.mesh, usesUv(scene_, shape), surface.moved ? Double3{} : origin, copied, parallelFor_));
  return surface;
}

// Appends a run of `count` primitives, if there are any. A firstAttribute of 0 only says that they have attributes;
// orderRuns numbers them.
void PrimitiveList::addRun(Run run, size_t count) {
  if (count == 0) return;
  const bool smooth = run.mesh != nullptr && !run.mesh->normals.empty();
  const bool attributed = smooth || (textured_ && run.kind != PrimitiveKind::sphere);
  run.count = static_cast<uint32_t>(count);
  run.firstAttribute = attributed ? 0 : kNoIndex;
  runs_.push_back(run);
}

// Sorts the runs into quads, triangles and spheres, and numbers their primitives and attributes.
void PrimitiveList::orderRuns() {
  std::stable_sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) {
    const auto place = [](const Run& run) {
      return run.kind == PrimitiveKind::quad ? 0 : run.kind == PrimitiveKind::triangle ? 1 : 2;
    };
    return place(a) < place(b);
  });
  size_t first = 0;
  for (Run& run : runs_) {
    run.first = static_cast<uint32_t>(first);
    first += run.count;
    if (first > kFacePrimitiveMask) {
      throw SceneError(scene_.shapes[run.shape].source,
                       "more than " + std::to_string(kFacePrimitiveMask) + " primitives; expected fewer");
    }
    if (run.firstAttribute != kNoIndex) {
      run.firstAttribute = static_cast<uint32_t>(attributes_);
      attributes_ += run.count;
    }
    uint32_t& count = run.kind == PrimitiveKind::quad       ? counts_.quads
                      : run.kind == PrimitiveKind::triangle ? counts_.triangles
                                                            : counts_.spheres;
    count += run.count;
  }
}

// The run of a primitive: the last run that begins at or before the index.
const PrimitiveList::Run& PrimitiveList::runOf(size_t index) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), index,
                                      [](size_t wanted, const Run& run) { return wanted < run.first; });
  return *(after - 1);
}

// The vertices of a face in the mesh. The second and third of a mirrored copy are swapped, so that its normal stays on
// its side. Of long thin triangles the shortest edge begins or ends at the second (intersectFaces).
FaceCorners PrimitiveList::cornersOf(const Run& run, size_t index) const {
  const size_t i = index - run.first;
  FaceCorners corners = run.kind == PrimitiveKind::quad ? run.faces->quads[i] : run.faces->triangle(*run.mesh, i);
  if (run.placed != nullptr && run.placed->mirrors) std::swap(corners[1], corners[2]);
  if (run.kind == PrimitiveKind::quad || !run.faces->canTurn) return corners;
  const Double3 a = cornerOf(run, corners[0]), b = cornerOf(run, corners[1]), c = cornerOf(run, corners[2]);
  const Double3 ab = b - a, bc = c - b, ca = a - c;
  constexpr double kThin = 16;  // squared ratio of edges
  if (kThin * dot(ca, ca) < std::min(dot(ab, ab), dot(bc, bc))) return {corners[1], corners[2], corners[0]};
  return corners;
}

// Position of a vertex relative to the origin. That of a copy is rounded to float, so that all faces around the vertex
// agree on it.
Double3 PrimitiveList::cornerOf(const Run& run, uint32_t vertex) const {
  const Double3 p = widened(run.mesh->positions[vertex]);
  if (run.placed == nullptr) return run.moved ? p : p - origin_;
  Double3 there = run.placed->point(p) - origin_;
  for (double& coordinate : there) coordinate = static_cast<float>(coordinate);
  return there;
}

// The rectangle of a run in its place. A mirrored copy has edgeU reversed, so that its normal stays on its side.
Rectangle PrimitiveList::rectangleOf(const Run& run) const {
  Rectangle r = std::get<Rectangle>(scene_.shapes[run.shape].kind);
  if (run.placed == nullptr) return r;
  r.corner = run.placed->point(r.corner);
  r.edgeU = run.placed->vector(r.edgeU);
  r.edgeV = run.placed->vector(r.edgeV);
  if (run.placed->mirrors) {
    r.corner = r.corner + r.edgeU;
    r.edgeU = -1 * r.edgeU;
    r.mirrored = !r.mirrored;
  }
  return r;
}

// All is computed in double and rounded to S by the setters.
template <class S>
PrimitiveRecord<S> PrimitiveList::recordOf(const Run& run, size_t index, bool withNormal) const {
  PrimitiveRecord<S> record;
  record.kind = static_cast<uint32_t>(run.kind);
  record.material = scene_.shapes[run.shape].material;
  record.light = record.attributes = kNoIndex;
  if (run.mesh != nullptr) {
    const FaceCorners vertices = cornersOf(run, index);
    const auto at = [&](size_t k) { return cornerOf(run, vertices[k]); };
    const Double3 p0 = at(0), e1 = at(1) - p0, e2 = at(2) - p0;
    setFace(record, p0, e1, e2, {});
    if (!withNormal) return record;
    const Double3 across = cross(e1, e2);
    assign(record.normal, across * (1 / length(across)));
  } else if (std::holds_alternative<Rectangle>(scene_.shapes[run.shape].kind)) {
    const Rectangle r = rectangleOf(run);
    setFace(record, r.corner - origin_, r.edgeU, r.edgeV, normalized(cross(r.edgeU, r.edgeV)));
  } else {
    setSphere(record, std::get<Sphere>(scene_.shapes[run.shape].kind), run.placed, origin_);
  }
  return record;
}

template <class S>
PrimitiveRecord<S> PrimitiveList::geometry(size_t index) const {
  return recordOf<S>(runOf(index), index, true);
}
template PrimitiveRecord<float> PrimitiveList::geometry(size_t) const;
template PrimitiveRecord<double> PrimitiveList::geometry(size_t) const;

template <class S>
PrimitiveRecord<S> PrimitiveList::corners(size_t index) const {
  return recordOf<S>(runOf(index), index, false);
}
template PrimitiveRecord<float> PrimitiveList::corners(size_t) const;
template PrimitiveRecord<double> PrimitiveList::corners(size_t) const;

AttributeRecord PrimitiveList::attribute(const Run& run, size_t index) const {
  // Without texture coordinates of its own a face has its (u, v), and a mirrored rectangle (1 - u, v).
  AttributeRecord attributes{};
  constexpr Float2 kDefaultUv[3] = {{0, 0}, {1, 0}, {0, 1}}, kMirroredUv[3] = {{1, 0}, {0, 0}, {1, 1}};
  const Float2* uvs = kDefaultUv;
  Float2 ofMesh[3];
  if (run.mesh == nullptr) {
    if (rectangleOf(run).mirrored) uvs = kMirroredUv;
  } else {
    const FaceCorners corners = cornersOf(run, index);
    attributes.hasNormals = run.mesh->normals.empty() ? 0 : 1;
    for (size_t k = 0; k < 3; ++k) {
      if (attributes.hasNormals != 0) {
        const Float3& normal = run.mesh->normals[corners[k]];
        std::ranges::copy(run.placed != nullptr ? placedNormal(*run.placed, normal) : normal, attributes.normal[k]);
      }
      ofMesh[k] = run.mesh->uvs.empty() ? kDefaultUv[k] : run.mesh->uvs[corners[k]];
    }
    // Where a mirrored copy's corners have changed places, their default coordinates have, too.
    if (run.mesh->uvs.empty() && run.placed != nullptr && run.placed->mirrors) std::swap(ofMesh[1], ofMesh[2]);
    uvs = ofMesh;
  }
  for (size_t k = 0; k < 3; ++k) std::ranges::copy(uvs[k], attributes.uv[k]);
  return attributes;
}

PrimitiveSource PrimitiveList::source(size_t first) const {
  return {.quads = {first, counts_.quads},
          .triangles = {first + counts_.quads, counts_.triangles},
          .spheres = {first + counts_.quads + counts_.triangles, counts_.spheres},
          .at = [this, first](size_t i) { return corners<double>(i - first); }};
}

template <class S>
BoundingSphere PrimitiveList::bounds() const {
  Extent all;
  for (const Run& run : runs_) {
    // Each range has an extent of its own, so that threads share nothing.
    std::vector<Extent> parts(rangesOf(run.count));
    forEachRange(parallelFor_, run.count, [&](size_t begin, size_t end) {
      Extent& part = parts[rangesOf(begin)];
      for (size_t i = begin; i < end; ++i) part.include(recordOf<S>(run, run.first + i, false));
    });
    for (const Extent& part : parts) all.include(part);
  }
  return all.sphere();
}
template BoundingSphere PrimitiveList::bounds<float>() const;
template BoundingSphere PrimitiveList::bounds<double>() const;

template <class S>
void PrimitiveList::compile(Primitives<S>& out, size_t firstRecord, size_t firstAttribute) const {
  for (const Run& run : runs_) {
    forEachRange(parallelFor_, run.count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        PrimitiveRecord<S>& record = out.records[firstRecord + run.first + i] = recordOf<S>(run, run.first + i, true);
        if (run.firstAttribute == kNoIndex) continue;
        record.attributes = static_cast<uint32_t>(firstAttribute + run.firstAttribute + i);
        out.attributes[record.attributes] = attribute(run, run.first + i);
      }
    });
  }
  // Lists are compiled in the order of their records, so the shapes of this list come behind those of others.
  const bool emits = std::ranges::any_of(scene_.shapes, [](const Shape& shape) { return shape.emitter != kNone; });
  if (!emits) return;
  for (const Run& run : runs_) {
    const bool lit = scene_.shapes[run.shape].emitter != kNone;
    out.shapeOf.insert(out.shapeOf.end(), run.count, lit ? run.shape : kNone);
  }
}
template void PrimitiveList::compile(Primitives<float>&, size_t, size_t) const;
template void PrimitiveList::compile(Primitives<double>&, size_t, size_t) const;

}  // namespace wavecrest
