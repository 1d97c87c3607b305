// Light tracing: strategy t = 1 alone. A pinhole sees no specular surface that way, so a camera walk adds the paths
// whose vertex next to the lens is specular, by path tracing from there on. The two walks share no path.
#include "engine/methods/method_list.h"

namespace wavecrest {

MethodPage lightTracing() {
  using enum StageId;
  return {{
      walk(Walk::light, generateLightPaths, {extend, arrive, connectToCamera, occlude, scatter}),
      walk(Walk::camera, generateCameraPaths, {extend, arrive, scatterSpecular},
           {extend, arrive, nextEvent, occlude, scatter}),
  }};
}

}  // namespace wavecrest
