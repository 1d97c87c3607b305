#include "bench/report/write_report.h"

#include <string>
#include <utility>

#include "bench/report/collect.h"
#include "bench/report/csv.h"
#include "bench/report/html_page.h"
#include "bench/report/plot_files.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { writeFileAtomically(path.string(), text); }

}  // namespace

WrittenReport writeReport(std::span<const fs::path> paths, const ReportFiles& files) {
  ConvergenceReport report = collectReport(paths, files.reference);
  const fs::path folder = fs::is_directory(paths[0]) ? paths[0] : paths[0].parent_path();
  std::vector<fs::path> written{folder / "report.html"};
  write(written[0], renderReport(report));
  if (files.csv) {
    const std::pair<const char*, std::string> tables[] = {{"measurements.csv", measurementsAsCsv(report)},
                                                          {"summary.csv", summaryAsCsv(report)},
                                                          {"claims.csv", claimsAsCsv(report)}};
    for (const auto& [name, table] : tables) {
      written.push_back(folder / name);
      write(written.back(), table);
    }
  }
  if (files.plots) {
    const std::vector<fs::path> plots = writePlotFiles(report, folder / "plots");
    written.insert(written.end(), plots.begin(), plots.end());
  }
  return {.files = std::move(written), .claims = std::move(report.claims)};
}

}  // namespace wavecrest
