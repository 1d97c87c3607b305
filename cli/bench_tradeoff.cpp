// wavecrest bench --tradeoff: what every setting that buys speed costs, on scenes of the user's choice.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/tradeoff/tradeoff.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

constexpr double kTradeSeconds = 60;
// Beyond it, images of a setting take long; settings are compared as well on small ones.
constexpr uint32_t kMostColumns = 256;

// The scene on a film of --size, or on its own if its image is not too wide.
Scene tradeScene(const BenchOptions& options, const std::filesystem::path& file) {
  LoadOptions loading = benchLoading(options);
  Scene scene = loadScene(file, loading);
  const FilmSettings& film = scene.film;
  if (loading.filmSize || film.imageWidth() <= kMostColumns) return scene;
  loading.filmSize = {kMostColumns, std::max(1u, film.height * kMostColumns / film.width)};
  return loadScene(file, loading);
}

// The settings that are varied.
RenderSettings tradeSettings(const BenchOptions& options, const Scene& scene, Method method) {
  RenderSettings settings = benchSettings(scene, options);
  // CPU time of threads that share caches would blur the comparison.
  if (options.threads == 0) settings.threads = 1;
  settings.method = method;
  return settings;
}

// Refuses a word of --knobs that names no setting of any method in any scene. Throws UsageError.
void refuseUnknownKnobs(const BenchOptions& options, const std::vector<Scene>& scenes,
                        const std::vector<Method>& methods) {
  std::vector<std::string> unknown = options.knobs;
  for (const Scene& scene : scenes) {
    for (const Method method : methods) {
      if (unknown.empty()) return;
      const std::vector<Variant> variants = variantsOf(scene, tradeSettings(options, scene, method));
      std::erase_if(unknown, [&](const std::string& word) { return hasKnob(variants, word); });
    }
  }
  if (unknown.empty()) return;
  throw UsageError(fmt::format(
      "--knobs: '{}' is no setting that is varied here; expected words of the tradeoff table's first column",
      unknown.front()));
}

}  // namespace

int runBenchTradeoff(const BenchOptions& options) {
  const std::vector<Method> methods = parseMethodList(options.methods);
  TradeEffort effort{.seconds = benchSeconds(options, kTradeSeconds), .knobs = options.knobs};
  if (options.seeds != 0) effort.seeds = options.seeds;
  // Loads all scenes and checks all words before anything is measured.
  std::vector<Scene> scenes;
  for (const std::filesystem::path& file : benchSceneFiles(options)) scenes.push_back(tradeScene(options, file));
  refuseUnknownKnobs(options, scenes, methods);
  // Measures each method in each scene.
  std::vector<TradeResult> results;
  nlohmann::ordered_json all = {{"results", nlohmann::ordered_json::array()}};
  for (const Scene& scene : scenes) {
    for (const Method method : methods) {
      results.push_back(measureTrade(scene, tradeSettings(options, scene, method), effort));
      printBench(options, toText(results.back()) + "\n");
      all["results"].push_back(toJson(results.back()));
    }
  }
  writeBenchJson(options, "tradeoff", all);
  if (!options.html.empty()) writeText(options.html, tradePage(results));
  return kExitDone;
}

}  // namespace wavecrest
