// Vertex connection and merging (Georgiev et al. 2012; Hachisuka et al. 2012): bidirectional path tracing and photon
// mapping as strategies of one estimator.
#include "engine/methods/method_list.h"

namespace wavecrest {

template <class S>
Pipeline<S> vertexConnectionAndMerging(const Stages<S>& stages, const Intersector<S>& intersector) {
  constexpr MisSettings kAll{.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true};
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
      .photonMap = true,
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
                      {"merge", stages.merge, pathItems<S>},
                      {"scatter", stages.scatter, pathItems<S>},
                  },
          },
  };
}
template Pipeline<float> vertexConnectionAndMerging(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> vertexConnectionAndMerging(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
