// Photon mapping with a radius that shrinks over the iterations (Knaus and Zwicker 2011): merging stands alone.
//
// ppm: a camera path merges at its first vertex with more than delta lobes and goes on by delta lobes only, so each
// path is made once and needs no weight (Hachisuka and Jensen 2009). bpm: it merges at every such vertex and goes on by
// all lobes; weights share each path among the vertices where it could have been merged (Vorba 2011).
#include "engine/methods/method_list.h"

namespace wavecrest {
namespace {

template <class S>
Pipeline<S> photonMapping(const Stages<S>& stages, const Intersector<S>& intersector, bool everyVertex) {
  const MisSettings merging{.emission = false, .nextEvent = false, .merge = true, .mergeWeights = everyVertex};
  return {
      .lightPass =
          Pass<S>{
              .walk = Walk::light,
              .strategies = merging,
              .generate = {"generate light", stages.generateLightPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend light", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive light", stages.arrive, pathItems<S>, stages.lanes},
                      {"store", stages.storeLightVertices, joinableItems<S>, stages.lanes},
                      {"scatter light", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
      .photonMap = true,
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = merging,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive", stages.arrive, pathItems<S>, stages.lanes},
                      {"merge", stages.merge, joinableItems<S>, stages.lanes},
                      {"scatter", everyVertex ? stages.scatter : stages.scatterSpecular, pathItems<S>, stages.lanes},
                  },
          },
  };
}

}  // namespace

template <class S>
Pipeline<S> progressivePhotonMapping(const Stages<S>& stages, const Intersector<S>& intersector) {
  return photonMapping(stages, intersector, false);
}
template Pipeline<float> progressivePhotonMapping(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> progressivePhotonMapping(const Stages<double>&, const Intersector<double>&);

template <class S>
Pipeline<S> bidirectionalPhotonMapping(const Stages<S>& stages, const Intersector<S>& intersector) {
  return photonMapping(stages, intersector, true);
}
template Pipeline<float> bidirectionalPhotonMapping(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> bidirectionalPhotonMapping(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
