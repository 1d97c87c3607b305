// Discs and cylinders as meshes: their curves become segments.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// A disc as rings of quads around a fan, a cylinder as rings of quads with the true normals at the vertices.
Mesh tessellated(const Disk& disk);
Mesh tessellated(const Cylinder& cylinder);

}  // namespace wavecrest
