// findCells: the cell of each vertex (kernels/columns/cell_tree.h).
//
// in: Rays (at vertices), Surfaces [n]. out: VertexCells [n], in that order. A surface that is seen from both sides has
// cells of its own for each: the normal counts on the side that the path came from.
#include "kernels/guide/cell_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void findCells(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  wave.cells.size = 0;
  if (context.learned.cells == nullptr) return;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  const size_t count = rays.size;
  wave.cells.claim(count);
  for (size_t i = 0; i < count; i += kLanes) {
    const auto place = to<Float>(loadVec3(rays.originX, rays.originY, rays.originZ, i));
    const auto direction = to<Float>(loadVec3(rays.directionX, rays.directionY, rays.directionZ, i));
    const auto normal = to<Float>(loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i));
    const Vec3<Float> facing = select(dot(normal, direction) > Float(0), -normal, normal);
    store(cellOf(*context.learned.cells, firstLanes(count - i), place, facing), wave.cells.cell, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(findCells)
