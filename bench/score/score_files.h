// The texts of bench/score/*.json, made strings at build time by cmake/embed_text.cmake.
#pragma once

#include <string_view>

namespace wavecrest {

extern const std::string_view kImageHashesJson;
extern const std::string_view kImagePicturesJson;
extern const std::string_view kReferenceMachineJson;

}  // namespace wavecrest
