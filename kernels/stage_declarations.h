// Declarations of every stage in lanes; stage_table.cpp gathers their addresses. One stage, one line, one file.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

#define WAVECREST_DECLARE_STAGE(STAGE)   \
  template <class P, uint32_t kFeatures> \
  void STAGE(const StageContext<typename P::Storage>&, Wave<typename P::Storage>&);
// One that is the same for all feature sets.
#define WAVECREST_DECLARE_COMMON_STAGE(STAGE) \
  template <class P>                          \
  void STAGE(const StageContext<typename P::Storage>&, Wave<typename P::Storage>&);

WAVECREST_DECLARE_STAGE(generateCameraPaths)      // generate/generate_camera.cpp
WAVECREST_DECLARE_COMMON_STAGE(extendSmall)       // extend/extend_small.cpp
WAVECREST_DECLARE_COMMON_STAGE(occludeSmall)      // extend/occlude_small.cpp
WAVECREST_DECLARE_COMMON_STAGE(extendBvh)         // extend/extend_bvh.cpp
WAVECREST_DECLARE_COMMON_STAGE(occludeBvh)        // extend/occlude_bvh.cpp
WAVECREST_DECLARE_STAGE(arrive)                   // shade/arrive.cpp
WAVECREST_DECLARE_STAGE(nextEvent)                // connect/next_event.cpp
WAVECREST_DECLARE_STAGE(scatter)                  // shade/scatter.cpp
WAVECREST_DECLARE_STAGE(scatterSpecular)          // shade/scatter.cpp
WAVECREST_DECLARE_STAGE(generateLightPaths)       // generate/generate_light.cpp
WAVECREST_DECLARE_STAGE(storeLightVertices)       // connect/store_light_vertices.cpp
WAVECREST_DECLARE_STAGE(connectToCamera)          // connect/connect_camera.cpp
WAVECREST_DECLARE_STAGE(connectVertices)          // connect/connect_vertices.cpp
WAVECREST_DECLARE_STAGE(merge)                    // merge/merge.cpp
WAVECREST_DECLARE_COMMON_STAGE(proposeMutations)  // mutate/propose_mutations.cpp
WAVECREST_DECLARE_COMMON_STAGE(recordVertices)    // mutate/record_vertices.cpp
WAVECREST_DECLARE_COMMON_STAGE(acceptMutations)   // mutate/accept_mutations.cpp
WAVECREST_DECLARE_STAGE(admitWalks)               // mutate/take_ends.cpp
WAVECREST_DECLARE_STAGE(takeEnds)                 // mutate/take_ends.cpp
WAVECREST_DECLARE_COMMON_STAGE(proposePaths)      // mutate/propose_paths.cpp
WAVECREST_DECLARE_STAGE(beginEyeWalks)            // mutate/walk_paths.cpp
WAVECREST_DECLARE_STAGE(beginLightWalks)          // mutate/walk_paths.cpp
WAVECREST_DECLARE_STAGE(recordMisses)             // mutate/record_walks.cpp
WAVECREST_DECLARE_STAGE(recordPathVertices)       // mutate/record_walks.cpp
WAVECREST_DECLARE_STAGE(walkPaths)                // mutate/walk_paths.cpp
WAVECREST_DECLARE_STAGE(joinPaths)                // mutate/join_paths.cpp
WAVECREST_DECLARE_STAGE(evaluatePaths)            // mutate/evaluate_paths.cpp
WAVECREST_DECLARE_COMMON_STAGE(weighPaths)        // mutate/weigh_paths.cpp
WAVECREST_DECLARE_COMMON_STAGE(commitPaths)       // mutate/weigh_paths.cpp

#undef WAVECREST_DECLARE_STAGE
#undef WAVECREST_DECLARE_COMMON_STAGE

WAVECREST_SIMD_END
