// Results of sweeps as JSON, and as a page with a plot for each.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/extremes/sweep.h"

namespace wavecrest {

nlohmann::ordered_json toJson(const SweepResult& result);

// One line for each row that fails, and one for the sweep.
std::string toText(const SweepResult& result);

// The whole document, with nothing outside of itself.
std::string extremesPage(const std::vector<SweepResult>& results);

}  // namespace wavecrest
