// `wavecrest bench --specialization`: what it is worth to compile kernels for what a scene has.
//
// Every feature set that covers a scene and method renders the same iterations with the same random numbers, in turn
// and on one thread. Its image must be that of the complete kernels, bit for bit or but for rounding; what it gains is
// speed and memory.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/machine/machine_watch.h"
#include "bench/statistics/medians.h"
#include "bench/tradeoff/block_means.h"
#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct FeatureSetRow {
  Specialization specialization{};
  bool chosen = false;               // the set that this scene and method render with
  std::vector<std::string> paysFor;  // features of the set that the scene lacks
  Estimate pathsPerCpuSecond;
  Estimate speedup;  // over the complete kernels, round by round
  size_t bytesPerPath = 0;
  bool sameBits = false;       // the image is the complete kernels'
  double pixelDifference = 0;  // root mean square over samples, relative to the image's
  Bias mean, worstBlock;       // against the complete kernels, over seeds
  bool differs = false;        // beyond chance and rounding
};

struct SpecializationResult {
  std::string scene;
  Method method{};
  uint32_t width = 0, height = 0;
  uint64_t iterations = 0;          // of the images that are compared, with each of kSpecializationSeeds
  std::vector<std::string> needs;   // features of the scene and method
  std::vector<FeatureSetRow> rows;  // the complete kernels last
  MachineState machine;

  const FeatureSetRow& chosen() const;
  bool anyDiffers() const;
};
constexpr uint32_t kSpecializationSeeds = 4;
// Probability that any image of a result is said to differ by chance. A path whose end is decided by rounding takes
// another turn, so images differ in a few pixels.
constexpr double kSpecializationLevel = 0.01;

// seconds: render time of everything, about.
SpecializationResult measureSpecialization(const Scene& scene, const RenderSettings& settings, double seconds);

std::string toText(const SpecializationResult& result);
// What each scene pays for, one line each.
std::string specializationSummary(const std::vector<SpecializationResult>& results);
nlohmann::ordered_json toJson(const SpecializationResult& result);

}  // namespace wavecrest
