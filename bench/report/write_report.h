// From results to the files of a report.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

struct ReportFiles {
  bool csv = false;  ///< measurements.csv: every measurement; summary.csv: series at their ends; times.csv; claims.csv
  bool plots = false;                    ///< plots/SCENE.METRIC.svg
  std::string baseline = {};             ///< method that speed-ups are over; empty: the first of the report
  std::filesystem::path reference = {};  ///< what a folder of renders is measured against; empty: what it has itself
};

struct WrittenReport {
  std::vector<std::filesystem::path> files;
  std::vector<ReportClaim> claims;  ///< as the page shows them
};

/// Writes report.html with the floats of its images in report.floats, and what else is asked for, into the folder of
/// the first path; `files` of the result are without the floats. Errors as collectReport, and ImageError if a file
/// cannot be written.
WrittenReport writeReport(std::span<const std::filesystem::path> paths, const ReportFiles& files = {});

}  // namespace wavecrest
