// The workload's images: the same on any number of threads, and different for any change of what is computed.
#include "bench/score/workload.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/score/score.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

constexpr uint64_t kIterations = 16;  // of which two are validated

ScoreEntry smallEntry(Method method) {
  return {.scene = "cornell-diffuse", .method = method, .width = 64, .height = 48, .iterations = kIterations};
}

// Of the image after the first slice.
uint64_t imageHashOf(const Scene& scene, const ScoreEntry& entry, uint32_t threads) {
  return hashImage(validatedImage(scene, entry, bestIsa(), threads).pixels);
}

class ScoreImageTest : public testing::TestWithParam<Method> {};

TEST_P(ScoreImageTest, isTheSameOnAnyNumberOfThreads) {
  const Scene scene = smallBox(64, 48);
  const ScoreEntry entry = smallEntry(GetParam());
  const uint64_t one = imageHashOf(scene, entry, 1);
  for (const uint32_t threads : {2u, 3u, 7u}) EXPECT_EQ(imageHashOf(scene, entry, threads), one) << threads;
}

// A constant that is wrong by a part in a million: the albedo of one wall.
TEST_P(ScoreImageTest, isAnotherOneIfAConstantIsWrong) {
  const ScoreEntry entry = smallEntry(GetParam());
  Scene scene = smallBox(64, 48);
  const uint64_t right = imageHashOf(scene, entry, 2);
  const auto isDiffuse = [](const Material& material) { return std::holds_alternative<Diffuse>(material.kind); };
  const auto wall = std::find_if(scene.materials.begin(), scene.materials.end(), isDiffuse);
  ASSERT_NE(wall, scene.materials.end());
  std::get<Diffuse>(wall->kind).reflectance.value[0] *= 1 + 1e-6;
  EXPECT_NE(imageHashOf(scene, entry, 2), right);
}

INSTANTIATE_TEST_SUITE_P(Methods, ScoreImageTest,
                         testing::Values(Method::pt, Method::lt, Method::bpt, Method::mlt, Method::ppm, Method::bpm,
                                         Method::vcm),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// The program's own defaults are others.
TEST(Workload, processesRenderWithTheSettingsOfThreads) {
  const Scene scene = smallBox(16, 12);
  const auto options = [&](Method method) {
    std::string text;
    for (const std::string& word : optionsOf(scoreSettings(scene, smallEntry(method), Isa::scalar, 1))) {
      text += word + " ";
    }
    return text;
  };
  const std::string all = "--isa scalar --precision float --sampler independent ";
  EXPECT_EQ(options(Method::mlt), all);
  EXPECT_EQ(options(Method::pt), all + "--roulette throughput ");
  EXPECT_EQ(options(Method::ppm), all + "--roulette throughput --radius 0.001 ");
  EXPECT_EQ(options(Method::vcm), all + "--roulette throughput --radius 0.001 --merge-vertices all ");
}

TEST(Workload, hasEveryScoredMethodOnEveryScene) {
  EXPECT_EQ(workloadOf(ScoreSize::small).size(), 4 * kScoredMethods);
  for (const ScoreSize size : {ScoreSize::medium, ScoreSize::large}) {
    EXPECT_EQ(workloadOf(size).size(), 9 * kScoredMethods);
  }
}

}  // namespace
}  // namespace wavecrest
