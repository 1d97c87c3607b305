// wavecrest bench --specialization: every feature set against the complete kernels. Exit code 4 if an image differs.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/specialization/specialization.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

constexpr double kSpecializationSeconds = 20;

}  // namespace

int runBenchSpecialization(const BenchOptions& options) {
  const std::vector<Method> methods =
      options.methods.empty() ? std::vector{Method::pt, Method::vcm} : parseMethodList(options.methods);
  const double seconds = benchSeconds(options, kSpecializationSeconds);
  std::vector<SpecializationResult> results;
  nlohmann::ordered_json all = {{"results", nlohmann::ordered_json::array()}};
  forEachBenchCase(options, methods, [&](const BenchCase& one) {
    results.push_back(measureSpecialization(one.scene, one.settings, seconds));
    printBench(options, toText(results.back()) + "\n");
    all["results"].push_back(toJson(results.back()));
  });
  printBench(options, specializationSummary(results));
  writeBenchJson(options, "specialization", all);
  const bool differs = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.anyDiffers(); });
  return differs ? kExitCheck : kExitDone;
}

}  // namespace wavecrest
