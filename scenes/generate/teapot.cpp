#include "scenes/generate/teapot.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "scenes/generate/lathe.h"
#include "scenes/generate/tube.h"

namespace wavecrest::generate {
namespace {

using Point = std::array<double, 2>;  // (radius, height)

constexpr Point kOutline[] = {{0, 0},         {0.10, 0},      {0.128, 0.008}, {0.150, 0.03},  {0.168, 0.07},
                              {0.172, 0.105}, {0.162, 0.15},  {0.140, 0.19},  {0.122, 0.212}, {0.112, 0.222},
                              {0.100, 0.232}, {0.075, 0.245}, {0.045, 0.254}, {0.022, 0.260}, {0.014, 0.268},
                              {0.014, 0.276}, {0.024, 0.288}, {0.026, 0.300}, {0.018, 0.311}, {0, 0.315}};
constexpr size_t kBelowKnob = 13;  // the cavity ends where the lid meets its knob
constexpr double kWall = 0.006, kGap = 0.0004;
constexpr int kProfileSteps = 6;
constexpr uint32_t kSegments = 96, kTubeSegments = 32, kTubeSteps = 40;

constexpr Tube kHandle{{{{-0.140, 0.19}, {-0.30, 0.225}, {-0.32, 0.10}, {-0.165, 0.075}}}, 0.014, 0.014};
constexpr Tube kSpout{{{{0.155, 0.075}, {0.27, 0.08}, {0.22, 0.19}, {0.305, 0.215}}}, 0.040, 0.017};

// Distance of a point outside the body to its profile, a polyline in the half plane.
double distanceToBody(std::span<const ProfilePoint> profile, const Vec3& position) {
  const double r = std::hypot(position[0], position[2]), h = position[1];
  double nearest = std::numeric_limits<double>::max();
  bool outside = true;
  for (size_t i = 0; i + 1 < profile.size(); ++i) {
    const ProfilePoint &a = profile[i], &b = profile[i + 1];
    const double dr = b.radius - a.radius, dh = b.height - a.height;
    const double along = (r - a.radius) * dr + (h - a.height) * dh;
    const double f = std::clamp(along / (dr * dr + dh * dh), 0.0, 1.0);
    const double toR = r - a.radius - f * dr, toH = h - a.height - f * dh, distance = std::hypot(toR, toH);
    if (distance >= nearest) continue;
    nearest = distance;
    outside = toR * a.normalRadius + toH * a.normalHeight >= 0;
  }
  return outside ? nearest : -nearest;
}

// Sphere tracing from a vertex of the tube's last ring to kGap in front of the body.
Advance upToBody(std::span<const ProfilePoint> profile) {
  return [profile](const Vec3& position, const Vec3& outwards) {
    double moved = 0;
    for (int i = 0; i < 200; ++i) moved += 0.9 * (distanceToBody(profile, position + moved * outwards) - kGap);
    return moved;
  };
}

// The first curve parameter, walking from `t` in steps of `step`, at which the whole cross-section is clear of the
// body.
double clearOfBody(const Tube& tube, std::span<const ProfilePoint> profile, double t, double step) {
  const auto clear = [&](double at) {
    const Vec3 center = tubeCenter(tube, at), side = cross(Vec3{0, 0, 1}, tubeDirection(tube, at));
    const double radius = tubeRadius(tube, at);
    for (const Vec3& offset : {Vec3{0, 0, 0}, side, -1.0 * side, Vec3{0, 0, 1}})
      if (distanceToBody(profile, center + radius * offset) < 4 * kGap) return false;
    return true;
  };
  while (!clear(t)) t += step;
  return t;
}

// The inner surface of the wall: the outline below the knob moved inwards, walked downwards so that it faces the
// cavity.
std::vector<ProfilePoint> cavity(std::span<const ProfilePoint> outer) {
  std::vector<ProfilePoint> inner;
  for (size_t i = 0; i < kBelowKnob * kProfileSteps; ++i) {
    const ProfilePoint& p = outer[i];
    inner.push_back({std::max(p.radius - kWall * p.normalRadius, 0.0), p.height - kWall * p.normalHeight,
                     -p.normalRadius, -p.normalHeight});
  }
  // Under the knob the outline turns upwards; the cavity closes with a flat roof where its radius is still wide.
  while (inner.back().normalHeight > -0.97) inner.pop_back();
  inner.push_back({0, inner.back().height + 0.001, 0, -1});
  std::reverse(inner.begin(), inner.end());
  return inner;
}

// The smooth outline dips a little below its first points; this puts its lowest point on y = 0.
Mesh standing(Mesh mesh) {
  double lowest = 0;
  for (const Vec3& position : mesh.positions) lowest = std::min(lowest, position[1]);
  for (Vec3& position : mesh.positions) position[1] -= lowest;
  return mesh;
}

}  // namespace

Mesh makeOpaqueTeapot() {
  Mesh mesh;
  appendLathe(mesh, smoothProfile(kOutline, kProfileSteps), kSegments);
  appendTube(mesh, kHandle, kTubeSteps, kTubeSegments);
  appendTube(mesh, kSpout, kTubeSteps, kTubeSegments);
  return standing(std::move(mesh));
}

Mesh makeGlassTeapot() {
  const std::vector<ProfilePoint> outer = smoothProfile(kOutline, kProfileSteps);
  Mesh mesh;
  appendLathe(mesh, outer, kSegments);
  appendLathe(mesh, cavity(outer), kSegments);

  constexpr double kStep = 1.0 / 512;
  const Advance upTo = upToBody(outer);
  Tube handle = kHandle, spout = kSpout;
  handle.from = clearOfBody(handle, outer, 0, kStep);
  handle.to = clearOfBody(handle, outer, 1, -kStep);
  spout.from = clearOfBody(spout, outer, 0, kStep);
  appendTube(mesh, handle, kTubeSteps, kTubeSegments, upTo, upTo);
  appendTube(mesh, spout, kTubeSteps, kTubeSegments, upTo);
  return standing(std::move(mesh));
}

}  // namespace wavecrest::generate
