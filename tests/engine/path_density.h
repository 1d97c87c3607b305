// The density of every strategy for one whole path, computed directly: products of the densities with which vertices
// are sampled, in scalar double code (METHODS 1.3, 2.2, 4.1, 5.1). No recursion, no partial sums: what cached MIS
// weights are compared with.
#pragma once

#include <vector>

#include "kernels/stages.h"
#include "tests/engine/reference_bsdf.h"

namespace wavecrest {

// x_i of a path x_0 (light) .. x_k (lens). Where a photon and a camera vertex are merged into one vertex they differ a
// little: the edge to the light's side belongs to the photon, that to the camera's side to the camera vertex.
struct PathVertex {
  Double3 position{}, positionToCamera{};  // of the vertex as the end of either edge
  Double3 normal{}, normalToCamera{};      // geometric
  Double3 shading{};
  Double3 toLight{}, toCamera{};  // unit directions along the edges
  uint32_t material = kNoIndex;   // of x_1 .. x_{k-1}
  bool specular = false;          // a delta lobe joins its two edges
};

struct FullPath {
  std::vector<PathVertex> x;
  uint32_t light = 0;  // on which x_0 lies
  size_t edges() const { return x.size() - 1; }
};

// Densities of the strategies of a path, relative to each other; those that a method lacks or that cannot make the path
// are 0. connect[s] is strategy (s, k + 1 - s) for s = 0 .. k, merge[i] is merging at x_i.
struct StrategyDensities {
  std::vector<double> connect, merge;
  double sum() const {
    double total = 0;
    for (const double p : connect) total += p;
    for (const double p : merge) total += p;
    return total;
  }
};

// Whether delta lobes alone lead from the lens to x_i.
inline bool isFirstMerge(const FullPath& path, size_t i) {
  for (++i; i < path.edges(); ++i) {
    if (!path.x[i].specular) return false;
  }
  return true;
}

template <class S>
class PathDensity {
 public:
  PathDensity(const SceneView<S>& scene, const MisSettings& mis) : scene_(scene), mis_(mis) {}

  StrategyDensities of(const FullPath& path) const {
    const size_t k = path.edges();
    const auto& x = path.x;
    if (k == 1) return {{1.0, 0.0}, {0.0, 0.0}};  // a light that the camera sees: s = 0 alone
    // fromLight[i], fromCamera[i]: density of x_i when it is sampled from its neighbour on that side.
    std::vector<double> fromLight(k + 1, 0), fromCamera(k + 1, 0);
    const LightDensity light = lightDensity(path);
    fromLight[0] = light.position;
    fromLight[1] = light.firstEdge;
    for (size_t i = 1; i + 1 < k; ++i) {
      fromLight[i + 1] =
          scatterDensity(x[i], Walk::light) * cosine(x[i + 1].toLight, x[i + 1].normal) / toCamera2(path, i);
    }
    fromCamera[k] = 1;
    fromCamera[k - 1] = cameraDensity(path);
    for (size_t i = k - 1; i >= 1; --i) {
      const double density = scatterDensity(x[i], Walk::camera);
      fromCamera[i - 1] =
          i == 1 && light.infinite ? density : density * cosineToCamera(path, i - 1) / toCamera2(path, i - 1);
    }

    StrategyDensities out{std::vector<double>(k + 1, 0), std::vector<double>(k + 1, 0)};
    const auto joinable = [&](size_t i) { return i == k || !x[i].specular; };
    const auto product = [&](size_t lightVertices, size_t firstCamera) {
      double p = 1;
      for (size_t i = 0; i < lightVertices; ++i) p *= fromLight[i];
      for (size_t i = firstCamera; i < k; ++i) p *= fromCamera[i];
      return p;
    };
    if (mis_.emission && !light.delta) out.connect[0] = product(0, 0);
    if (mis_.nextEvent && joinable(1)) out.connect[1] = light.direct * product(0, 1);
    for (size_t s = 2; s < k && mis_.connect; ++s) {
      if (joinable(s - 1) && joinable(s)) out.connect[s] = product(s, s);
    }
    if (mis_.camera && joinable(k - 1)) out.connect[k] = mis_.lightPaths * product(k, k);
    const double disc = std::numbers::pi * mis_.radius * mis_.radius * mis_.lightPaths;
    for (size_t i = 1; i < k && mis_.merge; ++i) {
      if (joinable(i) && (isFirstMerge(path, i) || !mis_.firstMerges)) out.merge[i] = disc * product(i + 1, i);
    }
    return out;
  }

 private:
  struct LightDensity {
    double position = 0;   // of y_0: per area, or of its direction for infinite lights; pick included
    double firstEdge = 0;  // of y_1 given y_0, per area
    double direct = 0;     // of y_0 by next event estimation from x_1, in the measure of `position`
    bool delta = false, infinite = false;
  };

  static double cosine(const Double3& direction, const Double3& normal) { return std::abs(dot(direction, normal)); }
  // Of x_i towards x_{i+1}.
  static double cosineToCamera(const FullPath& path, size_t i) {
    return cosine(path.x[i].toCamera, path.x[i].normalToCamera);
  }
  // Squared length of the edge from x_i to x_{i+1}.
  static double toCamera2(const FullPath& path, size_t i) {
    const Double3 edge = path.x[i + 1].position - path.x[i].positionToCamera;
    return dot(edge, edge);
  }

  double scatterDensity(const PathVertex& v, Walk walk) const {
    const Double3 wi = walk == Walk::light ? v.toLight : v.toCamera, wo = walk == Walk::light ? v.toCamera : v.toLight;
    const auto bsdf = ReferenceBsdf::facing(scene_.materials[v.material], v.shading, wi);
    return v.specular ? bsdf.specularDensity(wi, wo) : bsdf.pdfW(wi, wo);
  }

  double cameraDensity(const FullPath& path) const {
    const size_t k = path.edges();
    const CameraView& camera = scene_.camera;
    const Double3 axis{camera.axis[0], camera.axis[1], camera.axis[2]};
    const double cos = -dot(path.x[k - 1].toCamera, axis);
    if (camera.parallel) {
      const auto length = [](const double(&a)[3]) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); };
      return cosineToCamera(path, k - 1) / (length(camera.du) * length(camera.dv));
    }
    const double pdfW = camera.pixelDistance * camera.pixelDistance / (cos * cos * cos);
    return pdfW * cosineToCamera(path, k - 1) / toCamera2(path, k - 1);
  }

  // Of the scene's box (METHODS 2.2).
  double projectedArea(const Double3& w) const {
    const double a = 2 * scene_.halfExtent[0], b = 2 * scene_.halfExtent[1], c = 2 * scene_.halfExtent[2];
    return std::abs(w[0]) * b * c + std::abs(w[1]) * a * c + std::abs(w[2]) * a * b;
  }

  LightDensity lightDensity(const FullPath& path) const {
    const auto& light = scene_.lights[path.light];
    const PathVertex &y0 = path.x[0], &y1 = path.x[1];
    const double pick = light.pick, n0 = cosineToCamera(path, 0);
    const double toArea = cosine(y1.toLight, y1.normal) / toCamera2(path, 0);
    const double fromAfar = cosine(y1.toLight, y1.normal) / projectedArea(y1.toLight);
    LightDensity out;
    switch (static_cast<LightKind>(light.kind)) {
      case LightKind::quad:
      case LightKind::triangle:
        out = {pick * light.inverseArea, n0 / std::numbers::pi * toArea, pick * light.inverseArea};
        break;
      case LightKind::sphere: {
        out = {pick * light.inverseArea, n0 / std::numbers::pi * toArea, pick * light.inverseArea};
        const Double3 center{light.p0[0], light.p0[1], light.p0[2]};
        const double sin2 = double{light.radius} * light.radius / dot(center - y1.position, center - y1.position);
        if (sin2 < 1) {
          const double cone = 2 * std::numbers::pi * sin2 / (1 + std::sqrt(1 - sin2));
          out.direct = pick / cone * n0 / toCamera2(path, 0);
        }
        break;
      }
      case LightKind::point:
        out = {pick, toArea / (4 * std::numbers::pi), pick, true};
        break;
      case LightKind::spot:
        out = {pick, toArea / (2 * std::numbers::pi * light.cutoffHeight), pick, true};
        break;
      case LightKind::projector: {  // uniform on its picture, at distance 1 along the axis
        const Double3 axis{light.normal[0], light.normal[1], light.normal[2]};
        const double cos = dot(y0.toCamera, axis);
        out = {pick, toArea * light.inverseArea / (cos * cos * cos), pick, true};
        break;
      }
      case LightKind::directional:
        out = {pick, fromAfar, pick, true, true};
        break;
      case LightKind::constant:
        out = {pick / (4 * std::numbers::pi), fromAfar, pick / (4 * std::numbers::pi), false, true};
        break;
      case LightKind::envmap: {
        const double pdf = pick * mapDensity(y0.toCamera * -1.0);
        out = {pdf, fromAfar, pdf, false, true};
        break;
      }
    }
    return out;
  }

  // Texel's probability over its solid angle at the direction; Mitsuba's parametrisation.
  double mapDensity(const Double3& world) const {
    const EnvironmentView& map = scene_.environment;
    Double3 d{};
    for (size_t i = 0; i < 3; ++i)
      d[i] = map.toLocal[i][0] * world[0] + map.toLocal[i][1] * world[1] + map.toLocal[i][2] * world[2];
    double u = std::atan2(d[0], -d[2]) / (2 * std::numbers::pi);
    u -= std::floor(u);
    const double theta = std::acos(std::clamp(d[1], -1.0, 1.0));
    const auto column = std::min(static_cast<uint32_t>(u * map.width), map.width - 1);
    const auto row = std::min(static_cast<uint32_t>(theta / std::numbers::pi * map.height), map.height - 1);
    const double texels = static_cast<double>(map.width) * map.height;
    return double{map.probability[row * map.width + column]} * texels /
           (2 * std::numbers::pi * std::numbers::pi * std::sin(theta));
  }

  const SceneView<S>& scene_;
  const MisSettings mis_;
};

}  // namespace wavecrest
