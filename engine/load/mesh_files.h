// Mesh files: PLY (ASCII, binary of either byte order) and OBJ, each plain or gzipped.
#pragma once

#include <filesystem>

#include "engine/load/mesh_build.h"

namespace wavecrest {

// `where` is the line of the XML that names the file. Polygons are cut into fans of triangles.
TriangleSoup readPly(const std::filesystem::path& path, bool flipTexCoords, const SourceLocation& where);
TriangleSoup readObj(const std::filesystem::path& path, bool flipTexCoords, const SourceLocation& where);

}  // namespace wavecrest
