// A scene that was read but cannot be rendered: the fault is in the input, not in the program.
#pragma once

#include <stdexcept>
#include <string>

#include "engine/scene/scene.h"

namespace wavecrest {

// "FILE:LINE", or of the whole file, as which line 0 counts, "FILE".
inline std::string toString(const SourceLocation& where) {
  return where.line == 0 ? where.file : where.file + ":" + std::to_string(where.line);
}

// FILE:LINE: what the file says (how often, if more than once): what wavecrest does.
inline std::string toString(const Note& note) {
  const std::string more = note.count > 1 ? " (" + std::to_string(note.count) + " times)" : "";
  return toString(note.source) + ": " + note.what + more + ": " + note.effect;
}

// what() reads "FILE:LINE: what is wrong; what was expected".
class SceneError : public std::runtime_error {
 public:
  SceneError(const SourceLocation& where, const std::string& message)
      : std::runtime_error(toString(where) + ": " + message), location(where) {}

  SourceLocation location;
};

}  // namespace wavecrest
