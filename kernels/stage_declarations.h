// Declarations of every stage in lanes; stage_table.cpp gathers their addresses. One stage, one line, one file.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

#define WAVECREST_DECLARE_STAGE(STAGE)   \
  template <class P, uint32_t kFeatures> \
  void STAGE(const StageContext<typename P::Storage>&, Wave<typename P::Storage>&);

WAVECREST_DECLARE_STAGE(generateCameraPaths)  // generate/generate_camera.cpp
WAVECREST_DECLARE_STAGE(extendSmall)          // extend/extend_small.cpp
WAVECREST_DECLARE_STAGE(occludeSmall)         // extend/occlude_small.cpp
WAVECREST_DECLARE_STAGE(arrive)               // shade/arrive.cpp
WAVECREST_DECLARE_STAGE(nextEvent)            // connect/next_event.cpp
WAVECREST_DECLARE_STAGE(scatter)              // shade/scatter.cpp
WAVECREST_DECLARE_STAGE(scatterSpecular)      // shade/scatter.cpp
WAVECREST_DECLARE_STAGE(generateLightPaths)   // generate/generate_light.cpp
WAVECREST_DECLARE_STAGE(storeLightVertices)   // connect/store_light_vertices.cpp
WAVECREST_DECLARE_STAGE(connectToCamera)      // connect/connect_camera.cpp
WAVECREST_DECLARE_STAGE(connectVertices)      // connect/connect_vertices.cpp
WAVECREST_DECLARE_STAGE(merge)                // merge/merge.cpp

#undef WAVECREST_DECLARE_STAGE

WAVECREST_SIMD_END
