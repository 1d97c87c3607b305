// Readers of the shapes `ply`, `obj` and `serialized`.
#include "engine/load/mesh_shapes.h"

#include <array>
#include <optional>
#include <utility>

#include "engine/load/input_file.h"
#include "engine/load/meshes_ahead.h"
#include "engine/load/shapes.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// The parameters that all meshes have. max_smooth_angle has no meaning for a mesh without vertex normals.
MeshPlacement readPlacement(Parameters& parameters, const Matrix4& toWorld) {
  const MeshPlacement placement{.toWorld = toWorld,
                                .faceNormals = parameters.boolean("face_normals", false),
                                .flipNormals = parameters.boolean("flip_normals", false)};
  if (!placement.faceNormals) {
    parameters.leaveOut({"max_smooth_angle"},
                        "normals of the file are kept, others are smoothed over edges of any angle");
  }
  parameters.ignore({"max_smooth_angle"});
  return placement;
}

// Mitsuba 0.6 loads one mesh of an OBJ file by its index, and takes materials from the library that the file names.
void checkLegacyObj(LoadContext& context, Parameters& parameters, const TriangleSoup& soup) {
  constexpr int64_t kAll = -1, kMostMeshes = int64_t{1} << 31;
  if (parameters.integer("shape_index", kAll, kAll, kMostMeshes) != kAll) {
    context.unsupported(parameters.locationOf("shape_index"),
                        "one mesh of an OBJ file is not supported; expected a file of this mesh alone, without "
                        "shape_index");
  }
  if (!parameters.boolean("load_materials", true) || !soup.usesLibrary || !parameters.objects("bsdf").empty()) return;
  // The medium of a null boundary has a warning of its own; that of a light is left to finish().
  const bool isLight = !parameters.objects("emitter").empty();
  const bool isNull = !isLight && !parameters.objects("medium").empty();
  context.note(parameters.locationOf("filename"), "materials of an OBJ file (mtllib, usemtl)",
               isLight  ? "left out: a light without a bsdf is black"
               : isNull ? "left out: a shape with a medium and without a bsdf is null"
                        : "left out: a shape without a bsdf is diffuse of reflectance 0.5");
}

// A mesh from a file that has only this mesh, without attributes. The file may have been read ahead.
Geometry readMeshShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  const MeshPlacement placement = readPlacement(parameters, toWorld);
  const MeshFile file = meshFileOf(context, parameters);
  context.listFile(file.path);
  std::optional<SerializedMesh> ahead = context.meshesAhead->take(parameters.object());
  TriangleSoup soup = ahead ? std::move(ahead->soup) : readMeshFile(file);
  if (file.kind == MeshFile::Kind::obj && parameters.object().legacy) checkLegacyObj(context, parameters, soup);
  return buildMesh(context, std::move(soup), placement, file.where);
}

}  // namespace

MeshFile meshFileOf(const LoadContext& context, Parameters& parameters) {
  constexpr int64_t kMostMeshes = int64_t{1} << 31;
  const std::string_view type = parameters.object().get("type");
  MeshFile file{.kind = type == "obj"          ? MeshFile::Kind::obj
                        : type == "serialized" ? MeshFile::Kind::serialized
                                               : MeshFile::Kind::ply,
                .path = {},
                .where = {}};
  // As in Mitsuba, the v of obj files is flipped by default.
  file.flipTexCoords = parameters.boolean("flip_tex_coords", file.kind == MeshFile::Kind::obj);
  // Mitsuba 0.6 makes a mesh of each group and each material, and smooths normals within it.
  if (file.kind == MeshFile::Kind::obj && parameters.object().legacy) {
    file.separateMeshes = !parameters.boolean("collapse", false);
  }
  if (file.kind == MeshFile::Kind::serialized) {
    file.index = static_cast<uint32_t>(parameters.integer("shape_index", 0, 0, kMostMeshes));
  }
  // Errors about the file are reported at the line that names it.
  const std::string filename = parameters.requiredString("filename");
  file.where = parameters.locationOf("filename");
  file.path = context.findFile(filename, parameters.object());
  return file;
}

TriangleSoup readMeshFile(const MeshFile& file) {
  return file.kind == MeshFile::Kind::obj ? readObj(file.path, file.flipTexCoords, file.separateMeshes, file.where)
                                          : readPly(file.path, file.flipTexCoords, file.where);
}

// Files of meshes with an attribute are not read ahead.
Geometry readPlyShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  if (context.meshAttribute.empty()) return readMeshShape(context, parameters, toWorld);
  const MeshPlacement placement = readPlacement(parameters, toWorld);
  const MeshFile file = meshFileOf(context, parameters);
  context.listFile(file.path);
  TriangleSoup soup = readPly(file.path, file.flipTexCoords, file.where, context.meshAttribute);
  if (soup.attribute.ofWholeNumbers) {
    context.warn(file.where, "attribute " + inQuotes(context.meshAttribute) +
                                 " has whole numbers, which are taken as they are; expected floats, with 1 for white");
  }
  return buildMesh(context, std::move(soup), placement, file.where);
}

Geometry readObjShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  return readMeshShape(context, parameters, toWorld);
}

Geometry readSerializedShape(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  const MeshPlacement placement = readPlacement(parameters, toWorld);
  const MeshFile file = meshFileOf(context, parameters);
  context.listFile(file.path);
  // Take the mesh that was read ahead, or read it from the archive.
  std::optional<SerializedMesh> mesh = context.meshesAhead->take(parameters.object());
  if (!mesh) {
    const std::string path = file.path.string();
    // A scene's meshes mostly share one file.
    std::shared_ptr<const std::vector<char>>& archive = context.meshArchives[path];
    if (!archive) archive = std::make_shared<const std::vector<char>>(readInputFile(path, file.where));
    mesh = readSerialized(*archive, path, file.index);
  }
  // Mitsuba does not look at what the mesh asks for: 0.6 overwrites the flag with the shape's parameter.
  if (mesh->faceNormals && !placement.faceNormals) {
    context.note(file.where, "face normals that a serialized mesh asks for",
                 "left out, as in Mitsuba: face_normals of the shape decides");
  }
  // Mitsuba 0.6 turns the triangles of a mirrored mesh around, of serialized meshes only.
  if (parameters.object().legacy && determinant3(toWorld) < 0) {
    for (std::array<uint32_t, 3>& t : mesh->soup.triangles) std::swap(t[0], t[1]);
  }
  // readSerialized leaves the texture coordinates as they are.
  if (file.flipTexCoords) {
    for (Float2& uv : mesh->soup.uvs) uv[1] = 1 - uv[1];
  }
  return buildMesh(context, std::move(mesh->soup), placement, file.where);
}

}  // namespace wavecrest
