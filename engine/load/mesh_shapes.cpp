// Readers of the shapes `ply`, `obj` and `serialized`.
#include "engine/load/input_file.h"
#include "engine/load/mesh_files.h"
#include "engine/load/shapes.h"

namespace wavecrest {

namespace {

using FileReader = TriangleSoup (*)(const std::filesystem::path&, bool, const SourceLocation&);

MeshPlacement readPlacement(Parameters& parameters, const Matrix4& toWorld) {
  const MeshPlacement placement{.toWorld = toWorld,
                                .faceNormals = parameters.boolean("face_normals", false),
                                .flipNormals = parameters.boolean("flip_normals", false)};
  if (!placement.faceNormals) {
    parameters.leaveOut({"max_smooth_angle"}, "normals are smoothed over edges of any angle");
  }
  parameters.ignore({"max_smooth_angle"});
  return placement;
}

Geometry readMeshShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld, FileReader read,
                       bool flipTexCoordsDefault) {
  const MeshPlacement placement = readPlacement(parameters, toWorld);
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
  const auto read = [](const std::filesystem::path& path, bool flip, const SourceLocation& where) {
    return readPly(path, flip, where);
  };
  if (context.meshAttribute.empty()) return readMeshShape(context, parameters, toWorld, read, false);
  const MeshPlacement placement = readPlacement(parameters, toWorld);
  const bool flipTexCoords = parameters.boolean("flip_tex_coords", false);
  const std::string filename = parameters.requiredString("filename");
  const SourceLocation where = parameters.locationOf("filename");
  const std::filesystem::path path = context.resolvePath(filename, parameters.object());
  return buildMesh(context, readPly(path, flipTexCoords, where, context.meshAttribute), placement, where);
}

Geometry readObjShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld, &readObj, true);
}

Geometry readSerializedShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  constexpr int64_t kMostMeshes = int64_t{1} << 31;
  MeshPlacement placement = readPlacement(parameters, toWorld);
  const bool flipTexCoords = parameters.boolean("flip_tex_coords", false);
  const auto index = static_cast<uint32_t>(parameters.integer("shape_index", 0, 0, kMostMeshes));
  const std::string filename = parameters.requiredString("filename");
  const SourceLocation where = parameters.locationOf("filename");
  const std::string path = context.resolvePath(filename, parameters.object()).string();
  // A scene's meshes mostly share one file.
  std::shared_ptr<const std::vector<char>>& archive = context.meshArchives[path];
  if (!archive) archive = std::make_shared<const std::vector<char>>(readInputFile(path, where));
  SerializedMesh mesh = readSerialized(*archive, path, index);
  placement.faceNormals = placement.faceNormals || mesh.faceNormals;
  if (flipTexCoords) {
    for (Float2& uv : mesh.soup.uvs) uv[1] = 1 - uv[1];
  }
  return buildMesh(context, std::move(mesh.soup), placement, where);
}

}  // namespace wavecrest
