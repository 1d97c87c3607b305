// What `wavecrest bench` can be asked for: one function for each mode, chosen by cli/bench.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/load/load.h"
#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// As written on the command line.
struct BenchOptions {
  std::vector<std::string> scenes, methods;
  std::string duration, json, size;
  uint32_t threads = 0;
  std::string against;
  std::vector<std::string> compare;  // two files
  bool extremes = false, scaling = false, tradeoff = false, specialization = false, pin = false;
  std::string score, hashes, writeHashes, pictures, writePictures;  // score: a size
  std::string html;
  std::vector<std::string> machines;  // files and folders of scores
  std::vector<std::string> knobs;
  uint32_t seeds = 0;  // 0: as many as the mode likes
  double familyLevel = 0.05, tolerance = 0;
};

// All return an exit code. One line about progress goes to stderr where that is a terminal.
int runBenchThroughput(const BenchOptions& options);
int runBenchAgainst(const BenchOptions& options);
int runBenchCompare(const BenchOptions& options);
int runBenchTradeoff(const BenchOptions& options);
int runBenchScaling(const BenchOptions& options);
int runBenchSpecialization(const BenchOptions& options);
int runBenchScore(const BenchOptions& options);
int runBenchExtremes(const BenchOptions& options);
int runBenchMachines(const BenchOptions& options);

// Shared by the modes. Tables go to stdout unless the JSON or the page does.
void printBench(const BenchOptions& options, const std::string& text);
std::vector<std::filesystem::path> benchSceneFiles(const BenchOptions& options);
LoadOptions benchLoading(const BenchOptions& options);
// The best instruction set, all cores unless told otherwise, and the scene's own limits of paths.
RenderSettings benchSettings(const Scene& scene, const BenchOptions& options);
// Calls measure for each scene with each method.
struct BenchCase {
  const Scene& scene;
  const std::filesystem::path& file;
  RenderSettings settings;
};
void forEachBenchCase(const BenchOptions& options, const std::vector<Method>& methods,
                      const std::function<void(const BenchCase&)>& measure);
// As many as asked for, or as the machine has.
uint32_t benchThreads(const BenchOptions& options);
double benchSeconds(const BenchOptions& options, double unlessGiven);
// The JSON in a file, is_discarded() where it is none. Throws where the file cannot be read.
nlohmann::json readJsonFile(const std::filesystem::path& file);
// Writes the figures of a mode where --json asks for them, with what every result has (bench/schema.json).
void writeBenchJson(const BenchOptions& options, const std::string& kind, const nlohmann::ordered_json& figures);

}  // namespace wavecrest
