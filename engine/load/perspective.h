// What cameras and projectors have in common: how their field of view is given, and what their to_world may be.
#pragma once

#include <string_view>

#include "engine/load/parameters.h"

namespace wavecrest {

// The horizontal field of view in degrees, of a picture of this width over height: `fov` along `fov_axis`, or
// `focal_length` of 35 mm film; 50 mm where the file is silent.
double readHorizontalFov(Parameters& parameters, double aspect);

// Throws unless to_world is rotation and translation, with unit axes: Mitsuba refuses any scale. `whose` is for the
// message.
void checkRigid(const Matrix4& toWorld, std::string_view whose, const SourceLocation& where);

// Throws unless its axes are perpendicular and of some length: a picture may be scaled, not sheared.
void checkPerpendicular(const Matrix4& toWorld, std::string_view whose, const SourceLocation& where);

}  // namespace wavecrest
