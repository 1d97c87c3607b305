#include "engine/methods/method_list.h"

#include <stdexcept>

namespace wavecrest {

std::string methodChoices() {
  std::string choices;
  for (const MethodEntry& entry : kMethods) choices += (choices.empty() ? "" : ", ") + std::string(entry.name);
  return choices;
}

template <class S>
Pipeline<S> makePipeline(Method method, MetropolisVariant variant, const Stages<S>& stages,
                         const Intersector<S>& intersector) {
  switch (method) {
    case Method::pt:
      return pathTracing(stages, intersector);
    case Method::lt:
      return lightTracing(stages, intersector);
    case Method::bpt:
      return bidirectionalPathTracing(stages, intersector);
    case Method::mlt:
      if (variant == MetropolisVariant::pssmlt) return primarySampleSpace(stages, intersector);
      if (variant == MetropolisVariant::mmlt) return multiplexedMetropolis(stages, intersector);
      return pathSpaceMetropolis(stages, intersector);
    case Method::ppm:
      return progressivePhotonMapping(stages, intersector);
    case Method::bpm:
      return bidirectionalPhotonMapping(stages, intersector);
    case Method::vcm:
      return vertexConnectionAndMerging(stages, intersector);
  }
  throw std::invalid_argument("makePipeline: a method without a pipeline");
}
template Pipeline<float> makePipeline(Method, MetropolisVariant, const Stages<float>&, const Intersector<float>&);
template Pipeline<double> makePipeline(Method, MetropolisVariant, const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
