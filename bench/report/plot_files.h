// The plots of a report as SVG files of their own, for papers and slides.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Writes FOLDER/SCENE.METRIC.svg for each, creating the folder; returns their paths. SCENE gets a number where an
/// earlier scene's is the same but for capitals. Throws ImageError if a file cannot be written.
std::vector<std::filesystem::path> writePlotFiles(const ConvergenceReport& report, const std::filesystem::path& folder);

}  // namespace wavecrest
