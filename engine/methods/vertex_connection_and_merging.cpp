// Vertex connection and merging (Georgiev et al. 2012; Hachisuka et al. 2012): bidirectional path tracing and photon
// mapping as strategies of one estimator.
#include "engine/methods/method_list.h"

namespace wavecrest {

MethodPage vertexConnectionAndMerging() {
  using enum StageId;
  return {{
      walk(Walk::light, generateLightPaths, {extend, arrive, storeLightVertices, connectToCamera, occlude, scatter}),
      buildPhotonMap(),
      walk(Walk::camera, generateCameraPaths,
           {extend, arrive, nextEvent, occlude, untilJoined{connectVertices, occlude}, merge, scatter}),
  }};
}

}  // namespace wavecrest
