// wavecrest bench without a mode: how fast the methods are on this machine, where the time goes, and what it buys.
#include <nlohmann/json.hpp>

#include "bench/throughput/bench_scene.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "engine/load/load.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

constexpr double kThroughputSeconds = 6;

}  // namespace

int runBenchThroughput(const BenchOptions& options) {
  const std::vector<Method> methods = parseMethodList(options.methods);
  const double seconds = benchSeconds(options, kThroughputSeconds);
  nlohmann::ordered_json all = {{"scenes", nlohmann::ordered_json::array()}};
  std::vector<SceneBench> benches;
  for (const std::filesystem::path& file : benchSceneFiles(options)) {
    Scene scene = loadScene(file, benchLoading(options));
    const RenderSettings settings = benchSettings(scene, options);
    benches.emplace_back(std::move(scene), settings, methods, seconds);
  }
  benchInTurn(benches, [&](const SceneResult& result) {
    printBench(options, toText(result) + "\n");
    all["scenes"].push_back(toJson(result));
  });
  writeBenchJson(options, "throughput", all);
  return kExitDone;
}

}  // namespace wavecrest
