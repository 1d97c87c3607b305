// The first page of a report: which method is best where, over all scenes.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Heat maps of scenes x methods, one for each metric and for the time to its target. For several scenes.
std::string renderHeatMaps(const ConvergenceReport& report);

/// Methods in the order of their mean rank over scenes and metrics. For several scenes.
std::string renderRanking(const ConvergenceReport& report);

/// The study's findings with verdicts; empty text if there are none.
std::string renderClaims(const ConvergenceReport& report);

}  // namespace wavecrest
