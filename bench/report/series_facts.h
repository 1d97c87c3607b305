// What a series of runs is told to have cost and how it was made, from the JSON of `render --stats` of its runs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Fills pathsPerSecond, cpuSeconds and settings of a series from the stats of its runs, one for each.
void addSeriesFacts(ReportSeries& series, const std::vector<const nlohmann::json*>& stats);

/// Adds the items and seconds of a stage to that of the same name.
void addStage(std::vector<ReportStage>& sums, const ReportStage& stage);

/// The distinct values of a key over several objects, in order of appearance, as "1, 2, 3"; nothing is added if none
/// has it.
void addDistinct(std::vector<NamedValue>& shown, const std::vector<const nlohmann::json*>& objects, const char* key);

/// Adds, once, that errors of chains from few seeds mislead, where the scene has such a series.
void addChainsRemark(std::vector<std::string>& remarks, const ReportScene& scene);

}  // namespace wavecrest
