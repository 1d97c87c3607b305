// The golden files as JSON, for what is more than a number of a pair (golden.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace wavecrest::test {

nlohmann::json goldenJson(const std::string& name);

// All figures of one pair in one golden file.
nlohmann::json goldenFigures(const std::string& file, const std::string& pair);

}  // namespace wavecrest::test
