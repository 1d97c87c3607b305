// Which method renders a scene's reference, by the rule of the study (METHODS 8.3).
#pragma once

#include <string>

#include "engine/methods/method_list.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct ReferenceMethod {
  Method method{};
  std::string reason;  // one line
};

ReferenceMethod referenceMethod(const Scene& scene);

}  // namespace wavecrest
