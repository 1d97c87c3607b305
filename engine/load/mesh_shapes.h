// The file that a shape of type `ply`, `obj` or `serialized` names.
#pragma once

#include "engine/load/mesh_files.h"
#include "engine/load/parameters.h"

namespace wavecrest {

struct MeshFile {
  enum class Kind { ply, obj, serialized };
  Kind kind = Kind::ply;
  std::filesystem::path path;
  SourceLocation where;  // of the name in the XML
  bool flipTexCoords = false;
  bool separateMeshes = false;  // the groups of an OBJ file (readObj)
  uint32_t index = 0;           // of the mesh within a serialized file
};

MeshFile meshFileOf(const LoadContext& context, Parameters& parameters);
// Of a kind that has one mesh to a file.
TriangleSoup readMeshFile(const MeshFile& file);

}  // namespace wavecrest
