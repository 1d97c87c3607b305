// Path tracing with next event estimation (Kajiya 1986; Veach 1997, 10.2): strategies s = 0 and s = 1, weighted by the
// power heuristic.
#include "engine/methods/method_list.h"

namespace wavecrest {

MethodPage pathTracing() {
  using enum StageId;
  return {{walk(Walk::camera, generateCameraPaths, {extend, arrive, nextEvent, occlude, scatter})}};
}

}  // namespace wavecrest
