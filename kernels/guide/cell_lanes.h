// The cell of each lane's vertex (kernels/columns/cell_tree.h).
#pragma once

#include "kernels/columns/cell_tree.h"
#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

// The ten lowest bits of x, with two zeros between neighbours.
WAVECREST_INLINE UInt spreadTenBits(UInt x) {
  x = (x | shiftLeft<16>(x)) & UInt(0x030000ffu);
  x = (x | shiftLeft<8>(x)) & UInt(0x0300f00fu);
  x = (x | shiftLeft<4>(x)) & UInt(0x030c30c3u);
  return (x | shiftLeft<2>(x)) & UInt(0x09249249u);
}

// The root of surfaces that face this way.
WAVECREST_INLINE UInt cellRoot(Vec3<Float> facing) {
  const Vec3<Float> size = abs(facing);
  const Mask alongX = (size.x >= size.y) & (size.x >= size.z), alongY = size.y >= size.z;
  const UInt axis = select(alongX, UInt(0u), select(alongY, UInt(2u), UInt(4u)));
  const Float component = select(alongX, facing.x, select(alongY, facing.y, facing.z));
  return select(component < Float(0), axis + UInt(1u), axis);
}

// place: in the world; places outside of the box count as those on its border. facing: the normal on the side of the
// path. Lanes that are not active get cell 0.
WAVECREST_INLINE UInt cellOf(const CellTreeView& tree, Mask active, Vec3<Float> place, Vec3<Float> facing) {
  const auto halvings = [&](Float p, int axis) WAVECREST_LAMBDA {
    const Float scaled = (p - Float(tree.least[axis])) * Float(tree.scale[axis]);
    const float most = static_cast<float>((1u << kCellBitsOfAxis) - 1);
    return spreadTenBits(toUInt(min(max(scaled, Float(0)), Float(most))));
  };
  // Bit by bit, from the uppermost one: which half of the cell along x, y and z in turn.
  UInt code = shiftLeft<2>(halvings(place.x, 0)) | shiftLeft<1>(halvings(place.y, 1)) | halvings(place.z, 2);
  const UInt start = shiftLeft<kCellStartLevels>(cellRoot(facing)) | shiftRight<kCellLevels - kCellStartLevels>(code);
  UInt node = gather(tree.starts, select(active, start, UInt(0u)));
  code = shiftLeft<kCellStartLevels>(code);
  for (;;) {
    const Mask inner = active & (node < UInt(kCellLeaf));
    if (none(inner)) break;
    const UInt half = shiftRight<kCellLevels - 1>(code) & UInt(1u);
    node = select(inner, gather(tree.nodes, select(inner, node + half, UInt(0u))), node);
    code = shiftLeft<1>(code);
  }
  return select(active, node & UInt(kCellLeaf - 1), UInt(0u));
}

WAVECREST_SIMD_END
