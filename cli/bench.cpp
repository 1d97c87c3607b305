// wavecrest bench: the options of all its modes, and which mode they ask for.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/machine/machine_record.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/pinning.h"
#include "engine/version.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

constexpr int kBenchSchemaVersion = 1;  // of bench/schema.json

}  // namespace

// The scenes of the command line; by default two Cornell boxes.
std::vector<std::filesystem::path> benchSceneFiles(const BenchOptions& options) {
  if (options.scenes.empty()) return {findScene("cornell-diffuse"), sceneFolder() / "mitsuba-cornell-box.xml"};
  std::vector<std::filesystem::path> files;
  for (const std::string& scene : options.scenes) files.push_back(findScene(scene));
  return files;
}

// The methods of --methods; by default all.
std::vector<Method> benchMethods(const BenchOptions& options) {
  std::vector<Method> methods;
  for (const std::string& word : options.methods) methods.push_back(parseMethodOption("--methods", word));
  if (methods.empty()) {
    for (const MethodEntry& entry : kMethods) methods.push_back(entry.method);
  }
  return methods;
}

void printBench(const BenchOptions& options, const std::string& text) {
  // Tables on stdout would spoil the JSON there.
  if (options.json == "-") return;
  fmt::print("{}", text);
  // A measurement takes long, so each row is shown once it is there.
  std::fflush(stdout);
}

// Loads scenes at --size, or at the size that they state.
LoadOptions benchLoading(const BenchOptions& options) {
  LoadOptions loading;
  if (!options.size.empty()) loading.filmSize = parseSize("--size", options.size);
  return loading;
}

RenderSettings benchSettings(const Scene& scene, const BenchOptions& options) {
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.threads = benchThreads(options);
  if (options.pin) settings.placement = pinnedPlacement(settings.threads, ProgressKind::none);
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  return settings;
}

void forEachBenchCase(const BenchOptions& options, const std::vector<Method>& methods,
                      const std::function<void(const BenchCase&)>& measure) {
  for (const std::filesystem::path& file : benchSceneFiles(options)) {
    // A scene is loaded once for all methods.
    const Scene scene = loadScene(file, benchLoading(options));
    for (const Method method : methods) {
      BenchCase one{.scene = scene, .file = file, .settings = benchSettings(scene, options)};
      one.settings.method = method;
      measure(one);
    }
  }
}

uint32_t benchThreads(const BenchOptions& options) {
  return options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
}

// Seconds of --duration, or what the mode takes by default.
double benchSeconds(const BenchOptions& options, double unlessGiven) {
  return options.duration.empty() ? unlessGiven : parseDuration("--duration", options.duration);
}

void writeBenchJson(const BenchOptions& options, const std::string& kind, const nlohmann::ordered_json& figures) {
  if (options.json.empty()) return;
  // The head that all results have. The figures follow at the same level.
  nlohmann::ordered_json all = {{"schema_version", kBenchSchemaVersion},
                                {"kind", kind},
                                {"version", kVersion},
                                {"commit", kCommit},
                                {"machine", toJson(machineRecord())}};
  all.update(figures);
  writeText(options.json, all.dump(2) + "\n");
}

namespace {

// The first mode that was asked for runs. Throughput is the default.
int runBench(const BenchOptions& options) {
  if (!options.compare.empty()) return runBenchCompare(options);
  if (!options.against.empty()) return runBenchAgainst(options);
  if (options.tradeoff) return runBenchTradeoff(options);
  if (options.scaling) return runBenchScaling(options);
  if (options.specialization) return runBenchSpecialization(options);
  if (!options.score.empty()) return runBenchScore(options);
  return runBenchThroughput(options);
}

}  // namespace

void addBenchCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<BenchOptions>();
  const Command command = program.add("bench", "measure speed, where it goes, and what it buys");
  // Options of several modes.
  command.add("scenes", options->scenes, "built-in scenes or XML files; default: two Cornell boxes");
  command.add("--methods", options->methods, "methods, separated by commas; default: all").separatedByCommas();
  command.add("--duration", options->duration,
              "time per scene and method, about; default: 6s, of --against, --scaling and --specialization 20s, of "
              "--tradeoff 60s");
  command.add("--json", options->json, "write all figures as JSON; -: to stdout, instead of the tables");
  command.add("--size", options->size, "film size, WIDTHxHEIGHT");
  command.add("--threads", options->threads, "most threads; default: all cores, of --against and --tradeoff one")
      .between(1, 4096);
  command.addFlag("--pin", options->pin,
                  "bind threads to cores and spread shared memory over their nodes; not with the modes below");
  // Comparison with another build, or of two stored results.
  command.add("--against", options->against, "compare with another build: the path of its wavecrest");
  command.add("--compare", options->compare, "compare two stored results of one machine: BEFORE.json AFTER.json")
      .exactly(2);
  command.add("--family-level", options->familyLevel, "--against, --compare: probability of any false verdict")
      .showDefault()
      .between(1e-6, 0.5);
  command.add("--tolerance", options->tolerance, "--against, --compare: part of the speed that may be lost")
      .showDefault()
      .between(0.0, 0.9);
  // The other modes and their own options.
  command.addFlag("--scaling", options->scaling,
                  "speedup over threads: measured here, and predicted up to 256 from the graph of tasks");
  command.add("--score", options->score, "one figure for this machine, from a fixed workload: small, medium or large");
  command.add("--hashes", options->hashes, "--score: validate images by this file instead of the committed one");
  command.add("--write-hashes", options->writeHashes,
              "--score: measure nothing, render what validates the images and put its hashes into this file");
  command.addFlag("--specialization", options->specialization,
                  "kernels for what a scene has against those that render everything: image, speed, memory, code");
  command.addFlag("--tradeoff", options->tradeoff,
                  "speed, noise, bias and memory of every setting that buys one for another");
  command
      .add("--knobs", options->knobs,
           "--tradeoff: settings to vary, separated by commas: precision,kernels; default: all")
      .separatedByCommas();
  command.add("--seeds", options->seeds, "--tradeoff: renders of each setting; default: 6").between(2, 1000);
  command.addFlag("--extremes", options->extremes, "take scenes and renders to their extremes, one property at a time");
  command.add("--html", options->html, "--extremes, --tradeoff: write a page with plots");
  command.run([options, &exitCode] {
    // Options that do not go with the chosen mode are refused.
    const bool throughput = !options->extremes && !options->scaling && !options->tradeoff && !options->specialization &&
                            options->score.empty() && options->against.empty() && options->compare.empty();
    if (options->pin && !throughput) throw UsageError("--pin goes with none of bench's other modes; expected it alone");
    if (options->extremes) {
      exitCode = runBenchExtremes(*options);
      return;
    }
    if (!options->html.empty() && !options->tradeoff) {
      throw UsageError("--html goes with --extremes or --tradeoff; expected one of them");
    }
    // Options of a single mode.
    if ((!options->knobs.empty() || options->seeds != 0) && !options->tradeoff) {
      throw UsageError("--knobs and --seeds go with --tradeoff; expected it");
    }
    if (options->score.empty() && !(options->hashes.empty() && options->writeHashes.empty())) {
      throw UsageError("--hashes and --write-hashes go with --score; expected it");
    }
    exitCode = runBench(*options);
  });
}

}  // namespace wavecrest
