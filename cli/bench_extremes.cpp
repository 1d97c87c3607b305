// wavecrest bench --extremes: every sweep of bench/extremes, as text, JSON and a page.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/extremes/extremes_report.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "engine/version.h"

namespace wavecrest {

int runBenchExtremes(const BenchOptions& options) {
  if (!options.scenes.empty() || !options.methods.empty() || !options.size.empty() || !options.duration.empty()) {
    throw UsageError("--extremes has scenes, methods, sizes and lengths of its own; expected none");
  }
  const std::vector<Sweep> sweeps = allSweeps();
  const uint32_t threads = benchThreads(options);
  std::vector<SweepResult> results;
  nlohmann::ordered_json all = {
      {"version", kVersion}, {"commit", kCommit}, {"sweeps", nlohmann::ordered_json::array()}};
  for (const Sweep& sweep : sweeps) {
    results.push_back(runSweep(sweep, {.threads = threads}));
    printBench(options, toText(results.back()));
    all["sweeps"].push_back(toJson(results.back()));
  }
  writeBenchJson(options, "extremes", all);
  if (!options.html.empty()) writeText(options.html, extremesPage(results));
  const bool passes = std::all_of(results.begin(), results.end(), [](const auto& result) { return result.passes(); });
  return passes ? kExitDone : kExitCheck;
}

}  // namespace wavecrest
