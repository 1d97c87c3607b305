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
              .generate = {"generate light", stages.generateLightPaths, generatedItems<S>},
              .perDepth =
                  {
                      {"extend light", intersector.extend, pathItems<S>},
                      {"arrive light", stages.arrive, pathItems<S>},
                      {"store", stages.storeLightVertices, pathItems<S>},
                      {"connect to camera", stages.connectToCamera, pathItems<S>},
                      {"occlude light", intersector.occlude, shadowItems<S>},
                      {"scatter light", stages.scatter, pathItems<S>},
                  },
          },
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kAll,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>},
              .perDepth =
                  {
                      {"extend", intersector.extend, pathItems<S>},
                      {"arrive", stages.arrive, pathItems<S>},
                      {"next event", stages.nextEvent, pathItems<S>},
                      {"occlude", intersector.occlude, shadowItems<S>},
                      {"connect", stages.connectVertices, pathItems<S>, Repeat::perLightDepth},
                      {"occlude connection", intersector.occlude, shadowItems<S>, Repeat::perLightDepth},
                      {"scatter", stages.scatter, pathItems<S>},
                  },
          },
  };
}
template Pipeline<float> bidirectionalPathTracing(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> bidirectionalPathTracing(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
