// Bidirectional path tracing (Veach and Guibas 1994; Lafortune and Willems 1993): every way to join a light path and a
// camera path. A wave's light paths are joined with the camera paths of the same wave, so nothing outlives a wave.
#include "engine/methods/method_list.h"

namespace wavecrest {

template <class S>
Pipeline<S> bidirectionalPathTracing(const Stages<S>& stages, const Intersector<S>& intersector) {
  constexpr MisSettings kAll{.emission = true, .nextEvent = true, .connect = true, .camera = true};
  return {
      .lightPass =
          Pass<S>{
              .walk = Walk::light,
              .strategies = kAll,
              .generate = {"generate light", stages.generateLightPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend light", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive light", stages.arrive, pathItems<S>, stages.lanes},
                      {"store", stages.storeLightVertices, joinableItems<S>, stages.lanes},
                      {"connect to camera", stages.connectToCamera, joinableItems<S>, stages.lanes},
                      {"occlude light", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"scatter light", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kAll,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive", stages.arrive, pathItems<S>, stages.lanes},
                      {"next event", stages.nextEvent, joinableItems<S>, stages.lanes},
                      {"occlude", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"connect", stages.connectVertices, joinableItems<S>, stages.lanes, Repeat::untilJoined},
                      {"occlude connection", intersector.occlude, shadowItems<S>, intersector.lanes,
                       Repeat::untilJoined},
                      {"scatter", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
  };
}
template Pipeline<float> bidirectionalPathTracing(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> bidirectionalPathTracing(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
