// What errors against a biased reference are worth.
#pragma once

#include <string>

#include "engine/methods/method_list.h"

namespace wavecrest {

// Said wherever errors are against a reference that is biased (ReferenceChoice of engine/inspect/path_classes.h).
inline std::string referenceBlurs(Method method) {
  return "the reference is by " + std::string(toString(method)) + ", which blurs";
}

}  // namespace wavecrest
