// Metropolis light transport: chains advanced in lockstep, whose state is the random numbers of a path (primary sample
// space, Kelemen et al. 2002) or the path itself, through the stages of other methods. The phases up to acceptMutations
// trace a proposal; acceptMutations and what follows decide about it.
#include "engine/methods/method_list.h"

namespace wavecrest {

// pssmlt: over path tracing, a path of it being one sample.
MethodPage primarySampleSpace() {
  using enum StageId;
  return {{
      once({proposeMutations}),
      walk(Walk::camera, generateCameraPaths, {extend, arrive, recordVertices, nextEvent, occlude, scatter}),
      once({acceptMutations}),
  }};
}

// mmlt: over bidirectional path tracing (Hachisuka et al., "Multiplexed Metropolis Light Transport", 2014). A chain's
// paths have one length; a primary sample picks the strategy, so a proposal is one pair of walks and one connection of
// their ends, weighted against the other strategies as ever. Direct light may be left to path tracing: it is what
// chains are least needed for, and where a lamp in view is bright and small, most of the error of b.
MethodPage multiplexedMetropolis() {
  using enum StageId;
  return {{
              once({proposeMutations}),
              walk(Walk::camera, generateCameraPaths, {admitWalks, extend, arrive, takeEnds, scatter},
                   {extend, arrive, takeEnds, scatter}),
              atEnds(EndsOf::atOrigin, Walk::camera, 0, {nextEvent, occlude}),
              walk(Walk::light, generateLightPaths, {extend, arrive, takeEnds, scatter}),
              atEnds(EndsOf::lightAtVertex, Walk::light, 1, {storeLightVertices}),
              atEnds(EndsOf::atOrigin, Walk::light, 1, {connectToCamera, occlude}),
              atEnds(EndsOf::cameraAtVertex, Walk::camera, 1, {connectVertices, occlude}),
              once({acceptMutations}),
          },
          {*pathTracing().walk(Walk::camera)}};
}

// pathspace: chains of paths themselves (Veach and Guibas, "Metropolis Light Transport", 1997). A proposal replaces
// part of a path by two walks and what joins them; how it was made says nothing about its contribution, which follows
// from its vertices. The stages of the walks know no weights: the strategies that could have made a path are summed up
// when it is weighed.
MethodPage pathSpaceMetropolis() {
  using enum StageId;
  return {{
              once({proposePaths}),
              walk(Walk::camera, beginEyeWalks, {extend, recordMisses, arrive, recordPathVertices, walkPaths}),
              walk(Walk::light, beginLightWalks, {extend, arrive, recordPathVertices, walkPaths}),
              once({joinPaths, occlude, evaluatePaths, weighPaths}),
              once({acceptMutations, commitPaths}),
          },
          {*pathTracing().walk(Walk::camera)}};
}

}  // namespace wavecrest
