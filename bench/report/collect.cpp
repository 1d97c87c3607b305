#include "bench/report/collect.h"

#include "bench/report/collect_campaign.h"
#include "bench/report/collect_renders.h"
#include "bench/report/results_folder.h"
#include "bench/results/read_results.h"

namespace wavecrest {

ConvergenceReport collectReport(std::span<const std::filesystem::path> paths) {
  namespace fs = std::filesystem;
  const bool renders = paths.size() == 1 && !fs::is_regular_file(paths[0]) && !fs::exists(paths[0] / kResultsFile);
  if (renders) return collectRenders(paths[0]);
  ConvergenceReport report = collectCampaign(readResults(paths));
  if (report.metrics.empty())
    throw ResultsError(paths[0].string() + ": holds no measured snapshot; expected those of at least one run");
  return report;
}

}  // namespace wavecrest
