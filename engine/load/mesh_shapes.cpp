// Readers of the shapes `ply` and `obj`.
#include "engine/load/mesh_files.h"
#include "engine/load/shapes.h"

namespace wavecrest {

namespace {

using FileReader = TriangleSoup (*)(const std::filesystem::path&, bool, const SourceLocation&);

Geometry readMeshShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld, FileReader read,
                       bool flipTexCoordsDefault) {
  const MeshPlacement placement{.toWorld = toWorld,
                                .faceNormals = parameters.boolean("face_normals", false),
                                .flipNormals = parameters.boolean("flip_normals", false)};
  const bool flipTexCoords = parameters.boolean("flip_tex_coords", flipTexCoordsDefault);
  const std::string filename = parameters.requiredString("filename");
  const SourceLocation where = parameters.locationOf("filename");
  const std::filesystem::path path = context.resolvePath(filename, parameters.object());
  if (!context.inShapeGroup) return buildMesh(context, read(path, flipTexCoords, where), placement, where);
  // Every instance of the group asks for the same file.
  std::shared_ptr<const TriangleSoup>& soup = context.groupMeshes[(flipTexCoords ? "flipped:" : "") + path.string()];
  if (!soup) soup = std::make_shared<const TriangleSoup>(read(path, flipTexCoords, where));
  return buildMesh(context, *soup, placement, where);
}

}  // namespace

Geometry readPlyShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld, &readPly, false);
}

Geometry readObjShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld, &readObj, true);
}

}  // namespace wavecrest
