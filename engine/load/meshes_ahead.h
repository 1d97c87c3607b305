// The mesh files of a scene, read by several threads before its shapes are built.
//
// Parsing a file is a function of its name and of what the shape says about it, and takes most of the time of loading.
// So it is done ahead and side by side. Shapes are then built one after the other in the order of the file, as ever:
// what reading a file gave, mesh or error, comes to light when its shape is built. Neither the scene nor the error that
// is reported depends on the number of threads.
#pragma once

#include <exception>
#include <map>
#include <optional>
#include <vector>

#include "engine/load/mesh_files.h"

namespace wavecrest {

class MeshesAhead {
 public:
  // Reads the files of these shapes, those of the caller's TBB arena at once. Shapes that cannot be read ahead, as they
  // have wrong parameters, are left to whoever builds them.
  void read(LoadContext& context, const std::vector<const XmlElement*>& shapes);

  // What the shape's file holds, to be taken once; none if it was not read ahead. Throws what reading it threw.
  std::optional<SerializedMesh> take(const XmlElement& shape);

 private:
  struct Result {
    SerializedMesh mesh;
    std::exception_ptr error;
  };
  std::map<const XmlElement*, Result> results_;
};

}  // namespace wavecrest
