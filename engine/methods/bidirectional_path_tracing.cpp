// Bidirectional path tracing (Veach and Guibas 1994; Lafortune and Willems 1993): every way to join a light path and a
// camera path. A wave's light paths are joined with the camera paths of the same wave, so nothing outlives a wave.
#include "engine/methods/method_list.h"

namespace wavecrest {

MethodPage bidirectionalPathTracing() {
  using enum StageId;
  return {{
      walk(Walk::light, generateLightPaths, {extend, arrive, storeLightVertices, connectToCamera, occlude, scatter}),
      walk(Walk::camera, generateCameraPaths,
           {extend, arrive, nextEvent, occlude, untilJoined{connectVertices, occlude}, scatter}),
  }};
}

}  // namespace wavecrest
