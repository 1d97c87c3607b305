// `wavecrest compare --html`: one page that opens offline, with the scores of all tests side by side, their images and
// the maps of all metrics.
#pragma once

#include <string>
#include <vector>

#include "cli/compare_results.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

// The page. Every score has its map.
std::string comparePage(const PreparedReference& reference, const std::vector<MeasuredTest>& tests);

}  // namespace wavecrest
