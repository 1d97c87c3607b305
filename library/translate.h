// Exceptions of the engine, the metrics and the rest as the library's own, with their kind, file and line.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "engine/load/load.h"
#include "wavecrest/error.h"

namespace wavecrest {

// The exception being handled, as the library throws it. To be called in a catch block.
api::Error currentError();

// The error's text, and how to get the file that is missing or which built-in scene may be meant.
std::string textOf(const MissingFileError& error);
// The file or folder, what the system says of it, and what was expected.
std::string textOf(const std::filesystem::filesystem_error& error);
// Of JSON that is none, or has not the keys and types that it is read for.
constexpr const char* kForeignJson = "JSON of an input is not as wavecrest writes it; expected it unchanged";

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
