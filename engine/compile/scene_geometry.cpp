#include "engine/compile/scene_geometry.h"

#include <algorithm>
#include <map>
#include <string>

#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "engine/tasks/parallel_for.h"

namespace wavecrest {
namespace {

// Boxes that together hold all primitives: one around those whose centres are in the same cell of a grid over the
// bounds. An instance's box around them is tighter than one around its transformed bounds.
std::vector<Box> outlineOf(const PrimitiveList& primitives, const BoundingSphere& bounds) {
  // Cells along each axis.
  constexpr size_t kCells = 8;
  std::map<size_t, Extent> cells;
  for (size_t i = 0; i < primitives.counts().total(); ++i) {
    const Extent extent = extentOf(primitives.corners<double>(i));
    size_t cell = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      // The centre's cell along this axis; the first one where the bounds are flat.
      const double size = bounds.high[axis] - bounds.low[axis];
      const double place = ((extent.low[axis] + extent.high[axis]) / 2 - bounds.low[axis]) / size * kCells;
      cell = cell * kCells + static_cast<size_t>(size > 0 ? std::clamp(place, 0.0, kCells - 1.0) : 0);
    }
    cells[cell].include(extent);
  }
  std::vector<Box> outline;
  outline.reserve(cells.size());
  for (const auto& [cell, extent] : cells) outline.push_back(boxOf(extent));
  return outline;
}

// Calls function(p) for each corner of a box.
template <class Function>
void forCorners(const Double3& low, const Double3& high, const Function& function) {
  for (size_t corner = 0; corner < 8; ++corner) {
    Double3 p{};
    for (size_t axis = 0; axis < 3; ++axis) p[axis] = (corner >> axis & 1) != 0 ? high[axis] : low[axis];
    function(p);
  }
}

void assignRows(double (&out)[3][3], const Double3 (&rows)[3]) {
  for (size_t i = 0; i < 3; ++i) assign(out[i], rows[i]);
}

}  // namespace

// Groups are compiled once, in their own space. moveTo does the world and the places of instances.
SceneGeometry::SceneGeometry(const Scene& scene, bool textured, bool keeps)
    : scene_(scene), textured_(textured), keeps_(keeps) {
  if (keeps) {
    for (uint32_t i = 0; i < scene.groups.size(); ++i) addGroup(i);
  }
  moveTo({});
}

void SceneGeometry::addGroup(uint32_t index) {
  const PrimitiveChoice choice{.group = index, .copies = false};
  // A first list finds the group's bounds; a second has its primitives about their centre.
  auto list = std::make_unique<PrimitiveList>(scene_, textured_, parallelFor, Double3{}, choice);
  groupOf_.push_back(kNone);
  if (list->counts().total() == 0) return;
  groupOf_.back() = static_cast<uint32_t>(groups_.size());
  Group& group = groups_.emplace_back();
  // The centre is rounded to float: its difference from a float vertex is exact in double, so vertices that meet still
  // do.
  const BoundingSphere there = list->bounds<double>();
  for (size_t axis = 0; axis < 3; ++axis) group.origin[axis] = static_cast<float>(there.center[axis]);
  list = std::make_unique<PrimitiveList>(scene_, textured_, parallelFor, group.origin, choice);
  // The radius is that of a sphere about the group's origin, which is the centre of the box but for rounding.
  const BoundingSphere bounds = list->bounds<double>();
  group.radius = bounds.radius + length(vec(bounds.center));
  group.outline = outlineOf(*list, bounds);
  group.primitives = std::move(list);
}

void SceneGeometry::moveTo(const Double3& origin) {
  world_ = std::make_unique<PrimitiveList>(scene_, textured_, parallelFor, origin,
                                           PrimitiveChoice{.group = kNone, .copies = !keeps_});
  if (keeps_) placeInstances(origin);
}

// Makes an entry of instances_ for each instance of a group that has primitives, relative to the world's origin.
void SceneGeometry::placeInstances(const Double3& origin) {
  instances_.clear();
  for (const Instance& instance : scene_.instances) {
    if (groupOf_[instance.group] == kNone) continue;
    const Group& group = groups_[groupOf_[instance.group]];
    const Affine toWorld(instance.toWorld);
    // The transform between group and world.
    BvhInstance& placed = instances_.emplace_back();
    placed.group = groupOf_[instance.group];
    assignRows(placed.toWorld, toWorld.linear);
    assignRows(placed.toObject, toWorld.inverse);
    // Rounded to float, in which rays pass into the group, so that every precision has the same place.
    Double3 place = toWorld.point(group.origin) - origin;
    for (double& coordinate : place) coordinate = static_cast<float>(coordinate);
    assign(placed.place, place);
    // The box of the instance in the world.
    Extent extent;
    for (const Box& box : group.outline) {
      forCorners(vec(box.low), vec(box.high), [&](const Double3& p) { extent.include(toWorld.vector(p) + place); });
    }
    placed.box = boxOf(extent);
  }
}

bool SceneGeometry::anyInInstance(const BvhInstance& instance,
                                  const std::function<bool(const Double3&, const Double3&)>& test) const {
  // Tests the box of each primitive in the world; that of a sphere is the box around its box.
  const PrimitiveList& list = *groups_[instance.group].primitives;
  return anyIndex(parallelFor, list.counts().total(), [&](size_t i) {
    const PrimitiveRecord<double> record = list.corners<double>(i);
    Extent extent;
    const auto include = [&](const Double3& p) {
      Double3 there = vec(instance.place);
      for (size_t axis = 0; axis < 3; ++axis) there[axis] += dot(vec(instance.toWorld[axis]), p);
      extent.include(there);
    };
    const auto kind = static_cast<PrimitiveKind>(record.kind);
    const Double3 p = vec(record.p0), u = vec(record.e1), v = vec(record.e2);
    if (kind == PrimitiveKind::sphere) {
      const Double3 radius{u[0], u[0], u[0]};
      forCorners(p - radius, p + radius, include);
    } else {
      for (const Double3& q : {p, p + u, p + v}) include(q);
      if (kind == PrimitiveKind::quad) include(p + u + v);
    }
    return test(extent.low, extent.high);
  });
}

PrimitiveCounts SceneGeometry::counts() const {
  PrimitiveCounts counts = world_->counts();
  for (const Group& group : groups_) {
    counts.quads += group.primitives->counts().quads;
    counts.triangles += group.primitives->counts().triangles;
    counts.spheres += group.primitives->counts().spheres;
  }
  return counts;
}

template <class S>
BoundingSphere SceneGeometry::bounds() const {
  Extent all;
  // The box around the world's primitives and the boxes of instances.
  if (world_->counts().total() != 0) {
    const BoundingSphere world = world_->bounds<S>();
    if (instances_.empty()) return world;
    all.include(Extent{.low = vec(world.low), .high = vec(world.high)});
  }
  for (const BvhInstance& instance : instances_) {
    all.include(Extent{.low = vec(instance.box.low), .high = vec(instance.box.high)});
  }
  return all.sphere();
}
template BoundingSphere SceneGeometry::bounds<float>() const;
template BoundingSphere SceneGeometry::bounds<double>() const;

std::vector<double> SceneGeometry::groupRadii() const {
  std::vector<double> radii(scene_.groups.size(), 0.0);
  for (size_t i = 0; i < groupOf_.size(); ++i) {
    if (groupOf_[i] != kNone) radii[i] = groups_[groupOf_[i]].radius;
  }
  return radii;
}

namespace {

// SceneError if there are more records than lanes can index.
template <class Record>
void checkCount(const Scene& scene, size_t count, const std::string& what) {
  if (count <= kMostIndexed<Record>) return;
  throw SceneError({scene.name},
                   std::to_string(count) + " " + what + "; expected at most " + std::to_string(kMostIndexed<Record>));
}

}  // namespace

template <class S>
Primitives<S> SceneGeometry::compile() const {
  // The lists in the order of their records.
  std::vector<const PrimitiveList*> lists{world_.get()};
  for (const Group& group : groups_) lists.push_back(group.primitives.get());
  size_t records = 0, attributes = 0;
  for (const PrimitiveList* list : lists) {
    records += list->counts().total();
    attributes += list->attributes();
  }
  checkCount<PrimitiveRecord<S>>(scene_, records, "primitives");
  checkCount<AttributeRecord>(scene_, attributes, "primitives with normals or texture coordinates");
  // Room for all, then each list's records behind those of the one before.
  Primitives<S> out;
  out.counts = counts();
  out.records = RecordArray<PrimitiveRecord<S>>(records);
  out.attributes = RecordArray<AttributeRecord>(attributes);
  records = attributes = 0;
  for (const PrimitiveList* list : lists) {
    list->compile(out, records, attributes);
    records += list->counts().total();
    attributes += list->attributes();
  }
  return out;
}
template Primitives<float> SceneGeometry::compile() const;
template Primitives<double> SceneGeometry::compile() const;

template <class S>
RecordArray<InstanceRecord<S>> SceneGeometry::compileInstances() const {
  checkCount<InstanceRecord<S>>(scene_, instances_.size(), "instances");
  RecordArray<InstanceRecord<S>> records(instances_.size());
  for (size_t i = 0; i < records.size(); ++i) {
    records[i] = InstanceRecord<S>{};
    assign(records[i].place, vec(instances_[i].place));
    for (size_t row = 0; row < 3; ++row) {
      assign(records[i].toWorld[row], vec(instances_[i].toWorld[row]));
      assign(records[i].toObject[row], vec(instances_[i].toObject[row]));
    }
  }
  return records;
}
template RecordArray<InstanceRecord<float>> SceneGeometry::compileInstances() const;
template RecordArray<InstanceRecord<double>> SceneGeometry::compileInstances() const;

std::vector<BvhGroup> SceneGeometry::groups() const {
  // A group's records follow those of the world and of the groups before it.
  std::vector<BvhGroup> groups;
  size_t first = world_->counts().total();
  for (const Group& group : groups_) {
    groups.push_back({group.primitives->source(first), group.radius});
    first += group.primitives->counts().total();
  }
  return groups;
}

}  // namespace wavecrest
