// Cuts a face of more than three corners into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace wavecrest {

// Corners of a concave face that is cut: the time grows with their square.
constexpr size_t kMostConcaveCorners = 8192;

// Triangles of corner numbers, with the winding of the face. A convex face becomes a fan around its first corner, as in
// Mitsuba, planar or not. Ears are cut off a concave one, along the plane of its mean normal, so that the triangles
// cover the face whichever corner comes first. Of a face that crosses itself they cover something like it.
// Empty: concave, with more than kMostConcaveCorners corners.
std::vector<std::array<uint32_t, 3>> cutPolygon(std::span<const Float3> corners);
// The error message for that.
std::string tooManyCorners(size_t corners);

}  // namespace wavecrest
