#include "engine/compile/instances.h"

#include <fmt/core.h>

#include <vector>

#include "engine/compile/affine.h"
#include "engine/compile/tessellate.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

// About the primitives that a shape becomes.
uint64_t primitivesOf(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape.kind)) return mesh->triangles.size();
  if (std::holds_alternative<Disk>(shape.kind)) return kDiskTriangles;
  return std::holds_alternative<Cylinder>(shape.kind) ? kCylinderTriangles : 1;
}

struct GroupSize {
  uint64_t primitives = 0, instances = 0;
  bool spheres = false;
};

std::vector<GroupSize> sizesOf(const Scene& scene) {
  std::vector<GroupSize> sizes(scene.groups.size());
  for (const Shape& shape : scene.shapes) {
    if (shape.group == kNone) continue;
    sizes[shape.group].primitives += primitivesOf(shape);
    sizes[shape.group].spheres |= std::holds_alternative<Sphere>(shape.kind);
  }
  for (const Instance& instance : scene.instances) ++sizes[instance.group].instances;
  return sizes;
}

// The first instance that makes another shape of a sphere, or nullptr.
const Instance* deformingInstance(const Scene& scene, const std::vector<GroupSize>& sizes) {
  for (const Instance& instance : scene.instances) {
    if (sizes[instance.group].spheres && !Affine(instance.toWorld).isUniform()) return &instance;
  }
  return nullptr;
}

}  // namespace

bool keepsInstances(const Scene& scene, Accel accel, Instancing instancing) {
  if (scene.instances.empty()) return false;
  const std::vector<GroupSize> sizes = sizesOf(scene);
  uint64_t copies = 0;  // beyond one of each group
  for (const GroupSize& group : sizes) {
    if (group.instances > 1) copies += group.primitives * (group.instances - 1);
  }
  const Instance* const deforming = deformingInstance(scene, sizes);
  if (instancing == Instancing::expanded && deforming != nullptr) {
    throw SceneError(deforming->source,
                     "an instance of a sphere scales it differently along its axes; expected `--instances keep`");
  }
  const bool few = copies <= kMostCopies && deforming == nullptr;
  const bool keeps = instancing == Instancing::kept || (instancing == Instancing::automatic && !few);
  if (keeps && (accel == Accel::small || accel == Accel::embree)) {
    if (deforming != nullptr) {
      throw SceneError(deforming->source,
                       "an instance of a sphere scales it differently along its axes, for an intersector that knows no "
                       "instances; expected `--accel bvh`");
    }
    throw SceneError(scene.instances.front().source,
                     fmt::format("instances, {} primitives as copies, for an intersector that knows none; expected "
                                 "`--accel bvh`, or `--instances expand`",
                                 copies));
  }
  return keeps;
}

}  // namespace wavecrest
