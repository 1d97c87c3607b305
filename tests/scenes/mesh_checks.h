// Questions about a generated mesh that several tests ask.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

// Signed volume of a closed mesh whose triangles face outwards (divergence theorem).
inline double signedVolume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += dot(mesh.positions[a], cross(mesh.positions[b], mesh.positions[c])) / 6;
  return volume;
}

// Number of directed edges, by position, whose opposite is missing or which occur more than once: 0 for a watertight,
// consistently oriented mesh. Vertices at exactly the same place count as one.
inline int openEdges(const Mesh& mesh) {
  std::map<std::pair<Vec3, Vec3>, int> count;
  for (const auto& t : mesh.triangles)
    for (size_t i = 0; i < 3; ++i) ++count[{mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]}];
  int open = 0;
  for (const auto& [edge, times] : count) {
    const auto opposite = count.find({edge.second, edge.first});
    if (times != 1 || opposite == count.end() || opposite->second != 1) ++open;
  }
  return open;
}

// The smallest cosine between a triangle's own normal and the normals of its corners.
inline double worstNormalAgreement(const Mesh& mesh) {
  double worst = 1;
  for (const auto& t : mesh.triangles) {
    const Vec3 origin = mesh.positions[t[0]];
    const Vec3 facet = normalize(cross(mesh.positions[t[1]] - origin, mesh.positions[t[2]] - origin));
    for (uint32_t index : t) worst = std::min(worst, dot(facet, mesh.normals[index]));
  }
  return worst;
}

inline double worstNormalLength(const Mesh& mesh) {
  double worst = 0;
  for (const Vec3& normal : mesh.normals) worst = std::max(worst, std::abs(length(normal) - 1));
  return worst;
}

}  // namespace wavecrest::generate
