// Mesh files: PLY (ASCII, binary of either byte order) and OBJ, each plain or gzipped, and Mitsuba's serialized meshes.
#pragma once

#include <filesystem>
#include <span>

#include "engine/load/mesh_build.h"

namespace wavecrest {

// `where` is the line of the XML that names the file. Polygons are cut into triangles (polygon.h).
// `attribute` is the name of one to read along, or empty.
TriangleSoup readPly(const std::filesystem::path& path, bool flipTexCoords, const SourceLocation& where,
                     const std::string& attribute = {});
// separateMeshes: each group (g) and each material (usemtl) has vertices of its own.
TriangleSoup readObj(const std::filesystem::path& path, bool flipTexCoords, bool separateMeshes,
                     const SourceLocation& where);

// Mesh `index` of a serialized file in memory, whose name errors give.
struct SerializedMesh {
  TriangleSoup soup;
  bool faceNormals = false;  // the file asks for facets, to which Mitsuba does not listen
};
SerializedMesh readSerialized(std::span<const char> file, const std::string& name, uint32_t index);

}  // namespace wavecrest
