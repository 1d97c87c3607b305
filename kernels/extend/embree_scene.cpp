#include "kernels/extend/embree_scene.h"

#include "kernels/extend/offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "kernels/extend/embree_packets.h"
#include "kernels/extend/prefetch_hits.h"

namespace wavecrest {
namespace {

// Ids of the geometries, which are also indices into SceneView::firstPrimitive.
constexpr unsigned kQuads = 0, kTriangles = 1, kSpheres = 2;

// Adds all quads, or all triangles, as one geometry. Every face has vertices of its own, in buffers that Embree owns.
template <class S>
void addFaces(RTCDevice device, RTCScene scene, const PrimitiveRecord<S>* records, uint32_t count, bool quads,
              unsigned id) {
  if (count == 0) return;
  const unsigned corners = quads ? 4 : 3;
  RTCGeometry geometry = rtcNewGeometry(device, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), size_t{count} * corners));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                 quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
                                                                 corners * sizeof(unsigned), count));
  for (uint32_t i = 0; i < count; ++i) {
    const auto& r = records[i];
    for (unsigned k = 0; k < corners; ++k) {
      // (u, v) of the corners in order: (0,0), (1,0), then (0,1) for a triangle, (1,1) and (0,1) for a quad.
      const S u = (k == 1 || (quads && k == 2)) ? S(1) : S(0), v = k >= 2 ? S(1) : S(0);
      for (unsigned axis = 0; axis < 3; ++axis) {
        *vertices++ = static_cast<float>(r.p0[axis] + u * r.e1[axis] + v * r.e2[axis]);
      }
      *indices++ = i * corners + k;
    }
  }
  // The scene keeps the geometry. The reference held here is given up.
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

// Adds all spheres as one geometry of points with radii.
template <class S>
void addSpheres(RTCDevice device, RTCScene scene, const PrimitiveRecord<S>* records, uint32_t count) {
  if (count == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* points = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
  for (uint32_t i = 0; i < count; ++i) {
    for (unsigned axis = 0; axis < 3; ++axis) *points++ = static_cast<float>(records[i].p0[axis]);
    *points++ = static_cast<float>(records[i].e1[0]);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, kSpheres);
  rtcReleaseGeometry(geometry);
}

}  // namespace

template <class S>
EmbreeScene::EmbreeScene(const PrimitiveRecord<S>* records, uint32_t quads, uint32_t triangles, uint32_t spheres,
                         bool watertight) {
  // Large pages, where the system gives them, save a part of the misses of incoherent rays.
  RTCDevice device = rtcNewDevice("hugepages=1");
  if (device == nullptr) {
    throw std::runtime_error("Embree: no device (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  }
  // Embree reports what it allocates, and with a minus sign what it frees. True lets it go on.
  const auto countBytes = [](void* counter, ssize_t bytes, bool) {
    static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes);
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device, countBytes, &bytes_);
  // Fill the scene and build its hierarchy.
  RTCScene scene = rtcNewScene(device);
  if (watertight) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  addFaces(device, scene, records, quads, true, kQuads);
  addFaces(device, scene, records + quads, triangles, false, kTriangles);
  addSpheres(device, scene, records + quads + triangles, spheres);
  rtcCommitScene(scene);
  // Any of the calls above may have failed: the device keeps the first error.
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    throw std::runtime_error("Embree: the hierarchy could not be built (error " + std::to_string(error) + ")");
  }
  device_ = device;
  scene_ = scene;
}
template EmbreeScene::EmbreeScene(const PrimitiveRecord<float>*, uint32_t, uint32_t, uint32_t, bool);
template EmbreeScene::EmbreeScene(const PrimitiveRecord<double>*, uint32_t, uint32_t, uint32_t, bool);

// Releases the scene before the device that it belongs to.
EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(static_cast<RTCScene>(scene_));
  rtcReleaseDevice(static_cast<RTCDevice>(device_));
}

template <class S, size_t kWidth>
void extendEmbree(const StageContext<S>& context, Wave<S>& wave) {
  auto* const scene = static_cast<RTCScene>(context.scene->embree);
  const uint32_t* firstPrimitive = context.scene->firstPrimitive;
  const auto& rays = wave.rays;
  const size_t count = rays.size;
  context.counters->raysClosest += count;
  wave.hits.size = 0;
  wave.hits.claim(count);

  // Rays from the eye are coherent.
  Query query(context.walk == Walk::camera && context.depth == 1);
  alignas(64) int valid[kWidth];
  typename Packet<kWidth>::RayHit packet{};  // Embree leaves the coordinates of misses as they are
  for (size_t i = 0; i < count; i += kWidth) {
    // Trace one packet.
    setValid(count - i, valid);
    setSegment(std::numeric_limits<float>::infinity(), packet.ray);
    copyRays<S>(rays, i, packet.ray);
    setNoHit(packet);
    query(Packet<kWidth>::intersect, valid, scene, packet);
    // Make hits of what it met, as extend_small.cpp does: coordinates are kept off the edges, and a sphere has the
    // distance for u.
    for (size_t k = 0; k < kWidth; ++k) {
      const unsigned geometry = packet.hit.geomID[k];
      const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
      wave.hits.primitive[i + k] = hit ? firstPrimitive[geometry] + packet.hit.primID[k] : kMiss;
      if (geometry == kSpheres) {
        wave.hits.u[i + k] = packet.ray.tfar[k];
        wave.hits.v[i + k] = 0;
        continue;
      }
      float u = packet.hit.u[k], v = packet.hit.v[k];
      moveInsideEdges(u, v, geometry == kTriangles);
      wave.hits.u[i + k] = u;
      wave.hits.v[i + k] = v;
    }
    // Prefetch the records of these primitives, and for what the records of the packet before lead to.
    for (size_t k = 0; k < kWidth; ++k) {
      if (wave.hits.primitive[i + k] != kMiss) prefetchPrimitive(*context.scene, wave.hits.primitive[i + k]);
    }
    if (i != 0) prefetchAttributes(*context.scene, wave.hits.primitive + (i - kWidth), kWidth);
  }
}

template <class S, size_t kWidth>
void occludeEmbree(const StageContext<S>& context, Wave<S>& wave) {
  auto* const scene = static_cast<RTCScene>(context.scene->embree);
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;

  Query query;
  alignas(64) int valid[kWidth];
  typename Packet<kWidth>::Ray packet;
  for (size_t i = 0; i < count; i += kWidth) {
    setValid(count - i, valid);
    // Just short of 1: nothing at the segment's end may block it.
    setSegment(std::nextafter(1.0f, 0.0f), packet);
    copyRays<float>(shadow, i, packet);
    query(Packet<kWidth>::occluded, valid, scene, packet);
    // Add what is not blocked, in the order of the rays: to lanes, or on light walks to the splats.
    for (size_t k = 0; k < std::min(kWidth, count - i); ++k) {
      if (packet.tfar[k] < 0) continue;  // -infinity: blocked
      if (context.contributesToLanes()) {
        const uint32_t target = shadow.target[i + k];
        wave.radiance.red[target] += shadow.red[i + k];
        wave.radiance.green[target] += shadow.green[i + k];
        wave.radiance.blue[target] += shadow.blue[i + k];
      } else {
        const size_t out = wave.splats.claim(1);
        wave.splats.red[out] = shadow.red[i + k];
        wave.splats.green[out] = shadow.green[i + k];
        wave.splats.blue[out] = shadow.blue[i + k];
        wave.splats.pixel[out] = shadow.target[i + k];
      }
    }
  }
  shadow.size = 0;
}

#define WAVECREST_INSTANTIATE_EMBREE(S, WIDTH)                            \
  template void extendEmbree<S, WIDTH>(const StageContext<S>&, Wave<S>&); \
  template void occludeEmbree<S, WIDTH>(const StageContext<S>&, Wave<S>&);
WAVECREST_INSTANTIATE_EMBREE(float, 4)
WAVECREST_INSTANTIATE_EMBREE(float, 8)
WAVECREST_INSTANTIATE_EMBREE(float, 16)
WAVECREST_INSTANTIATE_EMBREE(double, 4)
WAVECREST_INSTANTIATE_EMBREE(double, 8)
WAVECREST_INSTANTIATE_EMBREE(double, 16)
#undef WAVECREST_INSTANTIATE_EMBREE

}  // namespace wavecrest
