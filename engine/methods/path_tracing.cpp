// Path tracing with next event estimation: strategies s = 0 and s = 1, weighted by the power heuristic.
#include "engine/methods/method_list.h"

namespace wavecrest {

template <class S>
Pipeline<S> pathTracing(const Stages<S>& stages, const Intersector<S>& intersector) {
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
                      {"next event", stages.nextEvent, joinableItems<S>, stages.lanes},
                      {"occlude", intersector.occlude, shadowItems<S>, intersector.lanes},
                      {"scatter", stages.scatter, pathItems<S>, stages.lanes},
                  },
          },
  };
}
template Pipeline<float> pathTracing(const Stages<float>&, const Intersector<float>&);
template Pipeline<double> pathTracing(const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
