// wavecrest bench: the options of all its modes, and which mode they ask for.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "bench/machine/machine_record.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "cli/pinning.h"
#include "engine/tasks/processors.h"
#include "engine/version.h"
#include "library/option_ranges.h"
#include "library/option_values.h"
#include "metrics/image/atomic_file.h"
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

void printBench(const BenchOptions& options, const std::string& text) {
  // Tables on stdout would spoil the JSON or the page there.
  if (options.json == kStandardStream || options.html == kStandardStream) return;
  printOut("{}", text);
  // A measurement takes long, so each row is shown once it is there.
  flushStdout();
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

uint32_t benchThreads(const BenchOptions& options) { return threadsOrAll(options.threads); }

// Seconds of --duration, or what the mode takes by default.
double benchSeconds(const BenchOptions& options, double unlessGiven) {
  return options.duration.empty() ? unlessGiven : parseDuration("--duration", options.duration);
}

nlohmann::json readJsonFile(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = readFileBytes(file);
  return nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
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
  writeText(options.json, jsonText(all, 2) + "\n");
}

namespace {

// A mode and the option that asks for it.
struct BenchMode {
  std::string_view option;
  bool asked = false;
  int (*run)(const BenchOptions&) = nullptr;
};

// The mode that was asked for; without an option, throughput. Two of them are a UsageError.
BenchMode chosenMode(const BenchOptions& options) {
  const BenchMode modes[] = {{"--compare", !options.compare.empty(), runBenchCompare},
                             {"--against", !options.against.empty(), runBenchAgainst},
                             {"--tradeoff", options.tradeoff, runBenchTradeoff},
                             {"--scaling", options.scaling, runBenchScaling},
                             {"--specialization", options.specialization, runBenchSpecialization},
                             {"--score", !options.score.empty(), runBenchScore},
                             {"--machines", !options.machines.empty(), runBenchMachines},
                             {"--extremes", options.extremes, runBenchExtremes}};
  BenchMode chosen{"", true, runBenchThroughput};
  for (const BenchMode& mode : modes) {
    if (!mode.asked) continue;
    if (!chosen.option.empty()) {
      throw UsageError(fmt::format("{} and {}: two modes; expected one of them", chosen.option, mode.option));
    }
    chosen = mode;
  }
  return chosen;
}

// An option that only some modes take.
struct ModeOption {
  std::string_view name;
  bool given;  // with another value than the default, which fits every mode
  std::vector<std::string_view> modes;
};

// Refuses options that the mode would ignore. Throws UsageError.
void refuseOptionsOfOtherModes(const BenchOptions& options, std::string_view mode) {
  const BenchOptions byDefault;
  const std::vector<ModeOption> all = {
      {"--family-level", options.familyLevel != byDefault.familyLevel, {"--against", "--compare"}},
      {"--tolerance", options.tolerance != byDefault.tolerance, {"--against", "--compare"}},
      {"--hashes", !options.hashes.empty(), {"--score"}},
      {"--write-hashes", !options.writeHashes.empty(), {"--score"}},
      {"--pictures", !options.pictures.empty(), {"--score"}},
      {"--write-pictures", !options.writePictures.empty(), {"--score"}},
      {"--knobs", !options.knobs.empty(), {"--tradeoff"}},
      {"--seeds", options.seeds != byDefault.seeds, {"--tradeoff"}},
      {"--html", !options.html.empty(), {"--extremes", "--tradeoff", "--machines"}}};
  for (const ModeOption& option : all) {
    const bool taken = std::find(option.modes.begin(), option.modes.end(), mode) != option.modes.end();
    if (!option.given || taken) continue;
    throw UsageError(fmt::format("{} goes with {}; expected {}", option.name, fmt::join(option.modes, " or "),
                                 option.modes.size() == 1 ? "it" : "one of them"));
  }
  if (options.pin && !mode.empty()) {
    throw UsageError("--pin goes with none of bench's other modes; expected it alone");
  }
  const bool writes = !options.writeHashes.empty() || !options.writePictures.empty();
  if (writes && !(options.hashes.empty() && options.pictures.empty() && options.json.empty())) {
    throw UsageError(fmt::format("{} measures nothing; expected neither --hashes, --pictures nor --json beside it",
                                 options.writeHashes.empty() ? "--write-pictures" : "--write-hashes"));
  }
}

// Refuses what modes that measure nothing would ignore, threads where there is one, and a scene on stdin where other
// processes render it. Throws UsageError.
void refuseWhatModeIgnores(const BenchOptions& options, std::string_view mode) {
  if (mode == "--compare" || mode == "--machines") {
    const bool measures =
        !options.scenes.empty() || !options.methods.empty() || !options.duration.empty() || !options.size.empty();
    if (measures || options.threads != 0) {
      throw UsageError(
          fmt::format("{} measures nothing; expected no scenes, --methods, --duration, --size or --threads", mode));
    }
  }
  if (mode == "--specialization" && options.threads > 1) {
    throw UsageError("--specialization renders on one thread; expected no --threads");
  }
  const bool starts = mode == "--against" || mode == "--scaling";
  if (starts && std::find(options.scenes.begin(), options.scenes.end(), kStandardStream) != options.scenes.end()) {
    throw UsageError(fmt::format("{}: other processes cannot read the scene from stdin; expected a file", mode));
  }
}

// Checks all names of files before anything is measured. Throws UsageError.
void checkBenchFiles(const BenchOptions& options) {
  FileCheck files;
  for (const std::string& scene : options.scenes) files.input("the scene", findScene(scene));
  for (const std::string& result : options.compare) files.input("--compare", result);
  for (const std::string& result : options.machines) files.input("--machines", result);
  if (!options.hashes.empty()) files.input("--hashes", options.hashes);
  if (!options.against.empty()) files.input("--against", options.against);
  if (!options.json.empty()) files.output("--json", options.json);
  if (!options.html.empty()) files.output("--html", options.html);
  if (!options.pictures.empty()) files.input("--pictures", options.pictures);
  for (const auto& [name, file] :
       {std::pair("--write-hashes", options.writeHashes), std::pair("--write-pictures", options.writePictures)}) {
    if (file == kStandardStream) throw UsageError(fmt::format("{} -: expected a file", name));
    if (!file.empty()) files.output(name, file);
  }
}

// Variables are defaults: a mode that does not take their options is run without them.
void forgetBenchVariables(BenchOptions& options, const Command& command) {
  const std::string_view mode = chosenMode(options).option;
  const bool measures = mode != "--compare" && mode != "--machines";
  const bool takesSize = measures && mode != "--score" && mode != "--extremes";
  if (!takesSize && command.fromVariable("--size")) options.size.clear();
  const bool takesThreads = measures && mode != "--specialization";
  if (!takesThreads && command.fromVariable("--threads")) options.threads = 0;
}

int runBench(const BenchOptions& options) {
  const BenchMode mode = chosenMode(options);
  refuseOptionsOfOtherModes(options, mode.option);
  refuseWhatModeIgnores(options, mode.option);
  checkBenchFiles(options);
  return mode.run(options);
}

}  // namespace

void addBenchCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<BenchOptions>();
  const Command command = program.add("bench", "measure speed, where it goes, and what it buys");
  // Options of several modes.
  command.add("scenes", options->scenes, "built-in scenes or XML files; default: two Cornell boxes");
  command
      .add("--methods", options->methods,
           "methods, separated by commas; default: all but evcm; of --specialization pt,vcm; of --score its seven")
      .separatedByCommas()
      .repeatable();
  command.add("--duration", options->duration,
              "time per scene and method, about; default: 6s, of --against, --scaling and --specialization 20s, of "
              "--tradeoff 60s");
  command.add("--json", options->json, "write all figures as JSON; -: to stdout, instead of the tables");
  command.add("--size", options->size, "film size, WIDTHxHEIGHT");
  command
      .add("--threads", options->threads,
           "most threads; default: all cores; of --against, --tradeoff and --specialization one")
      .between(kThreadRange);
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
  command.add("--pictures", options->pictures,
              "--score: compare images without hashes of this build with the pictures in this file, not the committed");
  command.add("--write-pictures", options->writePictures, "--score: as --write-hashes, small pictures of the images");
  command
      .add("--machines", options->machines,
           "scores of several machines beside each other: files of --score --json, or folders of them")
      .repeatable();
  command.addFlag("--specialization", options->specialization,
                  "kernels for what a scene has against those that render everything: image, speed, bytes per path");
  command.addFlag("--tradeoff", options->tradeoff,
                  "speed, noise, bias and memory of every setting that buys one for another");
  command
      .add("--knobs", options->knobs,
           "--tradeoff: settings to vary, separated by commas: precision,kernels; default: all")
      .separatedByCommas()
      .repeatable();
  command.add("--seeds", options->seeds, "--tradeoff: renders of each setting; default: 6").between(2, 1000);
  command.addFlag("--extremes", options->extremes, "take scenes and renders to their extremes, one property at a time");
  command.add("--html", options->html,
              "--extremes, --tradeoff, --machines: write a page; -: to stdout, instead of the tables");
  command.run([options, command, &exitCode] {
    forgetBenchVariables(*options, command);
    exitCode = runBench(*options);
  });
}

}  // namespace wavecrest
