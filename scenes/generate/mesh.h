// A triangle mesh under construction: positions, one unit normal per vertex, triangles counter-clockwise seen from the
// side the normals point to. Shapes are appended to it, so a teapot is a lathe plus two tubes in one file.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/generate/vec3.h"

namespace wavecrest::generate {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<std::array<uint32_t, 3>> triangles;

  uint32_t addVertex(const Vec3& position, const Vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
    return static_cast<uint32_t>(positions.size() - 1);
  }
  void addTriangle(uint32_t a, uint32_t b, uint32_t c) { triangles.push_back({a, b, c}); }

  // The quadrilateral a, b, c, d in order around its rim, cut along a-c.
  void addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    addTriangle(a, b, c);
    addTriangle(a, c, d);
  }
};

// Triangles between two closed rings of `count` consecutive vertices each. The outside is on the left of the step from
// ring to nextRing for someone who looks along the ring's order.
inline void bridgeRings(Mesh& mesh, uint32_t ring, uint32_t nextRing, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t j = (i + 1) % count;
    mesh.addQuad(ring + i, ring + j, nextRing + j, nextRing + i);
  }
}

}  // namespace wavecrest::generate
