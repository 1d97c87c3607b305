// Light tracing: strategy t = 1 alone. A pinhole sees no specular surface that way, so a camera pass adds the paths
// whose vertex next to the lens is specular, by path tracing from there on; the two passes share no path.
#include "engine/methods/method_list.h"

namespace wavecrest {

template <class S>
Pipeline<S> lightTracing(const Stages<S>& stages, const Intersector<S>& intersector) {
  return {
      .lightPass =
          Pass<S>{
              .walk = Walk::light,
              .strategies = {.emission = false, .nextEvent = false, .camera = true},
              .generate = {"generate light", stages.generateLightPaths, generatedItems<S>, stages.lanes},
              .perDepth =
                  {
                      {"extend light", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive light", stages.arrive, pathItems<S>, stages.lanes},
                      {"connect to camera", stages.connectToCamera, joinableItems<S>, stages.lanes},
                      {"occlude light", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"scatter light", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
      .cameraPass =
          {
              .walk = Walk::camera,
              .strategies = kPathTracingStrategies,
              .generate = {"generate", stages.generateCameraPaths, generatedItems<S>, stages.lanes},
              .firstDepth =
                  {
                      {"extend first", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive first", stages.arrive, pathItems<S>, stages.lanes},
                      {"scatter specular", stages.scatterSpecular, pathItems<S>, stages.lanes},
                  },
              .perDepth =
                  {
                      {"extend", intersector.extend, pathItems<S>, intersector.lanes},
                      {"arrive", stages.arrive, pathItems<S>, stages.lanes},
                      {"next event", stages.nextEvent, joinableItems<S>, stages.lanes},
                      {"occlude", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"scatter", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
  };
}
template Pipeline<float> lightTracing(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> lightTracing(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
