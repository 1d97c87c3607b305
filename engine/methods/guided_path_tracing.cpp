// Path tracing that learns where its light comes from (Mueller, Gross, Novak 2017; Rath et al. 2020): directions are
// drawn from the BSDF or from a guide, which follows from all earlier blocks of iterations.
#include "engine/methods/method_list.h"

namespace wavecrest {

MethodPage guidedPathTracing() {
  using enum StageId;
  return {{
      walk(Walk::camera, generateCameraPaths, {extend, arrive, findCells, nextEvent, occlude, scatter}),
      learn(Fold::guide),
  }};
}

}  // namespace wavecrest
