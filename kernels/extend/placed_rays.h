// The walkers of a hierarchy of two levels: rays, and packets of them, that pass into the space of a group and back.
//
// A ray in a group's space has the direction that the instance's transform gives it, not of unit length, so distances
// along it are those in the world. Boxes in the group's hierarchy are widened by the rounding of rays that start close
// to the group, so a ray from outside a sphere around the group starts where it enters that sphere, however far away
// its origin is. When the ray leaves the group, its hit there is kept if it is nearer in the world than what was found
// before; so the order in which instances are visited does not matter.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/extend/bvh_ray.h"
#include "kernels/extend/offset.h"

WAVECREST_SIMD_BEGIN

// Relative rounding of a ray's way into a group: of the distance to its origin.
constexpr float kPassageError = static_cast<float>(16 * kUnitRoundoff);

// Overloads for one ray.
WAVECREST_INLINE float rootOf(float a) { return std::sqrt(a); }
WAVECREST_INLINE Float rootOf(Float a) { return sqrt(a); }
WAVECREST_INLINE float sizeOf(float a) { return std::abs(a); }
WAVECREST_INLINE Float sizeOf(Float a) { return abs(a); }
WAVECREST_INLINE float greater(float a, float b) { return std::max(a, b); }
WAVECREST_INLINE Float greater(Float a, Float b) { return max(a, b); }

// Rays in the space of a group. Number: float or Float.
template <class Number>
struct GroupRay {
  Vec3<Number> origin, direction;
  Number shift;         // where it starts, as a distance along the ray in the world
  Number enter, leave;  // bounds of where it is in the sphere, if it meets it
  Number miss2, reach;  // squared distance at which it passes the centre, and up to which distance it meets the sphere

  WAVECREST_INLINE GroupRay(const InstanceLeaf& leaf, Vec3<Number> o, Vec3<Number> d) {
    const auto product = [](Vec3<Number> a, Vec3<Number> b) HWY_ATTR { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const auto inGroup = [&](Vec3<Number> v) HWY_ATTR {
      const auto row = [&](size_t i) HWY_ATTR {
        return Vec3<Number>{Number(leaf.toObject[i][0]), Number(leaf.toObject[i][1]), Number(leaf.toObject[i][2])};
      };
      return Vec3<Number>{product(row(0), v), product(row(1), v), product(row(2), v)};
    };
    // The ray in the group's space. The error of its origin grows with the distance to the group.
    const Vec3<Number> from =
        inGroup({o.x - Number(leaf.place[0]), o.y - Number(leaf.place[1]), o.z - Number(leaf.place[2])});
    direction = inGroup(d);
    const Number error = (sizeOf(from.x) + sizeOf(from.y) + sizeOf(from.z)) * Number(kPassageError);
    // Where it passes the centre of the sphere. The half width of [enter, leave] is that of a ray through the centre,
    // which bounds every chord.
    const Number length2 = product(direction, direction);
    const Number nearest = Number(0.0f) - product(from, direction) / length2;
    const auto at = [&](Number t) HWY_ATTR {
      return Vec3<Number>{from.x + direction.x * t, from.y + direction.y * t, from.z + direction.z * t};
    };
    const Vec3<Number> passing = at(nearest);
    miss2 = product(passing, passing);
    reach = Number(leaf.radius) + error;
    const Number half = (reach + error) / rootOf(length2);
    enter = nearest - half;
    leave = nearest + half;
    // The ray starts where it enters the sphere, or at its own origin if that lies within.
    shift = greater(enter, Number(0.0f));
    origin = at(shift);
  }
};

// A BvhRay that passes into instances. origin and direction are those in the space where the ray is.
template <bool kAnyHit>
struct PlacedRayOf : BvhRay<kAnyHit> {
  using Base = BvhRay<kAnyHit>;
  using Base::hit;
  uint32_t instance;  // of the hit, or kNoIndex

  WAVECREST_INLINE void begin(size_t ray, float ox, float oy, float oz, float dx, float dy, float dz, float end) {
    Base::begin(ray, ox, oy, oz, dx, dy, dz, end);
    std::copy_n(Base::origin, 3, worldOrigin_);
    std::copy_n(Base::direction, 3, worldDirection_);
    instance = kNoIndex;
  }
  // Passes into the group. False, and nothing is changed, if the ray cannot meet the group between its origin and t.
  WAVECREST_INLINE bool enter(const InstanceLeaf& leaf) {
    const GroupRay<float> ray(leaf, {worldOrigin_[0], worldOrigin_[1], worldOrigin_[2]},
                              {worldDirection_[0], worldDirection_[1], worldDirection_[2]});
    if (!(ray.miss2 <= ray.reach * ray.reach && ray.enter <= hit.t && ray.leave >= 0)) return false;
    outside_ = hit;
    shift_ = ray.shift;
    current_ = leaf.index;
    hit.id = kMiss;
    // Whatever may be nearer in the world is found; of a shadow ray nothing at its end.
    hit.t = kAnyHit ? hit.t - shift_ : std::min(hit.t - shift_ + hit.t * kPassageError, kFarthest);
    const float o[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const float d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    Base::aim(o, d);
    return true;
  }
  // Comes back to the world with the nearer of two hits: that in the group, or that from before. Of equally near ones
  // the lower id wins, then the lower index of the instance.
  WAVECREST_INLINE void leave() {
    Base::aim(worldOrigin_, worldDirection_);
    const float there = hit.t + shift_;
    const bool first = hit.id < outside_.id || (hit.id == outside_.id && current_ < instance);
    if (hit.id == kMiss || !(there < outside_.t || (there == outside_.t && first))) {
      hit = outside_;
      return;
    }
    hit.t = there;
    instance = current_;
    if (static_cast<FaceKind>(hit.id >> kFaceKindShift) == FaceKind::sphere) hit.second = there;
  }

 private:
  float worldOrigin_[3], worldDirection_[3];
  BvhHit outside_;  // before the ray entered
  float shift_;
  uint32_t current_;
};
using PlacedRay = PlacedRayOf<false>;

// A BvhPacket that passes into instances as PlacedRayOf does. Rays of a packet pass together.
struct PlacedPacket : BvhPacket {
  UInt instance;

  WAVECREST_INLINE void begin(size_t first, Vec3<Float> o, Vec3<Float> d) {
    BvhPacket::begin(first, o, d);
    worldOrigin_ = o;
    worldDirection_ = d;
    instance = UInt(kNoIndex);
  }
  WAVECREST_INLINE bool enter(const InstanceLeaf& leaf) {
    const GroupRay<Float> ray(leaf, worldOrigin_, worldDirection_);
    const Mask meets = (ray.miss2 <= ray.reach * ray.reach) & (ray.enter <= t) & (ray.leave >= Float(0));
    if (none(meets)) return false;
    outsideT_ = t, outsideSecond_ = second, outsideThird_ = third, outsideId_ = id;
    shift_ = ray.shift;
    current_ = leaf.index;
    id = UInt(kMiss);
    // Rays that miss the group go along with one that does not, and end before they begin.
    t = select(meets, min(t - shift_ + t * Float(kPassageError), Float(kFarthest)), Float(-1));
    end = greatestLane(t);
    // Rays that miss repeat the first ray that meets the group, so they widen none of the packet's intervals.
    const float lanes = leastLane(select(meets, toFloat(laneIndex()), Float(static_cast<float>(kLanes - 1))));
    const auto guide = static_cast<size_t>(lanes);
    const auto guided = [&](Float a) HWY_ATTR {
      HWY_ALIGN float each[kLanes];
      store(a, each);
      return select(meets, a, Float(each[guide]));
    };
    aim({guided(ray.origin.x), guided(ray.origin.y), guided(ray.origin.z)},
        {guided(ray.direction.x), guided(ray.direction.y), guided(ray.direction.z)});
    return true;
  }
  WAVECREST_INLINE void leave() {
    aim(worldOrigin_, worldDirection_);
    const Float there = t + shift_;
    const Mask earlier = (id < outsideId_) | ((id == outsideId_) & (UInt(current_) < instance));
    const Mask nearer = andNot((there < outsideT_) | ((there == outsideT_) & earlier), id == UInt(kMiss));
    const Mask sphere = shiftRight<kFaceKindShift>(id) == UInt(static_cast<uint32_t>(FaceKind::sphere));
    instance = select(nearer, UInt(current_), instance);
    t = select(nearer, there, outsideT_);
    second = select(nearer, select(sphere, there, second), outsideSecond_);
    third = select(nearer, third, outsideThird_);
    id = select(nearer, id, outsideId_);
    end = greatestLane(t);
  }

 private:
  Vec3<Float> worldOrigin_, worldDirection_;
  Float outsideT_, outsideSecond_, outsideThird_;
  UInt outsideId_;
  Float shift_;
  uint32_t current_;
};

WAVECREST_SIMD_END
