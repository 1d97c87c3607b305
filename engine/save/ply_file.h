// A mesh of the scene as a PLY file.
#pragma once

#include <vector>

#include "engine/load/mesh_attributes.h"

namespace wavecrest {

struct PlyContent {
  bool normals = false;
  MeshAttribute attribute{};  // of vertices, instead of texture coordinates; without channels: none
};

// Binary, little-endian: x y z, and nx ny nz if asked for; the attribute as NAME_0 and so on, or u v if the mesh has
// them; all float32. Triangles are lists of three 32-bit indices. The loader turns normals into unit vectors. Where
// that would change a normal's last bit, or the sign of a zero, a longer vector is written, of which it makes the same
// normal.
std::vector<unsigned char> plyBytes(const Mesh& mesh, const PlyContent& content);

}  // namespace wavecrest
