// wavecrest bench: how fast the methods are on this machine, where the time goes, and what it buys.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/throughput/bench_scene.h"
#include "cli/commands.h"
#include "cli/option_values.h"
#include "engine/load/load.h"
#include "engine/version.h"
#include "metrics/image/atomic_file.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

struct BenchOptions {
  std::vector<std::string> scenes, methods;
  std::string duration = "6s", json, size;
  uint32_t threads = 0;
};

std::vector<std::filesystem::path> sceneFiles(const BenchOptions& options) {
  if (options.scenes.empty()) return {findScene("cornell-diffuse"), sceneFolder() / "mitsuba-cornell-box.xml"};
  std::vector<std::filesystem::path> files;
  for (const std::string& scene : options.scenes) files.push_back(findScene(scene));
  return files;
}

std::vector<Method> chosenMethods(const BenchOptions& options) {
  std::vector<Method> methods;
  for (const std::string& word : options.methods) {
    const std::optional<Method> method = parseMethod(word);
    if (!method)
      throw UsageError(fmt::format("--methods {}: unknown; expected names like pt, separated by commas", word));
    methods.push_back(*method);
  }
  if (methods.empty()) {
    for (const MethodEntry& entry : kMethods) methods.push_back(entry.method);
  }
  return methods;
}

RenderSettings settingsFor(const Scene& scene, const BenchOptions& options) {
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  return settings;
}

void runBench(const BenchOptions& options) {
  const std::vector<Method> methods = chosenMethods(options);
  const double seconds = parseDuration(options.duration);
  LoadOptions loading;
  if (!options.size.empty()) loading.filmSize = parseSize(options.size);

  nlohmann::ordered_json all = {
      {"version", kVersion}, {"commit", kCommit}, {"scenes", nlohmann::ordered_json::array()}};
  for (const std::filesystem::path& file : sceneFiles(options)) {
    const Scene scene = loadScene(file, loading);
    const SceneResult result = benchScene(scene, settingsFor(scene, options), methods, seconds);
    fmt::print("{}\n", toText(result));
    std::fflush(stdout);
    all["scenes"].push_back(toJson(result));
  }
  if (options.json.empty()) return;
  const std::string text = all.dump(2) + "\n";
  writeFileAtomically(options.json, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

}  // namespace

void addBenchCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<BenchOptions>();
  const Command command = program.add("bench", "measure speed, where it goes, and what it buys");
  command.add("scenes", options->scenes, "built-in scenes or XML files; default: two Cornell boxes");
  command.add("--methods", options->methods, "methods, separated by commas; default: all").separatedByCommas();
  command.add("--duration", options->duration, "render time per scene and method, about").showDefault();
  command.add("--json", options->json, "write all figures as JSON");
  command.add("--size", options->size, "film size, WIDTHxHEIGHT");
  command.add("--threads", options->threads, "most threads; default: all cores").between(1, 4096);
  command.run([options, &exitCode] {
    runBench(*options);
    exitCode = kExitDone;
  });
}

}  // namespace wavecrest
