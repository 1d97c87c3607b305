// One ray in the hierarchy of bvh.h, and a packet of rays that stay together: the walkers of walk_bvh.h.
#pragma once

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "kernels/extend/walk_bvh.h"

WAVECREST_SIMD_BEGIN

template <size_t kCount>
WAVECREST_INLINE Vec3<FloatGroup<kCount>> broadcast(const float* a) {
  return {a[0], a[1], a[2]};
}
template <size_t kCount>
WAVECREST_INLINE Vec3<FloatGroup<kCount>> loadPoints(const float (&a)[3][kCount]) {
  return {loadGroup<kCount>(a[0]), loadGroup<kCount>(a[1]), loadGroup<kCount>(a[2])};
}
// The end of a ray that has none: finite, so that no hit is at infinity.
constexpr float kFarthest = std::numeric_limits<float>::max();
// The end of a shadow ray: just short of 1, as nothing at the segment's end may block it.
constexpr float kShadowEnd = 0x1.fffffep-1f;
// Offset in BvhNode::bounds from the low planes of an axis to those by which a ray enters whose direction is d there:
// 0, or the row to the high planes. Those by which it leaves are in the next row.
WAVECREST_INLINE uint32_t nearPlanes(float d) { return std::signbit(d) ? kBvhWidth : 0; }

// The axis of the greatest part of a direction. Without a branch: no processor foresees those of incoherent rays.
WAVECREST_INLINE uint32_t greatestAxis(float x, float y, float z) {
  x = std::abs(x), y = std::abs(y), z = std::abs(z);
  const uint32_t isX = static_cast<uint32_t>(x >= y) & static_cast<uint32_t>(x >= z);
  return (1 - isX) * (2 - static_cast<uint32_t>(y >= z));
}

// The power of two up to |a|. a: 1 over the direction's greatest part. Directions are multiplied by it for the test of
// spheres, whose products float would not hold for the long segments of shadow rays or the short directions of rays in
// small groups. Of a unit vector it is 1 or, through rounding, 1/2, and changes no distance.
constexpr uint32_t kExponentBits = 0x7f800000u;
WAVECREST_INLINE float powerUpTo(float a) { return std::bit_cast<float>(std::bit_cast<uint32_t>(a) & kExponentBits); }
WAVECREST_INLINE Float powerUpTo(Float a) { return fromBits(bits(a) & UInt(kExponentBits)); }

// What a ray has met. t: nothing beyond counts, the distance of the hit or the ray's end. second, third: weights of the
// corners, or t and 0 of a sphere. id: of the face, or kMiss.
struct BvhHit {
  float t, second, third;
  uint32_t id;
};

// A single ray. kAnyHit: of a shadow ray, whose walk ends with any hit before the ray's end.
template <bool kAnyHit>
struct alignas(64) BvhRay {
  static constexpr size_t kUnderWay = 64;
  float origin[4] = {}, inverse[4] = {};  // the fourth numbers fill a register
  float direction[3];
  uint32_t nearPlane[3];
  RayAxes axes;
  float shear[3];
  BvhHit hit;         // the nearest so far
  BvhHit notNearest;  // where a leaf writes what is not: keep() has no branch
  uint32_t index, at, waiting = 0;
  uint32_t stack[kBvhStack];

  // ray: the index by which the caller knows it. end: the distance beyond which no hit counts.
  WAVECREST_INLINE void begin(size_t ray, float ox, float oy, float oz, float dx, float dy, float dz, float end) {
    index = static_cast<uint32_t>(ray);
    hit = {end, 0, 0, kMiss};
    const float o[3] = {ox, oy, oz}, d[3] = {dx, dy, dz};
    aim(o, d);
  }
  // Sets the origin, the direction and all that follows from them. The hit so far and the stack stay: a ray is aimed
  // anew on its way into an instance and back.
  WAVECREST_INLINE void aim(const float (&o)[3], const float (&d)[3]) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float size = std::abs(d[axis]);
      origin[axis] = o[axis];
      direction[axis] = d[axis];
      inverse[axis] = std::copysign(1 / (size > kLeastDirection ? size : kLeastDirection), d[axis]);
      nearPlane[axis] = nearPlanes(d[axis]);
    }
    axes = kAxesAlong[greatestAxis(d[0], d[1], d[2])];
    shear[2] = inverse[axes.axis[2]];
    for (size_t i = 0; i < 2; ++i) shear[i] = -d[axes.axis[i]] * shear[2];
  }

  // Puts the children that the ray meets before t on its stack: the nearest last, or in any order if any hit will do.
  WAVECREST_INLINE void visit(const BvhNode& node) {
    constexpr size_t kPlanes = 2 * kBvhWidth;
    FloatGroup<kBvhWidth> enter(0.0f), leave(hit.t);
    // Along each axis the plane of byte b is met at b * step + first. All children are tested at once, by both planes.
    const FourGroup inverses = repeatFour(inverse), steps = repeatFour(node.scale) * inverses;
    const FourGroup firsts = (repeatFour(node.corner) - repeatFour(origin)) * inverses;
    const auto clip = [&]<size_t kAxis>(std::integral_constant<size_t, kAxis>) HWY_ATTR {
      const FloatGroup<kPlanes> bytes = loadBytes<kPlanes>(node.bounds[kAxis][0] + nearPlane[kAxis]);
      const auto planes = mulAdd(bytes, spread<kPlanes, kAxis>(steps), spread<kPlanes, kAxis>(firsts));
      enter = max(firstHalf(planes), enter);
      leave = min(secondHalf(planes), leave);
    };
    clip(std::integral_constant<size_t, 0>());
    clip(std::integral_constant<size_t, 1>());
    clip(std::integral_constant<size_t, 2>());
    const auto children = loadGroup<kBvhWidth>(node.children);
    const auto met = (enter <= leave) & (children != kBvhEnd);
    uint32_t* const top = stack + waiting;
    waiting += static_cast<uint32_t>(kAnyHit ? appendWhere(met, children, top)
                                             : appendByFallingKey(met, enter, children, top));
  }
  // Tests all triangles of the leaf at once.
  WAVECREST_INLINE void visit(const FaceLeaf& faces) {
    using Group = FloatGroup<kLeafSize>;
    const auto corner = [&](size_t k) HWY_ATTR {
      const auto along = [&](size_t i) HWY_ATTR {
        return loadGroup<kLeafSize>(faces.corner[k][axes.axis[i]]) - Group(origin[axes.axis[i]]);
      };
      return Vec3<Group>{along(0), along(1), along(2)};
    };
    const Vec3<Group> turned{Group(direction[axes.axis[0]]), Group(direction[axes.axis[1]]),
                             Group(direction[axes.axis[2]])};
    MaskGroup<kLeafSize> met;
    const FaceHit<Group> found =
        intersectFaces(corner(0), corner(1), corner(2), turned, broadcast<kLeafSize>(shear), met);
    keep(met, found.t, found.second / found.sum, found.third / found.sum, faces.id);
  }
  WAVECREST_INLINE void visit(const SphereLeaf& spheres) {
    using Group = FloatGroup<kLeafSize>;
    const Group scale(powerUpTo(shear[2]));
    const Group distance =
        scale * intersectSpheres(loadPoints(spheres.center), loadGroup<kLeafSize>(spheres.radius),
                                 broadcast<kLeafSize>(origin), broadcast<kLeafSize>(direction) * scale);
    keep(distance > Group(0.0f), distance, distance, Group(0.0f), spheres.id);
  }

 private:
  // Takes the nearest of a leaf's hits if it is nearer than the one so far. Of equally near hits the one of the lowest
  // id is kept, so that the result does not depend on the order of visits. In a leaf that is the first slot's: they are
  // in the order of ids. Every third leaf or so has a nearer hit, and no processor foresees which: no branches, so the
  // walkers' steps overlap.
  WAVECREST_INLINE void keep(MaskGroup<kLeafSize> met, FloatGroup<kLeafSize> distance, FloatGroup<kLeafSize> second,
                             FloatGroup<kLeafSize> third, const uint32_t* ids) {
    using Group = FloatGroup<kLeafSize>;
    met = met & (distance > Group(0.0f)) & (distance <= Group(hit.t));
    if constexpr (kAnyHit) {
      // Any id says that the ray is blocked. Only the end is left on the stack.
      const uint32_t blocked = 0u - static_cast<uint32_t>(any(met));
      hit.id = (ids[0] & blocked) | (hit.id & ~blocked);
      waiting = (1u & blocked) | (waiting & ~blocked);
      return;
    }
    const Least nearest = leastOf(select(met, distance, Group(std::numeric_limits<float>::infinity())));
    HWY_ALIGN float seconds[kLeafSize], thirds[kLeafSize];
    store(second, seconds);
    store(third, thirds);
    const BvhHit found{nearest.value, seconds[nearest.index], thirds[nearest.index], ids[nearest.index]};
    const bool nearer = (found.t < hit.t) | ((found.t == hit.t) & (found.id < hit.id));
    BvhHit* const places[2] = {&notNearest, &hit};
    *places[static_cast<size_t>(nearer)] = found;
  }
};

// As many rays as there are lanes. Nodes are tested once for all of them, by the intervals that their origins and
// directions span; leaves ray by ray. visit finds the closest hits; shadow_packet.h has another for any hit.
struct BvhPacket {
  static constexpr size_t kUnderWay = 8;
  Vec3<Float> origin, direction, inverse;
  Float t, second, third;  // as of a single ray
  UInt id;
  float nearOrigin[3], farOrigin[3];  // least along the rays of what they enter by and leave by
  float inverses[2][3];               // ends of the interval of 1 / direction
  float slack[3];                     // infinite where rays go both ways, else 0
  uint32_t nearPlane[3];
  RayAxes axes;                      // of the first ray
  bool sameAxes;                     // they are those of all
  Mask alongX, alongY;               // rays whose last axis is x, or y
  Vec3<Float> start, turned, shear;  // origins and directions in the order of the axes, and laidAcross's
  float end;                         // greatest t
  uint32_t index, at, waiting;
  uint32_t stack[kBvhStack];

  // first: the index of the first ray; the others follow it.
  WAVECREST_INLINE void begin(size_t first, Vec3<Float> o, Vec3<Float> d) {
    index = static_cast<uint32_t>(first);
    end = kFarthest;
    t = Float(end);
    second = third = Float(0);
    id = UInt(kMiss);
    aim(o, d);
  }
  // As BvhRay::aim, for all rays of the packet.
  WAVECREST_INLINE void aim(Vec3<Float> o, Vec3<Float> d) {
    origin = o;
    direction = d;
    inverse = {bound(0, o.x, d.x), bound(1, o.y, d.y), bound(2, o.z, d.z)};
    const Float x = abs(d.x), y = abs(d.y), z = abs(d.z);
    alongX = (x >= y) & (x >= z);
    alongY = andNot(y >= z, alongX);
    sameAxes = (all(alongX) || none(alongX)) && (all(alongY) || none(alongY));
    axes = kAxesAlong[all(alongX) ? 0 : all(alongY) ? 1 : 2];
    start = inOrder(o);
    turned = inOrder(d);
    shear.z = inOrder(inverse).z;
    shear.x = -turned.x * shear.z;
    shear.y = -turned.y * shear.z;
  }

  WAVECREST_INLINE void visit(const BvhNode& node) {
    forEachChild<true>(node, [&](uint32_t child, Mask rays) HWY_ATTR {
      stack[waiting] = child;
      waiting += any(rays) ? 1 : 0;
    });
  }
  WAVECREST_INLINE void visit(const FaceLeaf& faces) {
    forEachFace(faces, [&](Mask met, const FaceHit<Float>& hit, UInt face)
                           HWY_ATTR { keep(met, hit.t, hit.second / hit.sum, hit.third / hit.sum, face); });
    end = greatestLane(t);
  }
  WAVECREST_INLINE void visit(const SphereLeaf& spheres) {
    forEachSphere(spheres, [&](Float distance, UInt sphere)
                               HWY_ATTR { keep(distance > Float(0), distance, distance, Float(0), sphere); });
    end = greatestLane(t);
  }

 protected:
  // Calls take(child, rays that meet it) for each child that the packet may meet; the nearest last, or in any order.
  template <bool kInOrder, class Take>
  WAVECREST_INLINE void forEachChild(const BvhNode& node, const Take& take) const {
    using Group = FloatGroup<kBvhWidth>;
    // The bytes of all planes as numbers: of each axis the low ones, then the high ones.
    HWY_ALIGN float planes[6 * kBvhWidth];
    for (size_t row = 0; row < 6; ++row) {
      store(loadBytes<kBvhWidth>(node.bounds[row / 2][row % 2]), planes + row * kBvhWidth);
    }
    // All children against the whole packet, in interval arithmetic: the least distance at which any ray enters, and
    // the greatest at which any ray leaves. Both ends of the interval of 1 / direction are tried. Along an axis where
    // rays go both ways the slack is infinite, so that axis excludes no child.
    Group enter(0.0f), leave(end);
    for (size_t axis = 0; axis < 3; ++axis) {
      const float scale = node.scale[axis], corner = node.corner[axis];
      const Group step0(scale * inverses[0][axis]), step1(scale * inverses[1][axis]);
      const float near = corner - nearOrigin[axis], far = corner - farOrigin[axis];
      const auto along = [&](Group steps, float from) HWY_ATTR {
        return std::pair{mulAdd(steps, step0, Group(from * inverses[0][axis])),
                         mulAdd(steps, step1, Group(from * inverses[1][axis]))};
      };
      const float* const low = planes + 2 * axis * kBvhWidth;
      const auto [enter0, enter1] = along(loadGroup<kBvhWidth>(low + nearPlane[axis]), near);
      const auto [leave0, leave1] = along(loadGroup<kBvhWidth>(low + kBvhWidth - nearPlane[axis]), far);
      enter = max(min(enter0, enter1) - Group(slack[axis]), enter);
      leave = min(max(leave0, leave1) + Group(slack[axis]), leave);
    }
    const auto met = (enter <= leave) & (loadGroup<kBvhWidth>(node.children) != kBvhEnd);
    // Then each child that was met against every ray by itself.
    uint32_t slots[kBvhWidth];
    const auto all = loadGroup<kBvhWidth>(kLaneNumbers);
    const size_t count = kInOrder ? appendByFallingKey(met, enter, all, slots) : appendWhere(met, all, slots);
    const Vec3<Float> scale{node.scale[0], node.scale[1], node.scale[2]};
    const Vec3<Float> corner{node.corner[0], node.corner[1], node.corner[2]};
    const Vec3<Float> step = scale * inverse, first = (corner - origin) * inverse;
    for (size_t i = 0; i < count; ++i) {
      take(node.children[slots[i]], raysThrough(planes + slots[i], step, first));
    }
  }
  // Calls take(the rays that meet it, hits, id) for each face that any ray meets ahead.
  template <class Take>
  WAVECREST_INLINE void forEachFace(const FaceLeaf& faces, const Take& take) const {
    forEachSlot(faces.id, [&](size_t slot, UInt face) HWY_ATTR {
      const auto corner = [&](size_t k) HWY_ATTR {
        const auto& c = faces.corner[k];
        Vec3<Float> p{c[axes.axis[0]][slot], c[axes.axis[1]][slot], c[axes.axis[2]][slot]};
        if (!sameAxes) p = inOrder({c[0][slot], c[1][slot], c[2][slot]});
        return p - start;
      };
      Mask met;
      const FaceHit<Float> hit = intersectFaces(corner(0), corner(1), corner(2), turned, shear, met);
      met = met & (hit.t > Float(0));
      if (any(met)) take(met, hit, face);
    });
  }
  // Calls take(distances, id) for each sphere; they are negative where a ray misses it.
  template <class Take>
  WAVECREST_INLINE void forEachSphere(const SphereLeaf& spheres, const Take& take) const {
    const Float scale = powerUpTo(shear.z);
    const Vec3<Float> along = direction * scale;
    forEachSlot(spheres.id, [&](size_t slot, UInt sphere) HWY_ATTR {
      const Vec3<Float> center{spheres.center[0][slot], spheres.center[1][slot], spheres.center[2][slot]};
      take(intersectSpheres(center, Float(spheres.radius[slot]), origin, along) * scale, sphere);
    });
  }

 private:
  // The parts of a in the order of each ray's axes.
  WAVECREST_INLINE Vec3<Float> inOrder(Vec3<Float> a) const {
    return {select(alongX, a.y, select(alongY, a.z, a.x)), select(alongX, a.z, select(alongY, a.x, a.y)),
            select(alongX, a.x, select(alongY, a.y, a.z))};
  }
  // Sets what the packet keeps of one axis: intervals, slack and the rows of near planes. Returns 1 / d, with
  // directions of zero as tiny ones.
  WAVECREST_INLINE Float bound(size_t axis, Float o, Float d) {
    const Float inverted = copySign(Float(1) / max(abs(d), Float(kLeastDirection)), d);
    const float least = leastLane(inverted), most = greatestLane(inverted);
    // All rays go backward if the greatest inverse is negative, all go forward if the least is positive.
    const bool backward = std::signbit(most), forward = !std::signbit(least);
    inverses[0][axis] = least;
    inverses[1][axis] = most;
    slack[axis] = backward || forward ? 0 : std::numeric_limits<float>::infinity();
    nearPlane[axis] = nearPlanes(most);
    // The reductions may drop lanes beside a NaN, so origins that are no numbers are left out.
    const Float far(std::numeric_limits<float>::infinity());
    const Mask known = abs(o) < far;
    const float low = leastLane(select(known, o, far)), high = greatestLane(select(known, o, -far));
    nearOrigin[axis] = backward ? low : high;
    farOrigin[axis] = backward ? high : low;
    return inverted;
  }
  // The rays that themselves meet a child. planes: as in forEachChild, from the child's own on. step, first: distances
  // along the rays are plane * step + first.
  WAVECREST_INLINE Mask raysThrough(const float* planes, Vec3<Float> step, Vec3<Float> first) const {
    Float enter(0), leave = t;
    const auto clip = [&](size_t axis, Float s, Float f) HWY_ATTR {
      const float* const low = planes + 2 * axis * kBvhWidth;
      const Float near = mulAdd(Float(low[nearPlane[axis]]), s, f);
      const Float far = mulAdd(Float(low[kBvhWidth - nearPlane[axis]]), s, f);
      const bool oneWay = slack[axis] == 0;
      enter = max(enter, oneWay ? near : min(near, far));
      leave = min(leave, oneWay ? far : max(near, far));
    };
    clip(0, step.x, first.x);
    clip(1, step.y, first.y);
    clip(2, step.z, first.z);
    return enter <= leave;
  }
  // Calls test(slot, id) for each primitive of a leaf, whose other slots repeat the last one.
  template <class Test>
  static WAVECREST_INLINE void forEachSlot(const uint32_t* ids, const Test& test) {
    for (size_t slot = 0; slot < kLeafSize && (slot == 0 || ids[slot] != ids[slot - 1]); ++slot) {
      test(slot, UInt(ids[slot]));
    }
  }
  // As BvhRay::keep: takes nearer hits, and of equally near ones that of the lowest id.
  WAVECREST_INLINE void keep(Mask met, Float distance, Float a, Float b, UInt face) {
    const Mask closer = met & ((distance < t) | ((distance == t) & (face < id)));
    t = select(closer, distance, t);
    second = select(closer, a, second);
    third = select(closer, b, third);
    id = select(closer, face, id);
  }
};

WAVECREST_SIMD_END
