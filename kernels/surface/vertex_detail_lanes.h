// What only some scenes ask of a vertex (kernels/columns/vertex_details.h), in lanes.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct VertexDetailLanes {
  Vec3<Real> normal;  // shading normal, unit
  Vec3<Real> base;    // the same without bump and normal maps
  Float u, v;         // texture coordinates
  Float tangent;      // angle of dp/du about `base` in Frame::fromNormal of it

  // Without any of them.
  WAVECREST_INLINE explicit VertexDetailLanes(Vec3<Real> geometric)
      : normal(geometric), base(geometric), u(Float(0)), v(Float(0)), tangent(Float(0)) {}
  VertexDetailLanes() = default;

  // Takes the numbers of the lanes from a record of vertices by read(column).
  template <uint32_t kFeatures, class Columns, class Read>
  WAVECREST_INLINE void read(const Columns& columns, const Read& read) {
    forEach<kFeatures>(columns, [&](auto& number, const auto& column) WAVECREST_LAMBDA { number = read(column); });
  }

  // Calls function(number, column) for each number that this feature set keeps, with its column of a record of
  // vertices.
  template <uint32_t kFeatures, class Columns, class Function>
  WAVECREST_INLINE void forEach(Columns& columns, Function&& function) {
    const auto three = [&](Vec3<Real>& vector, auto& x, auto& y, auto& z) WAVECREST_LAMBDA {
      function(vector.x, x);
      function(vector.y, y);
      function(vector.z, z);
    };
    if constexpr (has(kFeatures, kShadingNormals)) three(normal, columns.shadingX, columns.shadingY, columns.shadingZ);
    if constexpr (has(kFeatures, kTextures)) {
      function(u, columns.uvU);
      function(v, columns.uvV);
    }
    if constexpr (has(kFeatures, kCompoundBsdfs)) {
      if (columns.tangent.needed()) function(tangent, columns.tangent);
    }
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (columns.baseX.needed()) three(base, columns.baseX, columns.baseY, columns.baseZ);
    }
  }
};

WAVECREST_SIMD_END
