// recordVertices: notes how far the path of each chain has come, which says which primary samples it uses.
//
// in: PathStates [n] at a depth. out: Chains::proposedCamera of their lanes.
#include "kernels/columns/chains.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void recordVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  uint32_t* const vertices = context.chains.state->columns.proposedCamera;
  const uint32_t* const lanes = wave.paths.lane;
  for (size_t i = 0; i < wave.rays.size; ++i) vertices[lanes[i]] = context.depth + 1;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(recordVertices)
