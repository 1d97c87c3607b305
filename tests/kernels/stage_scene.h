// A small scene put together from kernel records alone, for the tests of stages and intersectors.
//
// In: primitives in double, in SceneView order or not. Out: a SceneView in S with every intersector behind it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include "kernels/double_vectors.h"
#include "kernels/extend/bvh.h"
#include "kernels/extend/embree_scene.h"
#include "kernels/extend/small_scene.h"
#include "kernels/stages.h"

namespace wavecrest {

using Point = D3;

// A square film whose raster (x, y) is seen in the direction corner + x across + y down. What only t = 1 reads is left
// out.
inline CameraView pinholeCamera(const Point& origin, const Point& corner, const Point& across, const Point& down,
                                uint32_t size) {
  CameraView camera{};
  camera.width = camera.height = size;
  for (size_t i = 0; i < 3; ++i) {
    camera.origin[i] = origin[i];
    camera.corner[i] = corner[i];
    camera.du[i] = across[i];
    camera.dv[i] = down[i];
  }
  return camera;
}

// ---- primitives -----------------------------------------------------------------------------------------------------

inline PrimitiveRecord<double> facePrimitive(PrimitiveKind kind, const Point& p0, const Point& e1, const Point& e2) {
  PrimitiveRecord<double> record{};
  const Point normal = normalized(cross(e1, e2));
  for (size_t i = 0; i < 3; ++i) {
    record.p0[i] = p0[i];
    record.e1[i] = e1[i];
    record.e2[i] = e2[i];
    record.normal[i] = normal[i];
  }
  record.kind = static_cast<uint32_t>(kind);
  record.light = record.attributes = kNoIndex;
  return record;
}
// By three corners: (u, v) = (0, 0), (1, 0), (0, 1).
inline PrimitiveRecord<double> quadPrimitive(const Point& p, const Point& alongU, const Point& alongV) {
  return facePrimitive(PrimitiveKind::quad, p, alongU - p, alongV - p);
}
inline PrimitiveRecord<double> trianglePrimitive(const Point& p, const Point& alongU, const Point& alongV) {
  return facePrimitive(PrimitiveKind::triangle, p, alongU - p, alongV - p);
}
// side: +1 for an outward normal, -1 for an inward one.
inline PrimitiveRecord<double> spherePrimitive(const Point& center, double radius, double side = 1) {
  PrimitiveRecord<double> record{};
  std::copy(center.begin(), center.end(), record.p0);
  record.e1[0] = radius;
  record.e1[1] = side;
  record.kind = static_cast<uint32_t>(PrimitiveKind::sphere);
  record.light = record.attributes = kNoIndex;
  return record;
}

inline Point corner(const PrimitiveRecord<double>& r, double u, double v) {
  return {r.p0[0] + u * r.e1[0] + v * r.e2[0], r.p0[1] + u * r.e1[1] + v * r.e2[1],
          r.p0[2] + u * r.e1[2] + v * r.e2[2]};
}

// A rotation about no axis in particular, so that no coordinate of a direction or normal stays zero.
inline Point turned(const Point& p) {
  const double a = 0.7, b = 0.4;
  const Point q{p[0] * std::cos(a) + p[2] * std::sin(a), p[1], p[2] * std::cos(a) - p[0] * std::sin(a)};
  return {q[0] * std::cos(b) - q[1] * std::sin(b), q[0] * std::sin(b) + q[1] * std::cos(b), q[2]};
}

// ---- the scene ------------------------------------------------------------------------------------------------------

template <class S>
class StageScene {
 public:
  // Sorts the primitives by kind, keeping their order otherwise.
  explicit StageScene(const std::vector<PrimitiveRecord<double>>& primitives)
      : StageScene(primitives, boxAt(primitives.front().p0)) {}
  // origins: around other points that rays start from.
  StageScene(const std::vector<PrimitiveRecord<double>>& primitives, const Box& origins) {
    // No std::stable_sort: its buffer does not keep the records' alignment.
    for (size_t kind = 0; kind < 3; ++kind) {
      std::copy_if(primitives.begin(), primitives.end(), std::back_inserter(precise),
                   [kind](const auto& record) { return order(record) == kind; });
    }
    uint32_t counts[3]{};
    for (const auto& record : precise) {
      records.push_back(rounded(record));
      ++counts[order(record)];
    }
    small = std::make_unique<SmallScene>(precise.data(), precise.size(), origins);
    embree = std::make_unique<EmbreeScene>(records.data(), counts[0], counts[1], counts[2]);
    bvh = std::make_unique<Bvh>(precise.data(), precise.size(), origins);
    materials.resize(1);
    std::fill_n(materials[0].reflectance, 3, 0.8f);
    view.primitives = records.data();
    view.materials = materials.data();
    view.spheres = counts[2] != 0;
    view.firstPrimitive[1] = counts[0];
    view.firstPrimitive[2] = counts[0] + counts[1];
    view.small = &small->view();
    view.embree = embree->handle();
    view.bvh = &bvh->view();
    view.radius = 4;
    std::fill_n(view.halfExtent, 3, 4.0);
  }

  // Makes all lights equally likely, by an alias table that uses its aliases.
  void setLights(std::vector<LightRecord<S>> list) {
    lights = std::move(list);
    const auto count = static_cast<uint32_t>(lights.size());
    for (uint32_t i = 0; i < count; ++i) {
      lights[i].pick = S(1) / static_cast<S>(count);
      if (lights[i].kind == static_cast<uint32_t>(LightKind::constant)) view.infiniteLight = i;
      table.push_back({0.7f, (i + 1) % count});
    }
    view.lights = lights.data();
    view.lightTable = table.data();
    view.lightCount = count;
  }

  // Pixels in an order that is neither rows nor columns.
  void setCamera(const CameraView& camera) {
    view.camera = camera;
    for (uint32_t i = 0; i < camera.width * camera.height; ++i) {
      const uint32_t k = i * 37 % (camera.width * camera.height);
      pixels.push_back((k / camera.width) << 16 | (k % camera.width));
    }
  }

  std::vector<PrimitiveRecord<double>> precise;
  std::vector<PrimitiveRecord<S>> records;
  std::vector<MaterialRecord> materials;
  std::vector<LightRecord<S>> lights;
  std::vector<AliasEntry> table;
  std::vector<uint32_t> pixels;
  std::unique_ptr<SmallScene> small;
  std::unique_ptr<EmbreeScene> embree;
  std::unique_ptr<Bvh> bvh;
  SceneView<S> view;

 private:
  static uint32_t order(const PrimitiveRecord<double>& record) {
    switch (static_cast<PrimitiveKind>(record.kind)) {
      case PrimitiveKind::quad:
        return 0;
      case PrimitiveKind::triangle:
        return 1;
      case PrimitiveKind::sphere:
        return 2;
    }
    return 2;
  }
  static PrimitiveRecord<S> rounded(const PrimitiveRecord<double>& record) {
    PrimitiveRecord<S> out{};
    for (size_t i = 0; i < 3; ++i) {
      out.p0[i] = static_cast<S>(record.p0[i]);
      out.e1[i] = static_cast<S>(record.e1[i]);
      out.e2[i] = static_cast<S>(record.e2[i]);
      out.normal[i] = static_cast<S>(record.normal[i]);
    }
    out.material = record.material;
    out.light = record.light;
    out.kind = record.kind;
    out.attributes = record.attributes;
    return out;
  }
};

}  // namespace wavecrest
