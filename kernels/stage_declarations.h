// Declarations in lanes of what stage_table.cpp gathers the addresses of: the catalogue's stages, and what the film
// calls.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

#define WAVECREST_TEMPLATE_featured template <class P, uint32_t kFeatures>
#define WAVECREST_TEMPLATE_bidirectional template <class P, uint32_t kFeatures>
#define WAVECREST_TEMPLATE_common template <class P>
#define WAVECREST_DECLARE_STAGE(NAME, TITLE, ITEMS, FAMILY, LANES) \
  WAVECREST_TEMPLATE_##FAMILY void NAME(const StageContext<typename P::Storage>&, Wave<typename P::Storage>&);
WAVECREST_STAGE_CATALOGUE(WAVECREST_DECLARE_STAGE)
#undef WAVECREST_DECLARE_STAGE

// Not a stage of a wave: it works on a range of one queue, under the engine's locks. splat/add_splats.cpp
template <class S>
void addSplats(const Splats<S>&, size_t begin, size_t end, const SplatSums&, StageCounters&);

// What the film calls for the samples of a tile: splat/spread_samples.cpp
template <class S>
uint64_t spreadSamples(const TileSamples<S>&, const SpreadAxis& x, const SpreadAxis& y, const TileSums&);
template <class S>
void filterPlaces(const CameraView&, const SamplerSettings&, size_t count, FilterPlace*);

WAVECREST_SIMD_END
