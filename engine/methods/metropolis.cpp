// Metropolis light transport in primary sample space (Kelemen et al. 2002): chains whose state is the random numbers of
// a path, advanced in lockstep through the stages of another method.
#include "engine/methods/method_list.h"

namespace wavecrest {
namespace {

template <class S>
ChainCalls<S> decisions(const Stages<S>& stages) {
  return {.propose = {"propose", stages.proposeMutations, generatedItems<S>, stages.lanes},
          .accept = {"accept", stages.acceptMutations, generatedItems<S>, stages.lanes}};
}

}  // namespace

// pssmlt: over path tracing, a path of it being one sample.
template <class S>
Pipeline<S> primarySampleSpace(const Stages<S>& stages, const Intersector<S>& intersector) {
  return {
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kPathTracingStrategies,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive", stages.arrive, pathItems<S>, stages.lanes},
                      {"record", stages.recordVertices, pathItems<S>, 1},
                      {"next event", stages.nextEvent, pathItems<S>, stages.lanes},
                      {"occlude", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"scatter", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
      .chains = decisions(stages),
  };
}
template Pipeline<float> primarySampleSpace(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> primarySampleSpace(const Stages<double>&, const Intersector<double>&);

// mmlt: over bidirectional path tracing (Hachisuka et al., "Multiplexed Metropolis Light Transport", 2014). A chain's
// paths have one length; a primary sample picks the strategy, so a proposal is one pair of walks and one connection,
// weighted against the other strategies as ever. Direct light may be left to path tracing: it is what chains are least
// needed for, and where a lamp in view is bright and small, most of the error of b.
template <class S>
Pipeline<S> multiplexedMetropolis(const Stages<S>& stages, const Intersector<S>& intersector) {
  constexpr MisSettings kAll{.emission = true, .nextEvent = true, .connect = true, .camera = true};
  const std::vector<StageCall<S>> walk{
      {"extend", intersector.extend, pathItems<S>, intersector.lanes},
      {"arrive", stages.arrive, pathItems<S>, stages.lanes},
      {"take ends", stages.takeEnds, pathItems<S>, stages.lanes},
      {"scatter", stages.scatter, pathItems<S>, stages.lanes},
  };
  std::vector<StageCall<S>> first = walk;
  first.insert(first.begin(), {"admit", stages.admitWalks, pathItems<S>, stages.lanes});
  ChainCalls<S> chains = decisions(stages);
  chains.afterCamera = {
      {{"next event", stages.nextEvent, pathItems<S>, stages.lanes}, EndsOf::atOrigin, Walk::camera, 0},
      {{"occlude", intersector.occlude, shadowItems<S>, intersector.lanes}, EndsOf::atOrigin, Walk::camera, 0},
  };
  chains.afterLight = {
      {{"store", stages.storeLightVertices, pathItems<S>, stages.lanes}, EndsOf::lightAtVertex, Walk::light, 1},
      {{"connect to camera", stages.connectToCamera, pathItems<S>, stages.lanes}, EndsOf::atOrigin, Walk::light, 1},
      {{"occlude light", intersector.occlude, shadowItems<S>, intersector.lanes}, EndsOf::atOrigin, Walk::light, 1},
      {{"connect", stages.connectVertices, pathItems<S>, stages.lanes}, EndsOf::cameraAtVertex, Walk::camera, 1},
      {{"occlude connection", intersector.occlude, shadowItems<S>, intersector.lanes},
       EndsOf::cameraAtVertex,
       Walk::camera,
       1},
  };
  chains.directPass = pathTracing(stages, intersector).cameraPass;
  return {
      .lightPass =
          Pass<S>{
              .walk = Walk::light,
              .strategies = kAll,
              .generate = {"generate light", stages.generateLightPaths, generatedItems<S>, stages.lanes},
              .perDepth = walk,
          },
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kAll,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>, stages.lanes},
              .firstDepth = first,
              .perDepth = walk,
          },
      .chains = std::move(chains),
  };
}
template Pipeline<float> multiplexedMetropolis(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> multiplexedMetropolis(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
