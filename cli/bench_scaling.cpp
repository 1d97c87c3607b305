// wavecrest bench --scaling: how methods grow with threads.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/scaling/scaling.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "engine/load/load.h"

namespace wavecrest {
namespace {

constexpr double kScalingSeconds = 20;

}  // namespace

int runBenchScaling(const BenchOptions& options) {
  const std::vector<Method> methods = benchMethods(options);
  const double seconds = benchSeconds(options, kScalingSeconds);
  nlohmann::ordered_json all = {{"results", nlohmann::ordered_json::array()}};
  for (const std::filesystem::path& file : benchSceneFiles(options)) {
    const Scene scene = loadScene(file, benchLoading(options));
    for (const Method method : methods) {
      RenderSettings settings = benchSettings(scene, options);
      settings.method = method;
      const ScalingResult result = measureScaling(scene, file, settings, seconds);
      printBench(options, toText(result) + "\n");
      all["results"].push_back(toJson(result));
    }
  }
  writeBenchJson(options, "scaling", all);
  return kExitDone;
}

}  // namespace wavecrest
