// Scenes with one sphere of a BSDF, for tests of how BSDFs are read.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "tests/load/scene_file.h"

namespace wavecrest {

inline Scene sceneWith(std::string_view bsdf) {
  return loadBody("<shape type=\"sphere\">" + std::string(bsdf) + "</shape>");
}
inline Material materialOf(std::string_view bsdf) { return sceneWith(bsdf).materials.at(0); }
template <class Kind>
Kind kindOf(std::string_view bsdf) {
  return std::get<Kind>(materialOf(bsdf).kind);
}
inline void expectBsdfError(std::string_view bsdf, std::string_view text) {
  expectErrorOnLine2("<shape type=\"sphere\">" + std::string(bsdf) + "</shape>", text);
}

}  // namespace wavecrest
