// Discs and cylinders as meshes: their curves become segments.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// Segments of a full turn.
constexpr uint32_t kSegments = 256;
// Rings of a disc, and parts of a cylinder along its axis. Triangles as long as the whole shape and as narrow as a
// segment have boxes that overlap by far: closest hits in four times as many shorter ones take three quarters of the
// time.
constexpr uint32_t kRings = 4, kParts = 4;
constexpr uint32_t kDiskTriangles = kSegments * (2 * kRings - 1), kCylinderTriangles = kSegments * 2 * kParts;

// A disc as rings of quads around a fan, a cylinder as rings of quads with the true normals at the vertices.
Mesh tessellated(const Disk& disk);
Mesh tessellated(const Cylinder& cylinder);

}  // namespace wavecrest
