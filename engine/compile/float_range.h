// Limits of a scene's size. Rays are intersected in single precision under every precision policy, and beyond these
// limits that overflows or underflows.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace wavecrest {

// Largest product of a scene's squared radius and rayReach. Scenes have a reach of up to nine radii (originOf) without
// the eye and lights.
constexpr double kLargestProduct = 1e38;

// Throws SceneError for a scene, a kept group or a sphere that is too large or too small, and for an instance of a kept
// group that is enlarged or reduced too much. radius: of the scene's bounding sphere. groupRadii: those of
// SceneGeometry::groupRadii. keeps: whether instances are kept, and not replaced by copies. Radii that are NaN are
// refused.
void checkFloatRange(const Scene& scene, double radius, const std::vector<double>& groupRadii, bool keeps);

}  // namespace wavecrest
