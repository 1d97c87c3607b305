// Directions and cells of guides behind plain pointers, for guide_lanes_test.cpp.
#include "tests/kernels/guide_entries.h"

#include "kernels/guide/cell_lanes.h"
#include "kernels/guide/guide_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

void toSquareColumns(const float* x, const float* y, const float* z, size_t count, uint32_t* bin, float* solidAngle) {
  for (size_t i = 0; i < count; i += kLanes) {
    const SquarePoint at = toSquare({load(x + i), load(y + i), load(z + i)});
    store(binOf(at.u, at.v), bin + i);
    store(at.solidAngle, solidAngle + i);
  }
}

void drawColumns(const GuideView& guide, const float* b, const float* c, const float* d, size_t count, float* x,
                 float* y, float* z, float* density) {
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<Float> direction = drawFromGuide(guide, UInt(0u), {Float(0), load(b + i), load(c + i), load(d + i)});
    store(direction.x, x + i);
    store(direction.y, y + i);
    store(direction.z, z + i);
    store(guideDensity(guide, UInt(0u), direction), density + i);
  }
}

void cellColumns(const CellTreeView& tree, const float* x, const float* y, const float* z, size_t count,
                 uint32_t* cell) {
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<Float> place{load(x + i), load(y + i), load(z + i)};
    const Vec3<Float> facing{Float(0.3f), copySign(Float(0.9f), place.y), Float(-0.2f)};
    store(cellOf(tree, allLanes(), place, facing), cell + i);
  }
}

constexpr GuideEntries kGuideEntries = {
    .lanes = kLanes, .toSquare = toSquareColumns, .draw = drawColumns, .cells = cellColumns};
WAVECREST_REGISTER_ENTRIES(GuideEntries, kGuideEntries);

}  // namespace
WAVECREST_SIMD_END
