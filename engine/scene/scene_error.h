// A scene that was read but cannot be rendered: the fault is in the input, not in the program.
#pragma once

#include <stdexcept>
#include <string>

#include "engine/scene/scene.h"

namespace wavecrest {

// what() reads "FILE:LINE: what is wrong; what was expected".
class SceneError : public std::runtime_error {
 public:
  SceneError(const SourceLocation& where, const std::string& message)
      : std::runtime_error(where.file + ":" + std::to_string(where.line) + ": " + message), location(where) {}

  SourceLocation location;
};

}  // namespace wavecrest
