#include "engine/compile/tessellate.h"

#include <cmath>
#include <numbers>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSegments = 256;

}  // namespace

Mesh tessellated(const Disk& disk) {
  Mesh mesh;
  const auto add = [&](const Double3& p, float r, float angle) {
    mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    mesh.uvs.push_back({r, angle});
  };
  for (uint32_t i = 0; i < kSegments; ++i) {
    const auto angleOf = [](uint32_t k) { return 2 * std::numbers::pi * k / kSegments; };
    const auto rim = [&](double a) { return disk.center + disk.axisU * std::cos(a) + disk.axisV * std::sin(a); };
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    add(disk.center, 0, static_cast<float>(i) / kSegments);
    add(rim(angleOf(i)), 1, static_cast<float>(i) / kSegments);
    add(rim(angleOf(i + 1)), 1, static_cast<float>(i + 1) / kSegments);
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
  return mesh;
}

Mesh tessellated(const Cylinder& cylinder) {
  Mesh mesh;
  const Double3 axis = cylinder.p1 - cylinder.p0, x = cylinder.phi0, y = cylinder.phi90;
  const bool mirrored = dot(cross(x, y), axis) < 0;
  const double side = cylinder.flipNormals ? -1 : 1;
  for (uint32_t i = 0; i <= kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    const Double3 n = x * std::cos(angle) + y * std::sin(angle);
    for (uint32_t end = 0; end < 2; ++end) {
      const Double3 p = cylinder.p0 + axis * end + n * cylinder.radius;
      mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      mesh.normals.push_back(
          {static_cast<float>(n[0] * side), static_cast<float>(n[1] * side), static_cast<float>(n[2] * side)});
      mesh.uvs.push_back({static_cast<float>(i) / kSegments, static_cast<float>(end)});
    }
  }
  for (uint32_t i = 0; i < kSegments; ++i) {
    const uint32_t a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
    if (cylinder.flipNormals != mirrored) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({d, c, b});
    } else {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({d, b, c});
    }
  }
  return mesh;
}

}  // namespace wavecrest
