// wavecrest report DIR...: rebuilds DIR/report.html from the results in DIR.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/claims/judge_claims.h"
#include "bench/report/write_report.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "cli/commands.h"
#include "cli/findings.h"
#include "cli/messages.h"

namespace wavecrest {
namespace {

// The options as written on the command line.
struct ReportOptions {
  std::vector<std::string> paths;
  ReportFiles files;
  std::string reference;
  bool check = false, judge = false;
};

// Judges the study's findings by this program's conditions, and stores the verdicts in place of the old ones.
void judgeAnew(const std::vector<std::filesystem::path>& paths) {
  // A folder stands for the results file in it.
  const std::filesystem::path file = std::filesystem::is_directory(paths[0]) ? paths[0] / kResultsFile : paths[0];
  if (paths.size() > 1 || !std::filesystem::is_regular_file(file)) {
    throw UsageError("--judge: stores verdicts in one results file; expected the folder of one campaign");
  }
  const std::vector<ClaimRecord> claims = judgeStudyClaims(readResults(file));
  ResultsStore(file).putClaims(claims);
}

}  // namespace

void addReportCommand(CommandLine& program, int& exitCode) {
  const Command command = program.add("report", "rebuild DIR/report.html from the results in DIR");
  auto options = std::make_shared<ReportOptions>();
  command
      .add("DIR", options->paths,
           "folder of a campaign, or of renders with stats and a reference per scene, or of any program's images "
           "METHOD.SECONDS.exr with reference.exr, or a list of those (CSV: image,seconds); several folders or results "
           "files are the parts of one campaign, reported in the first")
      .required();
  command.add("--reference", options->reference, "image that a folder of renders or images is measured against");
  command.add("--baseline", options->files.baseline,
              "method that speed-ups are over; default: the first, pt if it is there");
  command.addFlag(
      "--csv", options->files.csv,
      "also write DIR/measurements.csv, every score of every snapshot, and DIR/summary.csv, times.csv and claims.csv");
  command.addFlag("--plots", options->files.plots, "also write each plot as DIR/plots/SCENE.METRIC.svg");
  command.addFlag("--judge", options->judge, "judge the study's findings anew, by the conditions of this program");
  command.addFlag("--check", options->check, "fail with exit code 4 where a finding of the study does not hold");
  command.run([options, &exitCode] {
    exitCode = kExitDone;
    const std::vector<std::filesystem::path> paths(options->paths.begin(), options->paths.end());
    // The verdicts come first, because the report shows them.
    if (options->judge) judgeAnew(paths);
    options->files.reference = options->reference;
    const WrittenReport report = writeReport(paths, options->files);
    for (const auto& file : report.files) printOut("{}\n", file.string());
    // --check: the exit code tells whether all findings hold.
    if (!options->check) return;
    if (report.claims.empty()) {
      throw InputError(options->paths[0] + ": holds no judged finding; expected a campaign by time that is over");
    }
    exitCode = showFindings(report.claims);
  });
}

}  // namespace wavecrest
