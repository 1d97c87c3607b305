#include "bench/score/workload.h"

#include <fmt/format.h>

#include "bench/enumerator_name.h"

namespace wavecrest {
namespace {

// Iterations of the size `small` by each method: two seconds on a core of the reference machine or somewhat less,
// powers of two.
struct SceneWork {
  std::string_view scene;
  std::array<uint64_t, kScoredMethods> iterations;
  bool inSmall;
};
constexpr std::array<SceneWork, 9> kScenes{{
    // pt, lt, bpt, mlt, ppm, bpm, vcm
    {"cornell-diffuse", {512, 256, 128, 256, 256, 256, 64}, true},
    {"cornell-mirror", {512, 256, 128, 256, 256, 128, 64}, false},
    {"cornell-glossy", {256, 256, 64, 256, 256, 128, 64}, false},
    {"cornell-spheres", {256, 512, 128, 256, 512, 256, 128}, true},
    {"dragon-caustics", {32, 64, 32, 32, 64, 32, 32}, false},
    {"dragon-caustics-glossy", {32, 64, 32, 32, 64, 32, 32}, false},
    {"lafortune-room", {32, 32, 16, 32, 32, 16, 16}, true},
    {"pool-interior", {32, 64, 16, 32, 64, 32, 16}, true},
    {"veach-door", {32, 32, 16, 32, 32, 16, 16}, false},
}};

// Of the film's sides, and what iterations are divided by.
struct Scale {
  uint32_t side;
  uint64_t divisor;
};
constexpr std::array<Scale, 3> kScales{{{1, 1}, {2, 2}, {4, 1}}};
constexpr uint32_t kSmallWidth = 256, kSmallHeight = 192;  // of the committed references (scenes/references)

constexpr bool fillsSlices() {
  for (const SceneWork& work : kScenes) {
    for (const uint64_t iterations : work.iterations) {
      for (const Scale& scale : kScales) {
        if (iterations / scale.divisor % kScoreSlices != 0) return false;
      }
    }
  }
  return true;
}
static_assert(fillsSlices());

// Photons are summed in the order of waves, so the last bits of merging depend on how waves are cut. Cut as for these
// threads, images are the same on any number of threads; 64 pieces of the small film keep dozens of threads busy.
constexpr uint32_t kPiecesForThreads = 4;

}  // namespace

std::vector<ScoreEntry> workloadOf(ScoreSize size) {
  const Scale& scale = kScales[static_cast<size_t>(size)];
  std::vector<ScoreEntry> entries;
  for (const SceneWork& work : kScenes) {
    if (size == ScoreSize::small && !work.inSmall) continue;
    for (size_t i = 0; i < kScoredMethods; ++i) {
      entries.push_back({.scene = std::string(work.scene),
                         .method = kMethods[i].method,
                         .width = kSmallWidth * scale.side,
                         .height = kSmallHeight * scale.side,
                         .iterations = work.iterations[i] / scale.divisor});
    }
  }
  return entries;
}

RenderSettings scoreSettings(const Scene& scene, const ScoreEntry& entry, Isa isa, uint32_t threads) {
  RenderSettings settings;
  settings.method = entry.method;
  settings.isa = isa;
  settings.threads = threads;
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  if (dependsOnWaves(entry.method)) settings.piecesForThreads = kPiecesForThreads;
  return settings;
}

std::vector<std::string> optionsOf(const RenderSettings& settings) {
  std::vector<std::string> options;
  const auto add = [&](std::string_view option, std::string_view value) {
    options.emplace_back(option);
    options.emplace_back(value);
  };
  add("--isa", toString(settings.isa));
  add("--precision", enumeratorName(kPrecisionNames, settings.precision));
  add("--sampler", toString(settings.sampler));
  if (hasRouletteChoice(settings.method)) add("--roulette", enumeratorName(kRouletteNames, settings.roulette));
  if (strategiesOf(settings.method).merge && settings.radius) add("--radius", fmt::to_string(*settings.radius));
  if (choosesMergeVertices(settings.method)) {
    add("--merge-vertices", enumeratorName(kMergeVerticesNames, settings.mergeVertices));
  }
  return options;
}

}  // namespace wavecrest
