#include "engine/compile/tessellate.h"

#include <cmath>
#include <numbers>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

Float3 rounded(const Double3& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

}  // namespace

Mesh tessellated(const Disk& disk) {
  Mesh mesh;
  // Sectors share no vertices: at the centre each has its own angle v, and at the seam v is 1 on one side and 0 on the
  // other.
  const auto add = [&](uint32_t ring, uint32_t segment) {
    const double r = static_cast<double>(ring) / kRings, angle = 2 * std::numbers::pi * segment / kSegments;
    mesh.positions.push_back(
        rounded(disk.center + disk.axisU * (r * std::cos(angle)) + disk.axisV * (r * std::sin(angle))));
    const float turn = static_cast<float>(segment) / kSegments;
    mesh.uvs.push_back({static_cast<float>(r), disk.mirrored ? 1 - turn : turn});
  };
  for (uint32_t sector = 0; sector < kSegments; ++sector) {
    const auto centre = static_cast<uint32_t>(mesh.positions.size());
    add(0, sector);
    for (uint32_t ring = 1; ring <= kRings; ++ring) {
      const auto outer = static_cast<uint32_t>(mesh.positions.size());
      add(ring, sector);
      add(ring, sector + 1);
      // A triangle at the centre, then quads whose inner vertices are outer - 2 and outer - 1.
      if (ring == 1) {
        mesh.triangles.push_back({centre, outer, outer + 1});
      } else {
        mesh.triangles.push_back({outer - 2, outer, outer + 1});
        mesh.triangles.push_back({outer - 2, outer + 1, outer - 1});
      }
    }
  }
  return mesh;
}

Mesh tessellated(const Cylinder& cylinder) {
  Mesh mesh;
  const Double3 axis = cylinder.p1 - cylinder.p0, x = cylinder.phi0, y = cylinder.phi90;
  const bool mirrored = dot(cross(x, y), axis) < 0;
  const double side = cylinder.flipNormals ? -1 : 1;
  // Columns of kParts + 1 vertices. The last column is in the place of the first, with u = 1.
  for (uint32_t i = 0; i <= kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    const Double3 n = x * std::cos(angle) + y * std::sin(angle);
    for (uint32_t k = 0; k <= kParts; ++k) {
      const double along = static_cast<double>(k) / kParts;
      mesh.positions.push_back(rounded(cylinder.p0 + axis * along + n * cylinder.radius));
      mesh.normals.push_back(rounded(n * side));
      mesh.uvs.push_back({static_cast<float>(i) / kSegments, static_cast<float>(along)});
    }
  }
  // Two triangles between neighbouring columns, wound to face along the normals. Where the axes are mirrored, phi runs
  // clockwise.
  for (uint32_t i = 0; i < kSegments; ++i) {
    for (uint32_t k = 0; k < kParts; ++k) {
      const uint32_t a = i * (kParts + 1) + k, b = a + 1, c = a + kParts + 1, d = c + 1;
      if (cylinder.flipNormals != mirrored) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({d, c, b});
      } else {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({d, b, c});
      }
    }
  }
  return mesh;
}

}  // namespace wavecrest
