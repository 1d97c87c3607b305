// What `wavecrest bench` can be asked for: one function for each mode, chosen by cli/bench.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/load/load.h"
#include "engine/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// As written on the command line.
struct BenchOptions {
  std::vector<std::string> scenes, methods;
  std::string duration, json, size;
  uint32_t threads = 0;
  std::string against;
  std::vector<std::string> compare;  // two files
  bool extremes = false, scaling = false, tradeoff = false;
  std::string html;
  double familyLevel = 0.05, tolerance = 0;
};

// All return an exit code. One line about progress goes to stderr where that is a terminal.
int runBenchThroughput(const BenchOptions& options);
int runBenchAgainst(const BenchOptions& options);
int runBenchCompare(const BenchOptions& options);
int runBenchTradeoff(const BenchOptions& options);
int runBenchScaling(const BenchOptions& options);
int runBenchExtremes(const BenchOptions& options);

// Shared by the modes. Tables go to stdout unless the JSON does.
void printBench(const BenchOptions& options, const std::string& text);
std::vector<std::filesystem::path> benchSceneFiles(const BenchOptions& options);
std::vector<Method> benchMethods(const BenchOptions& options);
LoadOptions benchLoading(const BenchOptions& options);
// The best instruction set, all cores unless told otherwise, and the scene's own limits of paths.
RenderSettings benchSettings(const Scene& scene, const BenchOptions& options);
double benchSeconds(const BenchOptions& options, double unlessGiven);
// Writes the figures of a mode where --json asks for them, with what every result has (bench/schema.json).
void writeBenchJson(const BenchOptions& options, const std::string& kind, const nlohmann::ordered_json& figures);

}  // namespace wavecrest
