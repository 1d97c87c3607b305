// wavecrest recommend: which method for a scene, and how long it takes.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "bench/recommend/recommend.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/scene_options.h"
#include "engine/tasks/processors.h"
#include "library/option_ranges.h"
#include "library/option_values.h"
#include "metrics/ssim.h"

namespace wavecrest {
namespace {

// The options as written on the command line.
struct RecommendOptions {
  SceneOptions scene;
  std::vector<std::string> methods;
  std::string budget = "60s", clock = "wall";
  double targetSsim = 0.95;
  uint32_t threads = 0;
  bool json = false;
};

void runRecommend(const RecommendOptions& options) {
  // Options are checked before the scene is loaded.
  const RecommendRequest request{.targetSsim = options.targetSsim,
                                 .seconds = parseDuration("--budget", options.budget),
                                 .methods = parseMethodList(options.methods),
                                 .clock = static_cast<ClockKind>(parseChoice("--clock", options.clock, kClockNames))};
  const Scene scene = loadScene(options.scene);
  const uint32_t width = scene.film.imageWidth(), height = scene.film.imageHeight();
  // The target is an SSIM, so the film must be large enough for one.
  if (std::min(width, height) < kSsimSmallestSide) {
    throw UsageError(fmt::format("recommend: a film of {}x{} is too small for SSIM; expected at least {} pixels a side",
                                 width, height, kSsimSmallestSide));
  }
  // Settings of all pilots.
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.threads = threadsOrAll(options.threads);
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  takeProgramDefaults(settings);
  const Recommendation result = recommend(scene, settings, request);
  // Output: JSON, or a paragraph and a table.
  printOut("{}", options.json ? jsonText(toJson(result), 2) + "\n" : toText(result));
}

}  // namespace

void addRecommendCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<RecommendOptions>();
  const Command command = program.add("recommend", "which method for a scene, and how long it takes");
  addSceneOptions(command, options->scene);
  command.add("--target-ssim", options->targetSsim, "quality to get to").showDefault().between(0.01, 0.9999);
  command.add("--budget", options->budget, "render time of the pilots together").showDefault();
  command.add("--methods", options->methods, "methods, separated by commas; default: all but evcm")
      .separatedByCommas()
      .repeatable();
  command.add("--clock", options->clock, "what a second is: wall, or cpu over threads for a busy machine")
      .showDefault();
  command.add("--threads", options->threads, "worker threads; default: all cores").between(kThreadRange);
  command.addFlag("--json", options->json, "as JSON");
  command.run([options, &exitCode] {
    runRecommend(*options);
    exitCode = kExitDone;
  });
}

}  // namespace wavecrest
