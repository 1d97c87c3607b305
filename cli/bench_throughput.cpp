// wavecrest bench without a mode: how fast the methods are on this machine, where the time goes, and what it buys.
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "bench/throughput/bench_scene.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/option_values.h"
#include "engine/load/load.h"

namespace wavecrest {
namespace {

constexpr double kThroughputSeconds = 6;

RenderSettings throughputSettings(const Scene& scene, const BenchOptions& options) {
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  return settings;
}

}  // namespace

int runBenchThroughput(const BenchOptions& options) {
  const std::vector<Method> methods = benchMethods(options);
  const double seconds = benchSeconds(options, kThroughputSeconds);
  LoadOptions loading;
  if (!options.size.empty()) loading.filmSize = parseSize(options.size);

  nlohmann::ordered_json all = {{"scenes", nlohmann::ordered_json::array()}};
  for (const std::filesystem::path& file : benchSceneFiles(options)) {
    const Scene scene = loadScene(file, loading);
    const SceneResult result = benchScene(scene, throughputSettings(scene, options), methods, seconds);
    printBench(options, toText(result) + "\n");
    all["scenes"].push_back(toJson(result));
  }
  writeBenchJson(options, "throughput", all);
  return kExitDone;
}

}  // namespace wavecrest
