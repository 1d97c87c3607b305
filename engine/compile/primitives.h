// Shapes to primitive records: the scene's geometry as the kernels see it.
//
// A PrimitiveList knows what every record will be and makes each when it is asked for, from any thread: the hierarchy
// is built from records in double, the kernels read others in their own precision, and only the latter are kept.
#pragma once

#include <deque>
#include <map>
#include <vector>

#include "engine/compile/affine.h"
#include "engine/compile/bounds.h"
#include "engine/compile/mesh_faces.h"
#include "engine/compile/record_array.h"
#include "engine/scene/scene.h"
#include "kernels/extend/primitive_source.h"
#include "kernels/scene_view.h"

namespace wavecrest {

struct PrimitiveCounts {
  uint32_t quads = 0, triangles = 0, spheres = 0;
  uint32_t total() const { return quads + triangles + spheres; }
};

template <class S>
struct Primitives {
  RecordArray<PrimitiveRecord<S>> records;  // quads, then triangles, then spheres
  RecordArray<AttributeRecord> attributes;
  PrimitiveCounts counts;
  std::vector<uint32_t> shapeOf;  // of each record whose shape emits light, else kNone; empty if no shape does
};

// Which primitives of a scene a list has: those of one group, in its space; or those of the world, with a copy of each
// group's for every instance or without.
struct PrimitiveChoice {
  uint32_t group = kNone;
  bool copies = true;
};

// Rectangles become quads, meshes triangles and quads (mesh_faces.h). Records are computed in double and rounded once
// to S. Attributes are kept where shading needs them: for smooth meshes, and for all that may be textured if
// `textured`. Positions are relative to `origin`.
class PrimitiveList {
 public:
  // The scene must outlive the list. Throws SceneError where there are more primitives than hits can name.
  PrimitiveList(const Scene& scene, bool textured, const ParallelFor& parallelFor, const Double3& origin = {},
                PrimitiveChoice choice = {});

  const PrimitiveCounts& counts() const { return counts_; }
  // Without light and attributes.
  template <class S>
  PrimitiveRecord<S> geometry(size_t index) const;
  // The same without the normals of meshes' faces, which neither hierarchies nor boxes need.
  template <class S>
  PrimitiveRecord<S> corners(size_t index) const;
  // For the hierarchy. first: where the list's records begin among those of the whole scene.
  PrimitiveSource source(size_t first = 0) const;
  // As S has it.
  template <class S>
  BoundingSphere bounds() const;
  size_t attributes() const { return attributes_; }
  // Writes its records from these indices on.
  template <class S>
  void compile(Primitives<S>& out, size_t firstRecord, size_t firstAttribute) const;

 private:
  // Consecutive primitives of one shape and kind.
  struct Run {
    uint32_t shape;
    PrimitiveKind kind;
    uint32_t first, count;    // primitives
    uint32_t firstAttribute;  // or kNoIndex: they have none
    const Mesh* mesh;         // or nullptr: of a rectangle or sphere
    const MeshFaces* faces;
    bool moved;            // the mesh is relative to the origin already
    const Affine* placed;  // of a copy, or nullptr
  };
  // The triangles of a shape, if it has any.
  struct Surface {
    const Mesh* mesh = nullptr;
    const MeshFaces* faces = nullptr;
    bool moved = false;
  };

  void addShape(uint32_t shape, const Affine* placed);
  Surface surfaceOf(const Shape& shape, bool copied);
  void addRun(Run run, size_t count);
  void orderRuns();
  const Run& runOf(size_t index) const;
  FaceCorners cornersOf(const Run& run, size_t index) const;
  Double3 cornerOf(const Run& run, uint32_t vertex) const;
  Rectangle rectangleOf(const Run& run) const;
  // withNormal: of a mesh's face; other kinds have theirs always.
  template <class S>
  PrimitiveRecord<S> recordOf(const Run& run, size_t index, bool withNormal) const;
  AttributeRecord attribute(const Run& run, size_t index) const;

  const Scene& scene_;
  const bool textured_;
  const ParallelFor parallelFor_;
  const Double3 origin_;
  std::deque<Mesh> tessellations_;
  std::deque<MeshFaces> faces_;
  std::deque<Affine> placements_;
  std::map<uint32_t, Surface> surfaces_;  // by shape
  std::vector<Run> runs_;
  PrimitiveCounts counts_;
  size_t attributes_ = 0;
};

}  // namespace wavecrest
