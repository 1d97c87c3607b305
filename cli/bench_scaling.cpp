// wavecrest bench --scaling: how methods grow with threads.
#include <nlohmann/json.hpp>

#include "bench/against/child_render.h"
#include "bench/scaling/scaling.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

constexpr double kScalingSeconds = 20;

}  // namespace

int runBenchScaling(const BenchOptions& options) {
  const double seconds = benchSeconds(options, kScalingSeconds);
  requireScratchFolders();
  nlohmann::ordered_json all = {{"results", nlohmann::ordered_json::array()}};
  forEachBenchCase(options, parseMethodList(options.methods), [&](const BenchCase& one) {
    const ScalingResult result = measureScaling(one.scene, one.file, one.settings, seconds);
    printBench(options, toText(result) + "\n");
    all["results"].push_back(toJson(result));
  });
  writeBenchJson(options, "scaling", all);
  return kExitDone;
}

}  // namespace wavecrest
