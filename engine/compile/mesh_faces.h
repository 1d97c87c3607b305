// The triangles of a mesh as the primitives that stand for them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"
#include "kernels/columns/parallel_ranges.h"

namespace wavecrest {

// The corners of a triangle; of a parallelogram a corner, then its neighbours along u and v.
using FaceCorners = std::array<uint32_t, 3>;

// Coplanar pairs of triangles that form a parallelogram (each face of a cube) become one, in small meshes. Triangles
// without area are left out: they cannot be hit.
struct MeshFaces {
  std::vector<FaceCorners> quads;
  std::vector<uint32_t> triangles;  // which of the mesh's are left, unless allTriangles
  bool allTriangles = false;        // the triangles are those of the mesh, as they are
  bool canTurn = false;             // it does not matter which corner of a triangle is the first

  size_t triangleCount(const Mesh& mesh) const { return allTriangles ? mesh.triangles.size() : triangles.size(); }
  const FaceCorners& triangle(const Mesh& mesh, size_t i) const {
    return mesh.triangles[allTriangles ? i : triangles[i]];
  }
};
// usesUv: (u, v) matters to the material or the light. Without texture coordinates triangles then stay apart, since
// each has its own (u, v). origin: that of the kernels, in the mesh's coordinates. copied: the faces are those of
// copies in other places, whose vertices are rounded once more. Only exact parallelograms then become quads.
MeshFaces facesOf(const Mesh& mesh, bool usesUv, const Double3& origin, bool copied, const ParallelFor& parallelFor);

}  // namespace wavecrest
