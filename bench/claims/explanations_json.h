// The text of bench/claims/explanations.json, made a string at build time by cmake/embed_text.cmake.
#pragma once

#include <string_view>

namespace wavecrest {

extern const std::string_view kExplanationsJson;

}  // namespace wavecrest
