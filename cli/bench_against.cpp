// wavecrest bench --against and --compare: this build beside another one, or two stored results. Exit code 4 for a loss
// of speed beyond noise.
#include <fmt/core.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "bench/against/against.h"
#include "bench/against/child_render.h"
#include "bench/against/stored.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

// CPU time per scene and method, both builds together, unless --duration says otherwise.
constexpr double kAgainstSeconds = 20;

// Progress in one line that overwrites itself; nothing where stderr is no terminal.
void showRound(size_t done, size_t all) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\rround {} of {}{}", done, all, done == all ? "\n" : "");
  std::fflush(stderr);
}

// A stored result of `bench --json`.
nlohmann::json readResult(const std::string& file) {
  nlohmann::json result = readJsonFile(file);
  if (!result.is_object()) throw InputError(fmt::format("{}: is no JSON object; expected a result of bench", file));
  return result;
}

}  // namespace

int runBenchAgainst(const BenchOptions& options) {
  // Checks options before anything is rendered. The size is passed on to both builds as text.
  std::error_code ignored;
  if (access(options.against.c_str(), X_OK) != 0 || !std::filesystem::is_regular_file(options.against, ignored)) {
    throw UsageError(fmt::format("--against {}: cannot be run; expected the path of a wavecrest", options.against));
  }
  if (!options.size.empty()) parseSize("--size", options.size);
  AgainstRequest request{.other = std::filesystem::absolute(options.against),
                         .scenes = benchSceneFiles(options),
                         .methods = {},
                         .size = options.size,
                         .threads = options.threads == 0 ? 1 : options.threads,
                         .seconds = benchSeconds(options, kAgainstSeconds),
                         .family = {.level = options.familyLevel, .tolerance = options.tolerance},
                         .more = {}};
  for (const Method method : parseMethodList(options.methods)) request.methods.emplace_back(toString(method));
  try {
    // Measures; the exit code tells whether this build is slower.
    const AgainstResult result = runAgainst(request, showRound);
    printBench(options, toText(result));
    writeBenchJson(options, "against", toJson(result));
    return result.anySlower() ? kExitCheck : kExitDone;
  } catch (const ChildError& error) {
    throw InputError(error.what());
  }
}

int runBenchCompare(const BenchOptions& options) {
  const std::string &before = options.compare[0], &after = options.compare[1];
  const FamilyLevel family{.level = options.familyLevel, .tolerance = options.tolerance};
  try {
    const StoredComparison result = compareStored(readResult(before), readResult(after), family);
    printBench(options, toText(result));
    writeBenchJson(options, "compare", toJson(result));
    return result.anySlower() ? kExitCheck : kExitDone;
  } catch (const StoredMismatch& error) {
    throw InputError(fmt::format("{}, {}: {}", before, after, error.what()));
  }
}

}  // namespace wavecrest
