// The fixed workload of `wavecrest bench --score`: which scenes, by which methods, how large and how long.
//
// It must not change, or scores of different versions could not be compared: kScoreVersion grows when it does.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

constexpr int kScoreVersion = 1;

// small: four scenes without downloads on 256x192 pixels, a minute or two on two cores. medium: the nine scenes on
// 512x384, minutes. large: the nine scenes on 1024x768, an hour.
enum class ScoreSize { small, medium, large };
constexpr std::array<std::string_view, 3> kScoreSizeNames{"small", "medium", "large"};

// An entry is rendered in kScoreSlices calls of equal numbers of iterations. The image after the first is validated.
constexpr uint64_t kScoreSlices = 8;

// Scores are of the first methods of kMethods: the study's six, and bpm.
constexpr size_t kScoredMethods = 7;

struct ScoreEntry {
  std::string scene;
  Method method{};
  uint32_t width = 0, height = 0;
  uint64_t iterations = 0;  // a multiple of kScoreSlices
};

std::vector<ScoreEntry> workloadOf(ScoreSize size);

// What decides the image of an entry, and how work is cut: fixed, but for instruction set and threads.
RenderSettings scoreSettings(const Scene& scene, const ScoreEntry& entry, Isa isa, uint32_t threads);

// The same settings as options of `render`, where it has other defaults. It has no option for the light walks of lt.
std::vector<std::string> optionsOf(const RenderSettings& settings);

}  // namespace wavecrest
