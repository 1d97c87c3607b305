// wavecrest bench --machines: stored scores of several machines beside each other.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/score/expected.h"
#include "bench/score/machine_scores.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"

namespace wavecrest {
namespace {

// The JSON files of folders, by name, and files as they are.
std::vector<std::filesystem::path> resultFiles(const std::vector<std::string>& places) {
  std::vector<std::filesystem::path> files;
  for (const std::string& place : places) {
    if (!std::filesystem::is_directory(place)) {
      files.emplace_back(place);
      continue;
    }
    const size_t first = files.size();
    for (const auto& entry : std::filesystem::directory_iterator(place)) {
      if (entry.path().extension() == ".json" && !entry.is_directory()) files.push_back(entry.path());
    }
    std::sort(files.begin() + static_cast<ptrdiff_t>(first), files.end());
  }
  return files;
}

}  // namespace

int runBenchMachines(const BenchOptions& options) {
  // Results of bench's other modes may lie beside scores.
  std::vector<MachineScore> scores;
  for (const std::filesystem::path& file : resultFiles(options.machines)) {
    const nlohmann::json result = readJsonFile(file);
    if (result.is_discarded()) throw InputError(fmt::format("{}: is no JSON", file.string()));
    if (!isScore(result)) {
      tell("{}: is no score; left out", file.string());
      continue;
    }
    try {
      scores.push_back(readMachineScore(result));
    } catch (const ScoreFileError& error) {
      throw InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
  }
  if (scores.empty()) {
    throw InputError(fmt::format("{}: has no scores; expected results of bench --score SIZE --json FILE",
                                 fmt::join(options.machines, ", ")));
  }
  sortScores(scores);
  printBench(options, machinesText(scores));
  if (!options.html.empty()) writeText(options.html, machinesPage(scores));
  writeBenchJson(options, "machines", machinesJson(scores));
  return kExitDone;
}

}  // namespace wavecrest
