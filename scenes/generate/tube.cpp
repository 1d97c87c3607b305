#include "scenes/generate/tube.h"

#include <algorithm>
#include <numbers>

namespace wavecrest::generate {
namespace {

// The ring of vertices around the curve at t, moved along the curve by `advance`, at the given fraction of the radius.
std::vector<Vec3> ringAt(const Tube& tube, double t, double fraction, uint32_t segments, const Vec3& outwards,
                         const Advance& advance) {
  const Vec3 center = tubeCenter(tube, t), direction = tubeDirection(tube, t);
  const Vec3 side = cross(direction, Vec3{0, 0, 1});
  std::vector<Vec3> ring;
  for (uint32_t i = 0; i < segments; ++i) {
    // Decreasing angle, as in a lathe, for outward quads when the walk goes towards the end.
    const double angle = -2 * std::numbers::pi * i / segments;
    Vec3 position =
        center + fraction * tubeRadius(tube, t) * (std::cos(angle) * side + std::sin(angle) * Vec3{0, 0, 1});
    if (advance) position = position + advance(position, outwards) * outwards;
    ring.push_back(position);
  }
  return ring;
}

// A cap: concentric rings and a middle vertex. Its normals are those of its own facets, averaged, so that it may be
// bent.
void appendCap(Mesh& mesh, const Tube& tube, double t, bool atStart, uint32_t segments, const Advance& advance) {
  const Vec3 outwards = (atStart ? -1.0 : 1.0) * tubeDirection(tube, t);
  const uint32_t rings = advance ? 8 : 1;  // a flat cap needs no inner vertices
  const size_t firstVertex = mesh.positions.size(), firstTriangle = mesh.triangles.size();
  uint32_t previous = 0;
  for (uint32_t r = 0; r < rings; ++r) {
    const auto ring = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3& p : ringAt(tube, t, 1 - static_cast<double>(r) / rings, segments, outwards, advance))
      mesh.addVertex(p, Vec3{0, 0, 0});
    if (r > 0) atStart ? bridgeRings(mesh, ring, previous, segments) : bridgeRings(mesh, previous, ring, segments);
    previous = ring;
  }
  Vec3 middle = tubeCenter(tube, t);
  if (advance) middle = middle + advance(middle, outwards) * outwards;
  const uint32_t apex = mesh.addVertex(middle, Vec3{0, 0, 0});
  for (uint32_t k = 0; k < segments; ++k) {
    const uint32_t a = previous + k, b = previous + (k + 1) % segments;
    atStart ? mesh.addTriangle(apex, b, a) : mesh.addTriangle(a, b, apex);
  }
  for (size_t i = firstTriangle; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3 weighted = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (uint32_t index : {a, b, c}) mesh.normals[index] = mesh.normals[index] + weighted;
  }
  for (size_t i = firstVertex; i < mesh.normals.size(); ++i) mesh.normals[i] = normalize(mesh.normals[i]);
}

}  // namespace

Vec3 tubeCenter(const Tube& tube, double t) {
  const double s = 1 - t, w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  Vec3 center{0, 0, 0};
  for (size_t i = 0; i < 4; ++i) center = center + w[i] * Vec3{tube.controls[i][0], tube.controls[i][1], 0};
  return center;
}

Vec3 tubeDirection(const Tube& tube, double t) {
  const double s = 1 - t, w[3] = {s * s, 2 * s * t, t * t};
  Vec3 tangent{0, 0, 0};
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = tube.controls[i], &b = tube.controls[i + 1];
    tangent = tangent + w[i] * Vec3{b[0] - a[0], b[1] - a[1], 0};
  }
  return normalize(tangent);
}

double tubeRadius(const Tube& tube, double t) { return std::lerp(tube.startRadius, tube.endRadius, t); }

void appendTube(Mesh& mesh, const Tube& tube, uint32_t steps, uint32_t segments, const Advance& startCap,
                const Advance& endCap) {
  // Side rings; where a cap is bent, one more ring carries the side on to the cap's rim.
  struct Station {
    double t;
    Vec3 outwards;
    const Advance* advance;
  };
  std::vector<Station> stations;
  const Advance none;
  if (startCap) stations.push_back({tube.from, -1.0 * tubeDirection(tube, tube.from), &startCap});
  for (uint32_t i = 0; i <= steps; ++i)
    stations.push_back({std::lerp(tube.from, tube.to, static_cast<double>(i) / steps), Vec3{0, 0, 0}, &none});
  if (endCap) stations.push_back({tube.to, tubeDirection(tube, tube.to), &endCap});

  uint32_t previous = 0;
  for (size_t k = 0; k < stations.size(); ++k) {
    const auto& [t, outwards, advance] = stations[k];
    const auto ring = static_cast<uint32_t>(mesh.positions.size());
    const Vec3 center = tubeCenter(tube, t), direction = tubeDirection(tube, t);
    for (const Vec3& p : ringAt(tube, t, 1, segments, outwards, *advance)) {
      const Vec3 radial = p - center - dot(p - center, direction) * direction;
      mesh.addVertex(p, normalize(radial));  // the taper tilts the true normal by less than 6 degrees
    }
    if (k > 0) bridgeRings(mesh, previous, ring, segments);
    previous = ring;
  }
  appendCap(mesh, tube, tube.from, true, segments, startCap);
  appendCap(mesh, tube, tube.to, false, segments, endCap);
}

}  // namespace wavecrest::generate
