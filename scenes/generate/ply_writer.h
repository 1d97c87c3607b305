// Writes a mesh as little-endian binary PLY: float x y z nx ny nz per vertex, a uchar-counted int list per face.
#pragma once

#include <filesystem>

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

// The comment becomes a PLY header line (no line breaks in it); the file is written under a temporary name and renamed.
// Throws std::runtime_error when the file cannot be written.
void writePly(const Mesh& mesh, const std::string& comment, const std::filesystem::path& file);

}  // namespace wavecrest::generate
