#include "bench/report/collect.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/claims/judge_claims.h"
#include "bench/report/collect_campaign.h"
#include "bench/report/collect_renders.h"
#include "bench/report/method_style.h"
#include "bench/report/results_folder.h"
#include "bench/results/read_results.h"

namespace wavecrest {

namespace {

namespace fs = std::filesystem;

ConvergenceReport collect(std::span<const fs::path> paths, const fs::path& reference) {
  const bool list = paths.size() == 1 && paths[0].extension() == ".csv";
  const bool file =
      paths.size() == 1 && !list && (fs::is_regular_file(paths[0]) || fs::exists(paths[0] / kResultsFile));
  if (paths.size() == 1 && !file && !holdsResults(paths[0])) return collectRenders(paths[0], reference);
  if (!reference.empty()) {
    throw ResultsError(
        fmt::format("{}: holds results that are measured already; expected a folder of images for --reference {}",
                    paths[0].string(), reference.string()));
  }
  CampaignResults results = readResults(paths);
  // No part could judge the whole.
  if (!file) results.claims = judgeStudyClaims(results);
  return collectCampaign(results);
}

}  // namespace

ConvergenceReport collectReport(std::span<const fs::path> paths, const fs::path& reference) {
  ConvergenceReport report = collect(paths, reference);
  if (report.metrics.empty())
    throw ResultsError(paths[0].string() + ": holds no measured snapshot; expected those of at least one run");
  for (ReportScene& scene : report.scenes) {
    std::stable_sort(scene.series.begin(), scene.series.end(), [](const ReportSeries& a, const ReportSeries& b) {
      return methodRank(a.method) < methodRank(b.method);
    });
  }
  return report;
}

}  // namespace wavecrest
