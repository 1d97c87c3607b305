// Prepares the Stanford dragon for rendering: from the scan's gzipped ASCII PLY to a mesh that stands on the floor.
//
// In the result unused vertices are gone, the feet stand 0.002 above y = 0, the model is 1.44 high and 2.05 long,
// centred over the origin, facing +z with its head towards -x, and every vertex has an area-weighted normal.
#pragma once

#include <filesystem>

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

// Reads an ASCII PLY of x y z vertices and triangles, gzipped or not. Normals are left empty.
// Throws std::runtime_error, naming the file and what was expected, when it is anything else.
Mesh readScan(const std::filesystem::path& file);

// Drops unused vertices, moves and scales the scan as described above and computes its vertex normals.
Mesh prepareDragon(const Mesh& scan);

}  // namespace wavecrest::generate
