#include "bench/report/write_report.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "bench/report/collect.h"
#include "bench/report/csv.h"
#include "bench/report/html_page.h"
#include "bench/report/plot_files.h"
#include "bench/report/results_folder.h"
#include "bench/report/scene_section.h"
#include "bench/report/series_values.h"
#include "bench/results/within_folder.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Writes folder / name, and returns that.
fs::path write(const fs::path& folder, const char* name, const std::string& text) {
  fs::path path = withinFolder(folder, name);
  writeFileAtomically(path.string(), text);
  return path;
}

// Throws ResultsError unless a baseline, if any is named, is in the report.
void requireBaseline(const ConvergenceReport& report, const std::string& baseline) {
  if (baseline.empty() || findSeriesName(report, baseline)) return;
  std::vector<std::string> known;
  for (const SeriesName& name : seriesNamesOf(report)) known.push_back(name.label);
  throw ResultsError(
      fmt::format("--baseline {}: is not in the report; expected one of {}", baseline, fmt::join(known, ", ")));
}

}  // namespace

WrittenReport writeReport(std::span<const fs::path> paths, const ReportFiles& files) {
  ConvergenceReport report = collectReport(paths, files.reference);
  requireBaseline(report, files.baseline);
  report.baseline = files.baseline;
  const fs::path folder = fs::is_directory(paths[0]) ? paths[0] : paths[0].parent_path();
  std::vector<fs::path> written{write(folder, "report.html", renderReport(report))};
  // The light behind the pictures, which the page reads when somebody asks for it. What an earlier report left goes.
  std::error_code ignored;
  fs::remove_all(withinFolder(folder, "report.floats"), ignored);
  for (const auto& [name, script] : floatFiles(report)) {
    fs::create_directories(withinFolder(folder, name).parent_path());
    write(folder, name.c_str(), script);
  }
  if (files.csv) {
    const std::pair<const char*, std::string> tables[] = {{"measurements.csv", measurementsAsCsv(report)},
                                                          {"summary.csv", summaryAsCsv(report)},
                                                          {"times.csv", timesAsCsv(report)},
                                                          {"claims.csv", claimsAsCsv(report)}};
    for (const auto& [name, table] : tables) written.push_back(write(folder, name, table));
  }
  if (files.plots) {
    const std::vector<fs::path> plots = writePlotFiles(report, withinFolder(folder, "plots"));
    written.insert(written.end(), plots.begin(), plots.end());
  }
  return {.files = std::move(written), .claims = std::move(report.claims)};
}

}  // namespace wavecrest
