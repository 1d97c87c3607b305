// Makes a report's data from whatever holds results: a campaign's results file, the results files of its shards, or a
// folder of renders.
#pragma once

#include <filesystem>
#include <span>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Folders stand for the results file in them; a single folder without one is a folder of renders, or of
/// images of other programs, and a CSV file a list of those. reference: of a folder of renders, in place of its own.
/// Throws ResultsFileError, ResultsError or ImageError if there is something that no report can be made of.
ConvergenceReport collectReport(std::span<const std::filesystem::path> paths,
                                const std::filesystem::path& reference = {});

}  // namespace wavecrest
