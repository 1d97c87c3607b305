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
  const std::string filename = parameters.string("filename", "");
  if (filename.empty()) {
    throw LoadError(parameters.locationOf("filename"),
                    parameters.describe() + " has no filename; expected the path of a mesh file");
  }
  const SourceLocation where = parameters.locationOf("filename");
  TriangleSoup soup = read(context.resolvePath(filename, parameters.object()), flipTexCoords, where);
  return buildMesh(context, std::move(soup), placement, where);
}

}  // namespace

Geometry readPlyShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld, &readPly, false);
}

Geometry readObjShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld, &readObj, true);
}

}  // namespace wavecrest
