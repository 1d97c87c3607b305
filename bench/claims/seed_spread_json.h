// The text of bench/claims/seed_spread.json, made a string at build time by cmake/embed_text.cmake.
#pragma once

#include <string_view>

namespace wavecrest {

extern const std::string_view kSeedSpreadJson;

}  // namespace wavecrest
