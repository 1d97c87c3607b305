// Every stage against its scalar twin: the same wave in, the same columns out, on each instruction set, for each
// precision policy and specialisation, for counts that leave every possible tail.
//
// The waves come from the twin itself: camera paths of a small room with an open side, carried to the depth and stage
// under test. What lies past the size of a queue is poisoned before each run.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "kernels/columns/survival.h"
#include "tests/kernels/stage_room.h"
#include "tests/kernels/stage_waves.h"

namespace wavecrest {
namespace {

constexpr size_t kPaths = 384;
constexpr PathLimits kLimits{.maxDepth = 6, .rouletteDepth = 4};

// A stage at a depth, and how its input is cut to a number of items.
template <class S>
struct StageCase {
  const char* name;
  uint32_t depth;
  Stage<S> Stages<S>::*stage;
  std::function<void(Wave<S>&, size_t)> cut;
  double ulps;  // largest difference from the twin, in units of rounding of its own size and a typical item's
};

template <class S>
void cutPaths(Wave<S>& wave, size_t count) {
  for (size_t* size : {&wave.rays.size, &wave.paths.size, &wave.hits.size, &wave.surfaces.size, &wave.joinable}) {
    *size = std::min(*size, count);
  }
}

template <class S>
std::vector<StageCase<S>> allStages() {
  const auto paths = [](Wave<S>& wave, size_t count) { cutPaths(wave, count); };
  const auto lanes = [](Wave<S>& wave, size_t count) { wave.pathCount = count; };
  const auto shadow = [](Wave<S>& wave, size_t count) { wave.shadowRays.size = std::min(wave.shadowRays.size, count); };
  using T = Stages<S>;
  // Depths: 1 is lit by s = 0 alone, 2 has MIS weights, 4 roulette, 6 is the last.
  return {{"generate", 0, &T::generateCameraPaths, lanes, 8},
          {"extend 1", 1, &T::extendSmall, paths, 512},
          {"extend 3", 3, &T::extendSmall, paths, 512},
          {"arrive 1", 1, &T::arrive, paths, 64},
          {"arrive 2", 2, &T::arrive, paths, 64},
          {"arrive 6", 6, &T::arrive, paths, 64},
          {"next event 1", 1, &T::nextEvent, paths, 256},
          {"next event 2", 2, &T::nextEvent, paths, 256},
          {"occlude 1", 1, &T::occludeSmall, shadow, 8},
          {"occlude 2", 2, &T::occludeSmall, shadow, 8},
          {"scatter 1", 1, &T::scatter, paths, 64},
          {"scatter 4", 4, &T::scatter, paths, 64},
          {"scatter specular 1", 1, &T::scatterSpecular, paths, 64}};
}

template <class S>
class TwinComparison {
 public:
  TwinComparison(Isa isa, Precision precision, Specialization specialization)
      : scene_(makeRoom<S>(covers(specialization, kCurvedShapes), covers(specialization, kSpecularBsdfs),
                           covers(specialization, kNormalMaps))),
        twin_(findStages<S>(Isa::scalar, precision, specialization)),
        stages_(findStages<S>(isa, precision, specialization)),
        needs_(columnNeedsOf(specialization)) {}

  void compare(const StageCase<S>& stage) {
    Wave<S> input(kPaths, needs_), expected(kPaths, needs_), actual(kPaths, needs_);
    poisonTails(input);
    carryTo(stage, input);
    context_.depth = stage.depth;
    expected.copyFrom(input);
    run(twin_, stage, expected);
    const ColumnScales scales = columnScales(expected);
    for (size_t count = 0; count <= 2 * stages_.lanes + 1; ++count) {
      if (stage.depth == 0 && count == 0) continue;  // a wave has at least one path
      for (Wave<S>* wave : {&expected, &actual}) {
        wave->copyFrom(input);
        stage.cut(*wave, count);
        poisonTails(*wave);
      }
      const StageCounters want = run(twin_, stage, expected), got = run(stages_, stage, actual);
      const std::string where = std::string(stage.name) + ", " + std::to_string(count) + " items";
      EXPECT_EQ(want.raysClosest, got.raysClosest) << where;
      EXPECT_EQ(want.raysShadow, got.raysShadow) << where;
      EXPECT_EQ(want.misses, got.misses) << where;
      expectSameWave(expected, actual, scales, stage.ulps, where);
    }
  }

 private:
  // The twin's wave just before the stage.
  void carryTo(const StageCase<S>& stage, Wave<S>& wave) {
    wave.firstPath = 64;
    wave.pathCount = kPaths;
    using T = Stages<S>;
    if (stage.depth == 0) return;
    context_.depth = 0;
    run(twin_.generateCameraPaths, wave);
    const auto last = stage.stage == &T::scatterSpecular ? &T::scatter : stage.stage;
    for (context_.depth = 1;; ++context_.depth) {
      for (const auto member : {&T::extendSmall, &T::arrive, &T::nextEvent, &T::occludeSmall, &T::scatter}) {
        if (context_.depth == stage.depth && member == last) return;
        run(twin_.*member, wave);
      }
    }
  }
  StageCounters run(const Stages<S>& stages, const StageCase<S>& stage, Wave<S>& wave) {
    return run(stages.*stage.stage, wave);
  }
  StageCounters run(Stage<S> stage, Wave<S>& wave) {
    StageCounters counters;
    context_.scene = &scene_.view;
    context_.pixels = scene_.pixels.data();
    context_.sampler = {.kind = SamplerKind::independent, .seed = 11, .iteration = 3};
    context_.limits = kLimits;
    context_.counters = &counters;
    stage(context_, wave);
    return counters;
  }

  StageScene<S> scene_;
  const Stages<S>& twin_;
  const Stages<S>& stages_;
  const ColumnNeeds needs_;
  StageContext<S> context_;
};

// ---- the tests ------------------------------------------------------------------------------------------------------

class StageTest : public testing::TestWithParam<Choice> {
 protected:
  template <class S>
  void compareAll() {
    const Choice& choice = GetParam();
    TwinComparison<S> comparison(choice.isa, choice.precision, choice.specialization);
    for (const StageCase<S>& stage : allStages<S>()) comparison.compare(stage);
  }
};

TEST_P(StageTest, equalsScalarTwin) {
  if (GetParam().precision == Precision::doubled) {
    compareAll<double>();
  } else {
    compareAll<float>();
  }
}

// Camera paths of a room at their first vertices, before they scatter.
struct FirstVertices {
  FirstVertices(const StageScene<float>& scene, const Stages<float>& stages, uint32_t rouletteDepth) {
    context.scene = &scene.view;
    context.pixels = scene.pixels.data();
    context.limits = {.maxDepth = 6, .rouletteDepth = rouletteDepth};
    context.counters = &counters;
    wave.pathCount = kPaths;
    stages.generateCameraPaths(context, wave);
    context.depth = 1;
    stages.extendSmall(context, wave);
    stages.arrive(context, wave);
  }
  FirstVertices(const FirstVertices&) = delete;
  FirstVertices& operator=(const FirstVertices&) = delete;

  Wave<float> wave{kPaths, columnNeedsOf(Specialization::complete)};
  StageCounters counters;
  StageContext<float> context;
};

// Survivors carry their throughput over the probability, so the rule can be read from what roulette has left: nothing
// by albedo, which keeps throughputs as they were, and no more than 1 / scale of a scaled throughput.
TEST(Roulette, followsTheRule) {
  for (const Isa isa : availableIsas()) {
    const StageScene<float> scene = makeRoom<float>(true, false, false);
    const Stages<float>& stages = findStages<float>(isa, Precision::floating, Specialization::complete);
    for (const SurvivalRule rule :
         {SurvivalRule{.byAlbedo = true}, SurvivalRule{.scale = 1}, SurvivalRule{.scale = 4}}) {
      FirstVertices first(scene, stages, 1);
      Wave<float>& wave = first.wave;
      first.context.survival = &rule;
      for (size_t i = 0; i < wave.paths.size; ++i) {
        wave.paths.throughputR[i] = wave.paths.throughputG[i] = wave.paths.throughputB[i] = 0.2f;
      }
      const size_t before = wave.paths.size;
      stages.scatter(first.context, wave);
      EXPECT_GT(wave.paths.size, 0u);
      EXPECT_LT(wave.paths.size, before);
      const float left = rule.byAlbedo ? 0.2f : 1 / rule.scale;
      for (size_t i = 0; i < wave.paths.size; ++i) {
        const float most = std::max({wave.paths.throughputR[i], wave.paths.throughputG[i], wave.paths.throughputB[i]});
        EXPECT_NEAR(most, left, 1e-4f * left) << toString(isa) << ", scale " << rule.scale;
      }
    }
  }
}

// A camera path's throughput is divided by the square of the index that it enters (METHODS 1.5): the scale undoes that,
// so that roulette sees what the surface has left of the light. The room's glass reflects 0.9 and lets 0.95 pass.
TEST(Roulette, scaleUndoesTheCompressionOfRadiance) {
  for (const Isa isa : availableIsas()) {
    const StageScene<float> scene = makeRoom<float>(true, true, false);
    const Stages<float>& stages = findStages<float>(isa, Precision::floating, Specialization::complete);
    FirstVertices first(scene, stages, 6);
    Wave<float>& wave = first.wave;
    std::vector<bool> onGlass(kPaths, false);
    for (size_t i = 0; i < wave.paths.size; ++i) {
      onGlass[wave.paths.lane[i]] = scene.view.primitives[wave.hits.primitive[i]].material == kGlass;
    }
    stages.scatter(first.context, wave);
    size_t refracted = 0;
    for (size_t i = 0; i < wave.paths.size; ++i) {
      if (!onGlass[wave.paths.lane[i]]) continue;
      const bool passes = wave.paths.rouletteScale[i] != 1;
      refracted += passes ? 1 : 0;
      EXPECT_NEAR(wave.paths.throughputR[i] * wave.paths.rouletteScale[i], passes ? 0.95f : 0.9f, 1e-5f);
    }
    EXPECT_GT(refracted, 2u) << toString(isa);
  }
}

// Lights without radiance are picked with probability 0. Where a path's sums of densities are infinite, the product of
// the two is no number, which must not get into the pixel's other light.
template <class S>
void expectNothingOfBlackLights(const Choice& choice) {
  constexpr uint32_t kLamp = 0, kGlowing = 1, kSky = 3;
  StageScene<S> scene =
      makeRoom<S>(covers(choice.specialization, kCurvedShapes), false, covers(choice.specialization, kNormalMaps));
  for (const uint32_t black : {kGlowing, kSky}) {
    std::fill_n(scene.lights[black].radiance, 3, S(0));
    scene.lights[black].pick = 0;
  }
  const Stages<S>& stages = findStages<S>(choice.isa, choice.precision, choice.specialization);
  const ColumnNeeds needs = columnNeedsOf(choice.specialization);
  Wave<S> wave(kPaths, needs);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &scene.view;
  context.pixels = scene.pixels.data();
  context.limits = kLimits;
  context.counters = &counters;
  wave.pathCount = kPaths;
  stages.generateCameraPaths(context, wave);
  context.depth = 1;
  stages.extendSmall(context, wave);
  // The first rays stand for second ones, which have weights, and some of them leave the room.
  context.depth = 2;
  std::vector<uint32_t> lights(kPaths);  // that the paths meet
  for (size_t i = 0; i < wave.paths.size; ++i) {
    if (i % 5 == 0) wave.hits.primitive[i] = kMiss;
    const uint32_t hit = wave.hits.primitive[i];
    const uint32_t light = hit == kMiss ? kSky : scene.view.primitives[hit].light;
    const S sum = light == kGlowing || light == kSky ? std::numeric_limits<S>::infinity() : S(0);
    lights[wave.paths.lane[i]] = light;
    wave.paths.dVCM[i] = sum;
    if (needs.connections) wave.paths.dVC[i] = sum;
  }
  stages.arrive(context, wave);
  size_t lamps = 0, glowing = 0;
  for (size_t lane = 0; lane < kPaths; ++lane) {
    const S red = wave.radiance.red[lane];
    if (lights[lane] == kLamp) {
      EXPECT_GT(red, S(0)) << "lane " << lane;
    } else if (lights[lane] == kGlowing || lights[lane] == kSky) {
      EXPECT_EQ(red, S(0)) << "lane " << lane;
    }
    lamps += lights[lane] == kLamp ? 1 : 0;
    glowing += lights[lane] == kGlowing ? 1 : 0;
  }
  EXPECT_GT(lamps, 2u);
  EXPECT_GT(glowing, 2u);
}
TEST_P(StageTest, addsNothingOfBlackLightsWhateverTheSums) {
  if (GetParam().precision == Precision::doubled) {
    expectNothingOfBlackLights<double>(GetParam());
  } else {
    expectNothingOfBlackLights<float>(GetParam());
  }
}

// The table hands out the kernels that were asked for: the width proves which ones run.
TEST_P(StageTest, comesFromItsInstructionSet) {
  const Choice& choice = GetParam();
  constexpr size_t kLanesOf[] = {1, 4, 8, 16};
  const size_t lanes = choice.precision == Precision::doubled
                           ? findStages<double>(choice.isa, choice.precision, choice.specialization).lanes
                           : findStages<float>(choice.isa, choice.precision, choice.specialization).lanes;
  EXPECT_EQ(lanes, kLanesOf[static_cast<size_t>(choice.isa)]);
}

INSTANTIATE_TEST_SUITE_P(Kernels, StageTest, testing::ValuesIn(allChoices()),
                         [](const auto& instance) { return nameOf(instance.param); });

}  // namespace
}  // namespace wavecrest
