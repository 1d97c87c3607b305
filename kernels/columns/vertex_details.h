// What only some scenes ask of a vertex: the columns that live paths, light vertices and path space have in common.
#pragma once

#include "kernels/columns/columns.h"

namespace wavecrest {

// Which optional columns a scene and method need.
struct ColumnNeeds {
  bool shadingNormals = true;
  bool textures = true;
  bool normalMaps = true;
  bool tangents = true;
  bool instances = true;
  bool rouletteScale = true;
  // What methods with light paths need: dVC and the light of paths, pairs, vertex rows.
  bool connections = true;
  // Room to sort vertices by their BSDFs, where not all are diffuse (kernels/shade/vertex_order_lanes.h).
  bool bsdfOrder = true;
  bool splats = true;
  // Room for rays behind the surfaces that they have passed (kernels/pass/pass_surfaces.cpp).
  bool passages = false;
  bool visibility = true;  // where occlude walks a hierarchy
  // The cells of vertices, and records of directions: of renders that learn.
  bool cells = false, directions = false;
};

// Base of records of vertices. all() of such a record ends with details().
template <class S>
struct VertexDetails {
  Column<S> shadingX, shadingY, shadingZ;  // shading normal; dropped where the scene has none
  Column<S> baseX, baseY, baseZ;           // the same without bump and normal maps; dropped without those
  Column<float> uvU, uvV;                  // texture coordinates; dropped where the scene has no textures
  // Angle of dp/du about the base normal in Frame::fromNormal of it; dropped where no BSDF depends on it.
  Column<float> tangent;

  auto details() { return std::tie(shadingX, shadingY, shadingZ, baseX, baseY, baseZ, uvU, uvV, tangent); }

  void dropDetails() {
    std::apply([](auto&... column) { (column.drop(), ...); }, details());
  }
  // Drops those that are not needed.
  void keepDetails(const ColumnNeeds& needs) {
    const auto dropUnless = [](bool needed, auto&... column) {
      if (!needed) (column.drop(), ...);
    };
    dropUnless(needs.shadingNormals, shadingX, shadingY, shadingZ);
    dropUnless(needs.normalMaps, baseX, baseY, baseZ);
    dropUnless(needs.textures, uvU, uvV);
    dropUnless(needs.tangents, tangent);
  }
};

}  // namespace wavecrest
