// The catalogue: every stage that a method can list, once. The declarations (stage_declarations.h), the table of each
// instruction set (stage_table.cpp), the ids that methods are written in, the titles of --stats, and the lists that
// tests and benchmarks go through follow from it. A new stage is its file, its line here and its line in
// CMakeLists.txt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace wavecrest {

// What the items of a stage are: the paths that begin, the live paths, those at vertices that can be joined (vertices
// with more than delta lobes), or the shadow rays.
enum class StageItems : uint8_t { beginning, live, joinable, shadowRays };

// For what a stage is compiled: every feature set, feature sets with light paths, or once for all of them.
enum class StageFamily : uint8_t { featured, bidirectional, common };

// STAGE(name, title, items, family, lanes): name of the function and of its member of Stages; lanes: `block` if it
// works on kLanes items at once, `one` if it goes through them one by one.
#define WAVECREST_STAGE_CATALOGUE(STAGE)                                                                           \
  /* generate/ */                                                                                                  \
  STAGE(generateCameraPaths, "generate", beginning, featured, block)     /* generate_camera.cpp */                 \
  STAGE(generateLightPaths, "generate", beginning, bidirectional, block) /* generate_light.cpp */                  \
  /* extend/: closest hits and visibility; methods name `extend` and `occlude`, the scene decides between these */ \
  STAGE(extendSmall, "extend", live, common, block)             /* extend_small.cpp */                             \
  STAGE(occludeSmall, "occlude", shadowRays, common, block)     /* occlude_small.cpp */                            \
  STAGE(extendBvh, "extend", live, common, block)               /* extend_bvh.cpp */                               \
  STAGE(occludeBvh, "occlude", shadowRays, common, block)       /* occlude_bvh.cpp */                              \
  STAGE(extendInstances, "extend", live, common, block)         /* extend_instances.cpp */                         \
  STAGE(occludeInstances, "occlude", shadowRays, common, block) /* occlude_instances.cpp */                        \
  STAGE(extendPassing, "extend", live, common, block)           /* pass_surfaces.cpp */                            \
  STAGE(occludePassing, "occlude", shadowRays, common, block)   /* pass_surfaces.cpp */                            \
  /* shade/ */                                                                                                     \
  STAGE(arrive, "arrive", live, featured, block)                    /* arrive.cpp */                               \
  STAGE(scatter, "scatter", live, featured, block)                  /* scatter.cpp */                              \
  STAGE(scatterSpecular, "scatter specular", live, featured, block) /* scatter.cpp: by delta lobes alone */        \
  /* connect/ */                                                                                                   \
  STAGE(nextEvent, "next event", joinable, featured, block)                   /* next_event.cpp */                 \
  STAGE(storeLightVertices, "store", joinable, bidirectional, block)          /* store_light_vertices.cpp */       \
  STAGE(connectToCamera, "connect to camera", joinable, bidirectional, block) /* connect_camera.cpp */             \
  STAGE(connectVertices, "connect", joinable, bidirectional, block)           /* connect_vertices.cpp */           \
  /* merge/ */                                                                                                     \
  STAGE(merge, "merge", joinable, bidirectional, block) /* merge.cpp */                                            \
  /* guide/ */                                                                                                     \
  STAGE(findCells, "find cells", live, common, block) /* find_cells.cpp */                                         \
  /* mutate/: what only Markov chains do */                                                                        \
  STAGE(proposeMutations, "propose", beginning, common, block)      /* propose_mutations.cpp */                    \
  STAGE(acceptMutations, "accept", beginning, common, block)        /* accept_mutations.cpp */                     \
  STAGE(recordVertices, "record", live, common, one)                /* record_vertices.cpp */                      \
  STAGE(admitWalks, "admit", live, bidirectional, block)            /* take_ends.cpp */                            \
  STAGE(takeEnds, "take ends", live, bidirectional, block)          /* take_ends.cpp */                            \
  STAGE(proposePaths, "propose", beginning, common, block)          /* propose_paths.cpp */                        \
  STAGE(beginEyeWalks, "begin", beginning, bidirectional, block)    /* walk_paths.cpp */                           \
  STAGE(beginLightWalks, "begin", beginning, bidirectional, block)  /* walk_paths.cpp */                           \
  STAGE(walkPaths, "walk", live, bidirectional, block)              /* walk_paths.cpp */                           \
  STAGE(recordMisses, "miss", live, bidirectional, one)             /* record_walks.cpp */                         \
  STAGE(recordPathVertices, "record", live, bidirectional, block)   /* record_walks.cpp */                         \
  STAGE(joinPaths, "join", beginning, bidirectional, block)         /* join_paths.cpp */                           \
  STAGE(evaluatePaths, "evaluate", beginning, bidirectional, block) /* evaluate_paths.cpp */                       \
  STAGE(weighPaths, "weigh", beginning, common, block)              /* weigh_paths.cpp */                          \
  STAGE(commitPaths, "commit", beginning, common, block)            /* weigh_paths.cpp */

// The stages of the catalogue, and two names for what the scene's intersector offers.
enum class StageId : uint8_t {
#define WAVECREST_STAGE_ID(NAME, ...) NAME,
  WAVECREST_STAGE_CATALOGUE(WAVECREST_STAGE_ID)
#undef WAVECREST_STAGE_ID
      extend,
  occlude,
};

struct StageInfo {
  StageId id;
  std::string_view name;   // the identifier
  std::string_view title;  // in --stats
  StageItems items;
  StageFamily family;
  bool single;  // items one by one
};

inline constexpr auto kStageCatalogue = std::to_array<StageInfo>({
#define WAVECREST_STAGE_INFO(NAME, TITLE, ITEMS, FAMILY, LANES) \
  {StageId::NAME, #NAME, TITLE, StageItems::ITEMS, StageFamily::FAMILY, #LANES[0] == 'o'},
    WAVECREST_STAGE_CATALOGUE(WAVECREST_STAGE_INFO)
#undef WAVECREST_STAGE_INFO
});

// What any intersector's stages share.
constexpr const StageInfo& infoOf(StageId id) {
  if (id == StageId::extend) id = StageId::extendSmall;
  if (id == StageId::occlude) id = StageId::occludeSmall;
  return kStageCatalogue[static_cast<size_t>(id)];
}

}  // namespace wavecrest
