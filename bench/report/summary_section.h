// The first page of a report: which method is best where, over all scenes.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Heat maps of scenes x methods of the time to the target of each metric that has one. For several scenes.
std::string renderTargetMaps(const ConvergenceReport& report);

/// Heat maps of scenes x methods, one for each metric. For several scenes.
std::string renderHeatMaps(const ConvergenceReport& report);

/// Methods in the order of their mean rank over scenes by the first metric, with their ranks by the others. For several
/// scenes.
std::string renderRanking(const ConvergenceReport& report);

/// The study's findings that the results can judge, with verdicts; empty text if there are none at all.
std::string renderClaims(const ConvergenceReport& report);

}  // namespace wavecrest
