// From results to the files of a report.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace wavecrest {

struct ReportFiles {
  bool csv = false;    ///< measurements.csv: every measurement
  bool plots = false;  ///< plots/SCENE.METRIC.svg
};

/// Writes report.html, and what else is asked for, into the folder of the first path; returns the files. Errors as
/// collectReport, and ImageError if a file cannot be written.
std::vector<std::filesystem::path> writeReport(std::span<const std::filesystem::path> paths,
                                               const ReportFiles& files = {});

}  // namespace wavecrest
