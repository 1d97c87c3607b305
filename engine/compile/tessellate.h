// Discs and cylinders as meshes: their curves become segments.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// A disc as a fan, a cylinder as a ring of quads with the true normals at the vertices.
Mesh tessellated(const Disk& disk);
Mesh tessellated(const Cylinder& cylinder);

}  // namespace wavecrest
