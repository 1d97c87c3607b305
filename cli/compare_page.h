// `wavecrest compare --html`: one page that opens offline, with the scores of all tests side by side, their images and
// the maps of all metrics.
#pragma once

#include <string>
#include <vector>

#include "cli/compare_results.h"

namespace wavecrest {

// The page. Every score has its map. exposure: stops, of the codes.
std::string comparePage(const std::string& referenceFile, const ComparedImage& reference,
                        const std::vector<MeasuredTest>& tests, double exposure);

}  // namespace wavecrest
