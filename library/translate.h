// Exceptions of the engine, the metrics and the rest as the library's own, with their kind, file and line.
#pragma once

#include <utility>

#include "wavecrest/error.h"

namespace wavecrest {

// The exception being handled, as the library throws it. To be called in a catch block. The program's exit codes follow
// from its kind.
api::Error currentError();

// What function returns. Whatever it throws leaves as api::Error.
template <class Function>
decltype(auto) translated(Function&& function) {
  try {
    return std::forward<Function>(function)();
  } catch (...) {
    throw currentError();
  }
}

}  // namespace wavecrest
