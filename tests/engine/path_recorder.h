// Records the whole paths of a walk and each contribution with the path that it belongs to.
//
// A ray starts a little off the vertex that it leaves, so that it does not meet it again. An edge is as long as the ray
// that walked it; edges of connections run between the vertices themselves.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "kernels/extend/offset.h"
#include "tests/engine/bidirectional_walk.h"
#include "tests/engine/path_density.h"
#include "tests/kernels/stage_waves.h"

namespace wavecrest {

struct Contribution {
  size_t strategy = 0;  // s, or for merges the index of the merged vertex
  bool merge = false;
  FullPath path;
  double value = 0;  // the sum of its channels
};

template <class S>
class PathRecorder : public WalkVisitor<S> {
 public:
  explicit PathRecorder(BidirectionalWalk<S>& walk) : walk_(walk) {}

  std::vector<Contribution> contributions;

  void generated(Walk kind, const Wave<S>& wave) override {
    auto& paths = pathsOf(kind);
    paths.assign(wave.pathCount, {});
    for (size_t i = 0; i < wave.rays.size; ++i) {
      Vertex origin{.position = at(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i),
                    .direction = at(wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i)};
      if (kind == Walk::light) {
        origin.light = wave.paths.light[i];
        origin.normal = lightNormal(origin.light, origin.position);
      }
      paths[wave.paths.lane[i]] = {origin};
    }
  }

  void leaving(Walk kind, uint32_t depth, const Wave<S>& wave) override {
    for (size_t i = 0; i < wave.rays.size; ++i) {
      Vertex& vertex = pathsOf(kind)[wave.paths.lane[i]][depth - 1];
      vertex.direction = at(wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i);
      vertex.departure = at(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i);
    }
  }

  void arrived(Walk kind, uint32_t depth, const Wave<S>& wave) override {
    for (size_t i = 0; i < wave.rays.size; ++i) {
      auto& path = pathsOf(kind)[wave.paths.lane[i]];
      if (path.size() == depth) path.push_back(vertexOf(wave, i));
    }
  }

  void scattered(Walk kind, uint32_t depth, const Wave<S>& wave) override {
    for (size_t i = 0; i < wave.rays.size; ++i) {
      pathsOf(kind)[wave.paths.lane[i]][depth].specular = wave.paths.dVCM[i] == 0;
    }
  }

  void splats(uint32_t depth, Wave<S>& wave) override {
    // Shadow rays name pixels; their order is that of the vertices, from which they start.
    size_t vertex = 0;
    for (size_t i = 0; i < wave.shadowRays.size; ++i) {
      const Double3 origin = shadowOrigin(wave, i);
      while (length(at(wave.rays.originX, wave.rays.originY, wave.rays.originZ, vertex) - origin) > 1e-4) ++vertex;
      const uint32_t lane = wave.paths.lane[vertex++];
      FullPath path = lightSide(lane, depth);
      const Vertex& last = light_[lane][depth];
      const Double3 lens = origin + shadowSegment(wave, i);
      append(path, {.position = lens}, lens, normalized(lens - last.position));
      push(depth + 1, false, path, shadowValue(wave, i));
    }
  }

  void emission(uint32_t depth, Wave<S>& wave) override {
    std::vector<std::optional<size_t>> hitOf(wave.pathCount);
    for (size_t i = 0; i < wave.rays.size; ++i) hitOf[wave.paths.lane[i]] = i;
    if (wave.rays.size == 0) return;  // the longest paths end here: their vertices are gone
    for (uint32_t lane = 0; lane < wave.pathCount; ++lane) {
      const double value = radianceOf(wave, lane);
      if (value == 0) continue;
      auto& camera = pathsOf(Walk::camera)[lane];
      FullPath path;
      if (hitOf[lane]) {
        camera.push_back(vertexOf(wave, *hitOf[lane]));
        const uint32_t primitive = wave.hits.primitive[*hitOf[lane]];
        path = startOn(walk_.scene().primitives[primitive].light, camera.back().position);
      } else {
        path = startAtInfinity(walk_.scene().infiniteLight, camera[depth - 1].direction);
      }
      appendWalkedCameraSide(path, lane, depth - 1);
      push(0, false, path, value);
    }
  }

  void nextEvent(uint32_t depth, Wave<S>& wave) override {
    for (size_t i = 0; i < wave.shadowRays.size; ++i) {
      const uint32_t lane = wave.shadowRays.target[i];
      const Double3 segment = shadowSegment(wave, i), end = shadowOrigin(wave, i) + segment;
      FullPath path = length(segment) > 2.5 * walk_.scene().radius
                          ? startAtInfinity(onlyInfiniteLight(), normalized(segment))
                          : startOn(lightAt(end), withoutOffset(end, length(segment)));
      appendCameraSide(path, lane, depth);
      push(1, false, path, shadowValue(wave, i));
    }
  }

  void connection(uint32_t lightDepth, uint32_t depth, Wave<S>& wave) override {
    for (size_t i = 0; i < wave.shadowRays.size; ++i) {
      const uint32_t lane = wave.shadowRays.target[i];
      FullPath path = lightSide(lane, lightDepth);
      appendCameraSide(path, lane, depth);
      push(lightDepth + 1, false, path, shadowValue(wave, i));
    }
  }

  // Photons one by one, so that each pair's contribution is seen; a few of each depth are enough.
  void merging(uint32_t depth, Wave<S>& wave, StageContext<S>& context) override {
    for (uint32_t lightDepth = 1; lightDepth <= std::min(walk_.light().depths(), 3u); ++lightDepth) {
      const LightStore<S>& light = walk_.light();
      for (size_t i = light.firstOf(lightDepth); i < light.firstOf(lightDepth + 1); i += 7) {
        const uint32_t lane = light.vertices.lane[i];
        takeSinglePhoton(static_cast<uint32_t>(i));
        context.light.photons = &photon_;
        walk_.stages().merge(context, wave);
        recordMerges(lightDepth, depth, lane, wave);
      }
    }
  }

 private:
  struct Vertex {
    Double3 position{}, normal{}, shading{};
    Double3 departure{}, direction{};  // of the ray that leaves it
    uint32_t material = kNoIndex, light = kNoIndex;
    bool specular = false;
  };

  std::vector<std::vector<Vertex>>& pathsOf(Walk kind) { return kind == Walk::light ? light_ : camera_; }

  static Double3 at(const S* x, const S* y, const S* z, size_t i) { return {x[i], y[i], z[i]}; }
  static Double3 at(const Column<float>& x, const Column<float>& y, const Column<float>& z,
                    size_t i) requires(!std::is_same_v<S, float>) {
    return {x[i], y[i], z[i]};
  }

  Vertex vertexOf(const Wave<S>& wave, size_t i) const {
    const auto& surfaces = wave.surfaces;
    const Double3 normal = at(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i);
    const Double3 shading = at(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, i);
    return {.position = at(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i),
            .normal = normal,
            // Kernels for scenes without shading normals do not write that column.
            .shading = length(shading) > 0.5 ? shading : normal,
            .departure = {},
            .direction = {},
            .material = walk_.scene().primitives[wave.hits.primitive[i]].material};
  }
  static Double3 shadowOrigin(const Wave<S>& wave, size_t i) {
    return at(wave.shadowRays.originX, wave.shadowRays.originY, wave.shadowRays.originZ, i);
  }
  static Double3 shadowSegment(const Wave<S>& wave, size_t i) {
    return at(wave.shadowRays.directionX, wave.shadowRays.directionY, wave.shadowRays.directionZ, i);
  }
  static double shadowValue(const Wave<S>& wave, size_t i) {
    return double{wave.shadowRays.red[i]} + wave.shadowRays.green[i] + wave.shadowRays.blue[i];
  }
  static double radianceOf(const Wave<S>& wave, size_t lane) {
    return double{wave.radiance.red[lane]} + wave.radiance.green[lane] + wave.radiance.blue[lane];
  }

  // ---- lights ----

  Double3 lightNormal(uint32_t index, const Double3& point) const {
    const auto& light = walk_.scene().lights[index];
    if (static_cast<LightKind>(light.kind) == LightKind::sphere) {
      return normalized(point - Double3{light.p0[0], light.p0[1], light.p0[2]}) * double{light.e1[1]};
    }
    return {light.normal[0], light.normal[1], light.normal[2]};
  }
  // The light on which a point lies: the one whose surface is nearest.
  uint32_t lightAt(const Double3& point) const {
    uint32_t best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (uint32_t i = 0; i < walk_.scene().lightCount; ++i) {
      const auto& light = walk_.scene().lights[i];
      const Double3 p0{light.p0[0], light.p0[1], light.p0[2]}, e1{light.e1[0], light.e1[1], light.e1[2]},
          e2{light.e2[0], light.e2[1], light.e2[2]}, normal{light.normal[0], light.normal[1], light.normal[2]};
      double distance = length(point - p0);
      if (static_cast<LightKind>(light.kind) == LightKind::sphere) distance = std::abs(distance - light.radius);
      if (static_cast<LightKind>(light.kind) == LightKind::triangle) {
        const Double3 across = cross(e1, e2), to = point - p0;
        const double u = dot(cross(to, e2), across) / dot(across, across),
                     v = dot(cross(e1, to), across) / dot(across, across);
        distance = std::abs(dot(to, normal)) + std::max({0.0, -u, -v, u + v - 1});
      }
      if (distance < nearest) {
        nearest = distance;
        best = i;
      }
    }
    return best;
  }
  // Shadow rays of this length end a little off an area light.
  Double3 withoutOffset(const Double3& end, double distance) const {
    const uint32_t index = lightAt(end);
    const auto& light = walk_.scene().lights[index];
    const bool hasArea = light.kind <= static_cast<uint32_t>(LightKind::sphere);
    return end - lightNormal(index, end) * (hasArea ? double{light.offset} + kEndGamma * distance : 0);
  }
  uint32_t onlyInfiniteLight() const {
    for (uint32_t i = 0; i < walk_.scene().lightCount; ++i) {
      const auto kind = static_cast<LightKind>(walk_.scene().lights[i].kind);
      if (kind == LightKind::directional || kind == LightKind::constant || kind == LightKind::envmap) return i;
    }
    return 0;
  }

  // ---- whole paths ----

  FullPath startOn(uint32_t light, const Double3& point) const {
    PathVertex x0{.position = point, .positionToCamera = point};
    x0.normal = x0.normalToCamera = lightNormal(light, point);
    return {{x0}, light};
  }
  // towards: the light, seen from the scene.
  FullPath startAtInfinity(uint32_t light, const Double3& towards) const {
    return {{PathVertex{.toCamera = towards * -1.0}}, light};
  }

  FullPath lightSide(uint32_t lane, uint32_t depth) {
    const auto& vertices = light_[lane];
    const uint32_t light = vertices[0].light;
    const auto kind = static_cast<LightKind>(walk_.scene().lights[light].kind);
    const bool infinite = kind == LightKind::directional || kind == LightKind::constant || kind == LightKind::envmap;
    FullPath path =
        infinite ? startAtInfinity(light, vertices[0].direction * -1.0) : startOn(light, vertices[0].position);
    for (uint32_t i = 1; i <= depth; ++i) {
      const Vertex& before = vertices[i - 1];
      if (i > 1) path.x.back().positionToCamera = before.departure;
      append(path, vertices[i], vertices[i].position, before.direction);
    }
    path.x[depth].specular = false;
    return path;
  }

  // Joined with the vertex at `depth`.
  void appendCameraSide(FullPath& path, uint32_t lane, uint32_t depth) {
    const Vertex& z = camera_[lane][depth];
    const PathVertex& before = path.x.back();
    const bool fromInfinity = path.x.size() == 1 && length(before.toCamera) > 0;
    append(path, z, z.position, fromInfinity ? before.toCamera : normalized(z.position - before.positionToCamera));
    appendWalkedCameraSide(path, lane, depth - 1);
  }
  // Walked from the vertex at `depth` to the one that the path has now.
  void appendWalkedCameraSide(FullPath& path, uint32_t lane, uint32_t depth) {
    for (uint32_t i = depth; i >= 1; --i) {
      const Vertex& z = camera_[lane][i];
      append(path, z, z.departure, z.direction * -1.0);
    }
    const Vertex& lens = camera_[lane][0];
    append(path, lens, lens.position, lens.direction * -1.0);
  }

  // position: where the edge to the vertex before ends; direction: of that edge, towards the camera.
  void append(FullPath& path, const Vertex& v, const Double3& position, const Double3& direction) const {
    path.x.back().toCamera = direction;
    path.x.push_back({.position = position,
                      .positionToCamera = v.position,
                      .normal = v.normal,
                      .normalToCamera = v.normal,
                      .shading = v.shading,
                      .toLight = direction * -1.0,
                      .material = v.material,
                      .specular = v.specular});
  }

  void push(size_t strategy, bool merge, const FullPath& path, double value) {
    contributions.push_back({strategy, merge, path, value});
  }

  // ---- merging ----

  void takeSinglePhoton(uint32_t index) {
    photonStore_.clear();
    photonStore_.beginDepth(1);
    LightVertices<S> from = walk_.light().vertices;
    forEachColumn(from, photonStore_.vertices, [&](size_t, auto& source, auto& target) { target[0] = source[index]; });
    photonStore_.vertices.claim(1);
    LightStore<S>* const stores[1] = {&photonStore_};
    photon_.build(stores, walk_.photonGrid(), forEach);
  }

  void recordMerges(uint32_t lightDepth, uint32_t depth, uint32_t lightLane, Wave<S>& wave) {
    for (uint32_t lane = 0; lane < wave.pathCount; ++lane) {
      const double value = radianceOf(wave, lane);
      wave.radiance.red[lane] = wave.radiance.green[lane] = wave.radiance.blue[lane] = 0;
      if (value == 0) continue;
      FullPath path = lightSide(lightLane, lightDepth);
      const Vertex& z = camera_[lane][depth];
      PathVertex& joint = path.x.back();
      joint.positionToCamera = z.position;
      joint.normalToCamera = z.normal;
      joint.shading = z.shading;
      joint.material = z.material;
      appendWalkedCameraSide(path, lane, depth - 1);
      push(lightDepth, true, path, value);
    }
  }

  BidirectionalWalk<S>& walk_;
  LightStore<S> photonStore_{1, BidirectionalWalk<S>::kNeeds};
  PhotonMap<S> photon_;
  std::vector<std::vector<Vertex>> light_, camera_;  // by lane and depth
};

}  // namespace wavecrest
