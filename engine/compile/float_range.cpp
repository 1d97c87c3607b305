#include "engine/compile/float_range.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/compile/affine.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// Numbers below 1e-38 are flushed to zero. The test of a sphere multiplies two lengths. That of a face multiplies two
// edges and the height of the ray's origin above the face: at the smallest radius R, edges of 1e-4 R and heights of
// 1e-6 R are met.
constexpr double kLargestRadius = 2e12, kSmallestRadius = 1e-8, kSmallestSphere = 1e-18;
// Largest factor by which an instance enlarges its group. Ray directions in the group's space are shorter by it, and
// their squared length must not be flushed to zero.
constexpr double kLargestStretch = 1e18;

bool isInRange(double radius) { return radius >= kSmallestRadius && radius <= kLargestRadius; }

void checkRadii(const Scene& scene, double radius, const std::vector<double>& groupRadii) {
  if (!isInRange(radius)) {
    throw SceneError(SourceLocation{scene.name}, fmt::format("the scene's radius is {:g}; expected {:g} to {:g}",
                                                             radius, kSmallestRadius, kLargestRadius));
  }
  for (size_t i = 0; i < groupRadii.size(); ++i) {
    if (groupRadii[i] == 0 || isInRange(groupRadii[i])) continue;
    throw SceneError(scene.groups[i].source,
                     fmt::format("the radius of shapegroup {} is {:g}; expected {:g} to {:g}, or `--instances expand`",
                                 scene.groups[i].id, groupRadii[i], kSmallestRadius, kLargestRadius));
  }
}

// For each group, the smallest scale of its instances; infinity if it has none.
std::vector<double> leastScales(const Scene& scene) {
  std::vector<double> scales(scene.groups.size(), std::numeric_limits<double>::infinity());
  for (const Instance& instance : scene.instances) {
    double& least = scales[instance.group];
    least = std::min(least, Affine(instance.toWorld).scale());
  }
  return scales;
}

void checkSpheres(const Scene& scene, bool keeps) {
  // Copies of spheres have the scale of their instance.
  const std::vector<double> scales = keeps ? std::vector<double>(scene.groups.size(), 1.0) : leastScales(scene);
  for (const Shape& shape : scene.shapes) {
    const auto* sphere = std::get_if<Sphere>(&shape.kind);
    if (sphere == nullptr || sphere->radius == 0) continue;
    const double size = sphere->radius * (shape.group == kNone ? 1 : scales[shape.group]);
    if (size >= kSmallestSphere) continue;
    throw SceneError(shape.source,
                     fmt::format("a sphere's radius is {:g}; expected at least {:g}", size, kSmallestSphere));
  }
}

// The Frobenius norm: at least the length of any transformed unit vector, and at most sqrt(3) times the greatest one.
double greatestStretch(const Double3 (&rows)[3]) {
  return std::sqrt(dot(rows[0], rows[0]) + dot(rows[1], rows[1]) + dot(rows[2], rows[2]));
}

// In a group's space, float has to hold the squared length of a ray's direction and its product with two edges. The
// segments of shadow rays are up to three scene radii long.
void checkInstances(const Scene& scene, double radius, const std::vector<double>& groupRadii) {
  for (const Instance& instance : scene.instances) {
    const double groupRadius = groupRadii[instance.group];
    if (groupRadius == 0) continue;
    const Affine toWorld(instance.toWorld);
    const double stretch = greatestStretch(toWorld.linear);
    const double longest = greatestStretch(toWorld.inverse) * std::max(1.0, 3 * radius);
    const double largest = longest * std::max(longest, groupRadius * groupRadius);
    if (stretch <= kLargestStretch && largest <= kLargestProduct) continue;
    throw SceneError(instance.source,
                     fmt::format("an instance makes {:g} of the radius {:g} of shapegroup {}, which is beyond single "
                                 "precision; expected `--instances expand`",
                                 groupRadius * toWorld.scale(), groupRadius, scene.groups[instance.group].id));
  }
}

}  // namespace

void checkFloatRange(const Scene& scene, double radius, const std::vector<double>& groupRadii, bool keeps) {
  checkRadii(scene, radius, groupRadii);
  checkSpheres(scene, keeps);
  checkInstances(scene, radius, groupRadii);
}

}  // namespace wavecrest
