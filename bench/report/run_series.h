// The runs of one scene by series: which of them differ by nothing but the seed, what a series is called, and where its
// seeds meet.
#pragma once

#include <string>
#include <vector>

#include "bench/report/results_folder.h"
#include "metrics/image/image_io.h"

namespace wavecrest {

/// What tells series of a method apart, as stats have it, from the attributes of an image that says it of itself; empty
/// of other programs' images.
nlohmann::json seriesSettings(const Metadata& metadata);

/// Groups runs by method and settings, in order of first appearance. Throws ResultsError if a group has a seed twice:
/// its runs would count as independent.
std::vector<std::vector<RunFile*>> groupBySettings(const std::vector<RunFile*>& runs);

/// The method, and where several series share it what tells them apart: words as they are, numbers and switches with
/// the setting's name.
std::string seriesLabel(const std::vector<std::vector<RunFile*>>& groups, const RunFile& run);

/// Numbers the snapshots of a series, as curves are means over the snapshots of one number: by time, unless those of
/// each number that the stats give are of about the same time, or of equally many iterations.
void numberSnapshots(const std::vector<RunFile*>& series);

/// What a reader must know of a series whose runs end at different times; empty if they end together.
std::string remarkOnEnds(const std::vector<RunFile*>& series, const std::string& label);

}  // namespace wavecrest
