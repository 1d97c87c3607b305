// From triangles as a file gives them (object space) to a Mesh of the scene: placed, oriented, with its normals.
#pragma once

#include <span>

#include "engine/load/context.h"
#include "engine/load/matrix.h"
#include "engine/load/mesh_attributes.h"

namespace wavecrest {

// Triangles in object space, indices checked by whoever made them.
struct TriangleSoup {
  std::vector<Float3> positions;
  std::vector<Float3> normals;  // empty or one per position
  std::vector<Float2> uvs;      // empty or one per position
  std::vector<std::array<uint32_t, 3>> triangles;
  // Of copies that differ in texture coordinates alone: the vertex that they are. Empty: all vertices are their own.
  std::vector<uint32_t> vertexOf;
  MeshAttribute attribute;    // without values: none is asked for
  uint64_t droppedFaces = 0;  // of fewer than three corners
  bool usesLibrary = false;   // the file gives its faces materials of a library (MTL)
};

struct MeshPlacement {
  Matrix4 toWorld = identityMatrix();
  bool faceNormals = false, flipNormals = false;
};

// Orientation follows the side that Mitsuba 3.9 shades and emits from:
//  - with normals in the file these decide: each triangle is wound so that it faces along them, also when a transform
//    mirrors the mesh;
//  - without them, or with face_normals, the winding in world space decides, mirrored or not; smooth normals are made
//    from it unless face_normals is set;
//  - flip_normals turns both around.
// Triangles without area are left out and counted in Scene::droppedTriangles, with the faces that the soup has dropped.
// An attribute is baked: the bitmap becomes LoadContext::attributeBitmap.
Mesh buildMesh(LoadContext& context, TriangleSoup soup, const MeshPlacement& placement, const SourceLocation& where);

// Normals of all vertices as a mesh has them that is not given any: unit vectors. vertexOf: as in TriangleSoup.
std::vector<Float3> smoothNormals(const Mesh& mesh, std::span<const uint32_t> vertexOf = {});
// A normal of a file after a transform: a unit vector, or zero where it has no direction. normalMatrix: see matrix.h.
Float3 placedNormal(const Matrix4& normalMatrix, const Float3& normal);
// Makes the other side of all triangles the front, as flip_normals does.
void turnAround(Mesh& mesh);

}  // namespace wavecrest
