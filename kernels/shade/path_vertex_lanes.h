// A path at its vertex, whole: what moves when vertices are put into another order or another wave.
#pragma once

#include "kernels/mis_lanes.h"
#include "kernels/surface/vertex_detail_lanes.h"

WAVECREST_SIMD_BEGIN

// A vertex and what its path carries.
template <uint32_t kFeatures, class Real>
struct PathVertexLanes {
  Vec3<Real> position, direction, normal, throughput;
  VertexDetailLanes<Real> details;
  Real offset, rouletteScale;
  MisSums<Real> mis;
  UInt lane, primitive;

  // Calls function(number, column) for each number that this feature set keeps, with its column among the vertices.
  template <class Vertices, class Function>
  WAVECREST_INLINE void forEach(Vertices& vertices, Function&& function) {
    const auto three = [&](Vec3<Real>& v, auto& x, auto& y, auto& z) WAVECREST_LAMBDA {
      function(v.x, x);
      function(v.y, y);
      function(v.z, z);
    };
    auto& rays = vertices.rays;
    auto& surfaces = vertices.surfaces;
    auto& paths = vertices.paths;
    three(position, rays.originX, rays.originY, rays.originZ);
    three(direction, rays.directionX, rays.directionY, rays.directionZ);
    three(normal, surfaces.normalX, surfaces.normalY, surfaces.normalZ);
    function(offset, surfaces.offset);
    details.template forEach<kFeatures>(surfaces, function);
    three(throughput, paths.throughputR, paths.throughputG, paths.throughputB);
    function(mis.dVCM, paths.dVCM);
    if constexpr (has(kFeatures, kBidirectional)) function(mis.dVC, paths.dVC);
    if constexpr (hasRouletteScale(kFeatures)) function(rouletteScale, paths.rouletteScale);
    function(lane, paths.lane);
    function(primitive, vertices.hits.primitive);
  }
};

WAVECREST_SIMD_END
