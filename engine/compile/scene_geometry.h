// All primitives of a scene: those of the world, and of a scene that keeps its instances (instances.h) those of each
// group, once, with where the group is.
//
// A group's space is moved so that its box is about the origin: rays start close to it there, and float resolves it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "engine/compile/primitives.h"
#include "kernels/extend/bvh.h"

namespace wavecrest {

class SceneGeometry {
 public:
  // keeps: two levels; otherwise instances are copies in the world. The scene must outlive this.
  SceneGeometry(const Scene& scene, bool textured, bool keeps);
  // Puts the origin of the world there (originOf).
  void moveTo(const Double3& origin);

  const PrimitiveList& world() const { return *world_; }
  PrimitiveCounts counts() const;
  // Of the world as S has it, with the boxes of instances.
  template <class S>
  BoundingSphere bounds() const;
  // Of each of the scene's groups, the radius of a sphere about its origin with all of it in; 0: it is not kept, or has
  // no primitives.
  std::vector<double> groupRadii() const;

  // Primitives of the groups come after those of the world. This and the next throw SceneError where there are more
  // records than lanes can index.
  template <class S>
  Primitives<S> compile() const;
  template <class S>
  RecordArray<InstanceRecord<S>> compileInstances() const;
  // What the hierarchy is built from; it refers to this.
  std::vector<BvhGroup> groups() const;
  const std::vector<BvhInstance>& instances() const { return instances_; }
  // Whether test(low, high) holds for the box in the world of any primitive of an instance.
  bool anyInInstance(const BvhInstance& instance,
                     const std::function<bool(const Double3& low, const Double3& high)>& test) const;

 private:
  struct Group {
    std::unique_ptr<PrimitiveList> primitives;
    Double3 origin{};  // of its space, in the coordinates of its shapes
    double radius = 0;
    std::vector<Box> outline;  // boxes that hold all of it, closer than the one around it
  };
  void addGroup(uint32_t index);
  void placeInstances(const Double3& origin);

  const Scene& scene_;
  bool textured_, keeps_;
  std::unique_ptr<PrimitiveList> world_;
  std::vector<Group> groups_;
  std::vector<uint32_t> groupOf_;  // index in groups_ of each of the scene's, or kNone: it has no primitives
  std::vector<BvhInstance> instances_;
};

}  // namespace wavecrest
