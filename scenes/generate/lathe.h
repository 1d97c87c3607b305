// Bodies of revolution about the y axis: a profile in the half plane (radius, height), turned around.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

struct ProfilePoint {
  double radius = 0, height = 0;
  double normalRadius = 0, normalHeight = 0;  // unit, to the right of the walk along the profile (outwards, going up)
};

// A smooth curve through the given (radius, height) points, `steps` points per span (centripetal Catmull-Rom, Yuksel et
// al. 2011). Where it starts or ends on the axis it does so at a right angle, so that the turned body is smooth there.
std::vector<ProfilePoint> smoothProfile(std::span<const std::array<double, 2>> points, int steps);

// Turns the profile around the y axis and appends it to the mesh. Points with radius 0 become a single vertex.
void appendLathe(Mesh& mesh, std::span<const ProfilePoint> profile, uint32_t segments);

// An open truncated cone about the y axis, lower radius at y = 0, normals outwards.
Mesh makeCone(double lowerRadius, double upperRadius, double height, uint32_t segments);

}  // namespace wavecrest::generate
