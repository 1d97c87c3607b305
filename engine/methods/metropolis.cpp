// Metropolis light transport: chains advanced in lockstep, whose state is the random numbers of a path (primary sample
// space, Kelemen et al. 2002) or the path itself, through the stages of other methods.
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
                      {"next event", stages.nextEvent, joinableItems<S>, stages.lanes},
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
      {{"next event", stages.nextEvent, joinableItems<S>, stages.lanes}, EndsOf::atOrigin, Walk::camera, 0},
      {{"occlude", intersector.occlude, shadowItems<S>, intersector.lanes}, EndsOf::atOrigin, Walk::camera, 0},
  };
  chains.afterLight = {
      {{"store", stages.storeLightVertices, joinableItems<S>, stages.lanes}, EndsOf::lightAtVertex, Walk::light, 1},
      {{"connect to camera", stages.connectToCamera, joinableItems<S>, stages.lanes}, EndsOf::atOrigin, Walk::light, 1},
      {{"occlude light", intersector.occlude, shadowItems<S>, intersector.lanes}, EndsOf::atOrigin, Walk::light, 1},
      {{"connect", stages.connectVertices, joinableItems<S>, stages.lanes}, EndsOf::cameraAtVertex, Walk::camera, 1},
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

// pathspace: chains of paths themselves (Veach and Guibas, "Metropolis Light Transport", 1997). A proposal replaces
// part of a path by two walks and what joins them; how it was made says nothing about its contribution, which follows
// from its vertices. The stages of the walks know no weights: the strategies that could have made a path are summed up
// when it is weighed.
template <class S>
Pipeline<S> pathSpaceMetropolis(const Stages<S>& stages, const Intersector<S>& intersector) {
  constexpr MisSettings kNoStrategies{.emission = false, .nextEvent = false};
  const StageCall<S> extend{"extend", intersector.extend, pathItems<S>, intersector.lanes},
      arrive{"arrive", stages.arrive, pathItems<S>, stages.lanes},
      record{"record", stages.recordPathVertices, pathItems<S>, stages.lanes},
      walk{"walk", stages.walkPaths, pathItems<S>, stages.lanes};
  ChainCalls<S> chains = decisions(stages);
  chains.propose.run = stages.proposePaths;
  chains.weigh = {
      {"join", stages.joinPaths, generatedItems<S>, stages.lanes},
      {"occlude", intersector.occlude, shadowItems<S>, intersector.lanes},
      {"evaluate", stages.evaluatePaths, generatedItems<S>, stages.lanes},
      {"weigh", stages.weighPaths, generatedItems<S>, stages.lanes},
  };
  chains.commit = {{"commit", stages.commitPaths, generatedItems<S>, stages.lanes}};
  chains.directPass = pathTracing(stages, intersector).cameraPass;
  return {
      .lightPass =
          Pass<S>{
              .walk = Walk::light,
              .strategies = kNoStrategies,
              .generate = {"begin light", stages.beginLightWalks, generatedItems<S>, stages.lanes},
              .perDepth = {extend, arrive, record, walk},
          },
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kNoStrategies,
              .generate = {"begin", stages.beginEyeWalks, generatedItems<S>, stages.lanes},
              .perDepth = {extend, {"miss", stages.recordMisses, pathItems<S>, 1}, arrive, record, walk},
          },
      .chains = std::move(chains),
  };
}
template Pipeline<float> pathSpaceMetropolis(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> pathSpaceMetropolis(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
