// Exceptions of the engine, the metrics and the rest as the library's own, with their kind, file and line.
#pragma once

#include <string>
#include <utility>

#include "engine/load/load.h"
#include "wavecrest/error.h"

namespace wavecrest {

// The exception being handled, as the library throws it. To be called in a catch block. The program's exit codes follow
// from its kind.
api::Error currentError();

// The error's text, and how to get the file that is missing or which built-in scene may be meant.
std::string textOf(const MissingFileError& error);

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
