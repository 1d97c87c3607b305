// Packets of rays for Embree 3 or 4, whichever headers are installed: types and calls by width, and how columns fill
// them.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define WAVECREST_EMBREE 4
#else
#include <embree3/rtcore.h>
#define WAVECREST_EMBREE 3
#endif

#include <cstddef>
#include <type_traits>

namespace wavecrest {

// Embree's packet types and entry points by width.
template <size_t kWidth>
struct Packet;
#define WAVECREST_PACKET(WIDTH)                            \
  template <>                                              \
  struct Packet<WIDTH> {                                   \
    using Ray = RTCRay##WIDTH;                             \
    using RayHit = RTCRayHit##WIDTH;                       \
    static constexpr auto intersect = rtcIntersect##WIDTH; \
    static constexpr auto occluded = rtcOccluded##WIDTH;   \
  };
WAVECREST_PACKET(4)
WAVECREST_PACKET(8)
WAVECREST_PACKET(16)
#undef WAVECREST_PACKET

// Embree 3 takes a context before the rays, Embree 4 optional arguments behind them. coherent: the rays of a packet
// stay together, so that the hierarchy is walked once for all; rays that do not are slowed down by it.
class Query {
 public:
#if WAVECREST_EMBREE == 3
  explicit Query(bool coherent = false) {
    rtcInitIntersectContext(&context_);
    if (coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  template <class Function, class Rays>
  void operator()(Function function, const int* valid, RTCScene scene, Rays& rays) {
    function(valid, scene, &context_, &rays);
  }

 private:
  RTCIntersectContext context_;
#else
  explicit Query(bool coherent = false)
      : flags_(coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) {}
  // Arguments: RTCIntersectArguments or RTCOccludedArguments, as the function takes.
  template <class Rays, class Arguments>
  void operator()(void (*function)(const int*, RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene,
                  Rays& rays) {
    Arguments arguments{};
    arguments.flags = flags_;
    arguments.feature_mask = RTC_FEATURE_FLAG_ALL;
    function(valid, scene, &rays, &arguments);
  }

 private:
  RTCRayQueryFlags flags_;
#endif
};

// The columns are blocks of a packet's length already; only the storage type may differ. S is that of the directions
// and origins; Record is Rays or ShadowRays.
template <class S, class Record, class Ray>
void copyRays(const Record& rays, size_t first, Ray& out) {
  const auto copy = [&](const S* column, auto& values) {
    constexpr size_t kWidth = std::extent_v<std::remove_reference_t<decltype(values)>>;
    for (size_t i = 0; i < kWidth; ++i) values[i] = static_cast<float>(column[first + i]);
    // Lanes beyond the last ray: Embree looks at them too where it splits a packet, and stops at a NaN.
    for (size_t i = rays.size - first; i < kWidth; ++i) values[i] = values[0];
  };
  copy(rays.originX, out.org_x);
  copy(rays.originY, out.org_y);
  copy(rays.originZ, out.org_z);
  copy(rays.directionX, out.dir_x);
  copy(rays.directionY, out.dir_y);
  copy(rays.directionZ, out.dir_z);
}

template <size_t kWidth>
void setValid(size_t remaining, int (&valid)[kWidth]) {
  for (size_t i = 0; i < kWidth; ++i) valid[i] = i < remaining ? -1 : 0;
}

template <class Ray>
void setSegment(float tfar, Ray& ray) {
  constexpr size_t kWidth = std::extent_v<decltype(ray.tnear)>;
  for (size_t i = 0; i < kWidth; ++i) {
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.tfar[i] = tfar;
    ray.mask[i] = ~0u;
    ray.id[i] = static_cast<unsigned>(i);
    ray.flags[i] = 0;
  }
}

// Clears what the last query left: no hit yet.
template <class RayHit>
void setNoHit(RayHit& packet) {
  for (unsigned& id : packet.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
  for (unsigned& id : packet.hit.instID[0]) id = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace wavecrest
