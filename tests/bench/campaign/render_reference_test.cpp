// References grow by whole iterations of fresh random numbers, from call to call, until their goal.
#include "bench/campaign/render_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "bench/until/film_error.h"
#include "tests/bench/campaign/small_references.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using test::settingsOf, test::iterations;

Scene tinyScene(const char* name = "cornell-diffuse") { return test::sceneOf(32, 24, name); }

class RenderReferenceTest : public testing::TestWithParam<Method> {
 protected:
  Reference render(uint64_t count, const ReferenceHooks& hooks = {}) const {
    return renderReference(scene_, settingsOf(GetParam()), "test", iterations(count), file_, hooks);
  }
  const test::TemporaryFolder folder_;
  const std::string file_ = folder_.path("r.exr");
  const Scene scene_ = tinyScene();
};

TEST_P(RenderReferenceTest, goesOnWhereItWas) {
  const Reference two = render(2), three = render(3);
  EXPECT_EQ(two.info.iterations, 2u);
  EXPECT_EQ(three.info.iterations, 3u);
  EXPECT_GT(three.info.renderSeconds, two.info.renderSeconds);
  // What the third iteration added is an image of its own: no sample of it is negative, but for rounding, as it would
  // be if the parts were weighted wrongly; and it is not a repetition of the first two.
  size_t negative = 0, repeated = 0;
  for (const bool first : {true, false}) {
    const Image before = first ? two.halfA() : two.halfB(), after = first ? three.halfA() : three.halfB();
    for (size_t i = 0; i < before.pixels.size(); ++i) {
      const double third = 3.0 * after.pixels[i] - 2.0 * before.pixels[i];
      // Twice what the file rounds off the half difference that the third iteration was added to.
      const double stored = 2 * 0x1p-12 * std::abs(two.difference->pixels[i]);
      const double rounding = 1e-5 + 1e-3 * before.pixels[i] + stored;
      if (third < -rounding) ++negative;
      if (before.pixels[i] > 0 && std::abs(third - before.pixels[i]) < rounding) ++repeated;
    }
  }
  EXPECT_EQ(negative, 0u);
  EXPECT_LT(repeated, 2u * 3 * 32 * 24 / 20);
}

// To what the file rounds off: means to float, half differences to half floats.
TEST_P(RenderReferenceTest, inPartsIsThatOfOneRender) {
  for (const uint64_t count : {1u, 2u, 5u}) render(count);
  const Reference parts = render(9);
  std::filesystem::remove(file_);
  const Reference whole = render(9);
  for (size_t i = 0; i < whole.mean.pixels.size(); ++i) {
    const float stored = 0x1p-10f * std::abs(whole.difference->pixels[i]);
    ASSERT_NEAR(parts.mean.pixels[i], whole.mean.pixels[i], 1e-5f * whole.mean.pixels[i] + stored) << i;
  }
}

TEST_P(RenderReferenceTest, aReachedGoalRendersNothing) {
  const Reference once = render(2);
  const auto written = std::filesystem::last_write_time(file_);
  const Reference again = render(2), less = render(1);
  EXPECT_EQ(std::filesystem::last_write_time(file_), written);
  EXPECT_EQ(again.mean.pixels, once.mean.pixels);
  EXPECT_EQ(less.info.iterations, 2u);
}

INSTANTIATE_TEST_SUITE_P(Methods, RenderReferenceTest, testing::Values(Method::pt, Method::bpt, Method::vcm),
                         [](const auto& method) { return std::string(toString(method.param)); });

TEST(RenderReference, halvesAreIndependentAndRepeat) {
  const test::TemporaryFolder folder;
  const Scene scene = tinyScene();
  const auto render = [&](const char* name) {
    return renderReference(scene, settingsOf(Method::pt), "test", iterations(2), folder.path(name), {});
  };
  const Reference first = render("a.exr"), second = render("b.exr");
  EXPECT_EQ(first.mean.pixels, second.mean.pixels);
  EXPECT_EQ(first.difference->pixels, second.difference->pixels);
  const auto differing =
      std::count_if(first.difference->pixels.begin(), first.difference->pixels.end(), [](float d) { return d != 0; });
  EXPECT_GT(differing, 3 * 32 * 24 / 2);
}

TEST(RenderReference, stopsAtARelativeError) {
  const test::TemporaryFolder folder;
  const ReferenceGoal goal{.relativeError = 0.15, .seconds = std::nullopt, .iterations = std::nullopt};
  const Reference reference =
      renderReference(tinyScene(), settingsOf(Method::pt), "test", goal, folder.path("r.exr"), {});
  EXPECT_LE(reference.info.relativeError, 0.15);
  EXPECT_GT(reference.info.iterations, 1u);
  EXPECT_FALSE(reference.noiseFloors.empty());
}

TEST(RenderReference, anErrorCountsAfterAFewIterations) {
  const test::TemporaryFolder folder;
  const ReferenceGoal goal{.relativeError = 1e3, .seconds = std::nullopt, .iterations = std::nullopt};
  const Reference reference =
      renderReference(tinyScene(), settingsOf(Method::pt), "test", goal, folder.path("r.exr"), {});
  EXPECT_GE(reference.info.iterations, 8u);
}

TEST(RenderReference, aBlackImageHasNoErrorAndEndsWhereThatIsTheGoal) {
  const test::TemporaryFolder folder;
  const std::string dark = folder.path("dark.xml");
  std::ofstream(dark) << R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/></scene>)";
  const Scene scene = test::sceneOf(16, 12, dark.c_str());
  const ReferenceGoal goal{.relativeError = 0.5, .seconds = std::nullopt, .iterations = std::nullopt};
  for (int call = 0; call < 2; ++call) {  // also where it goes on
    const Reference reference = renderReference(scene, settingsOf(Method::pt), "test", goal, folder.path("r.exr"), {});
    EXPECT_GE(reference.info.iterations, kBlackIterations);
    EXPECT_TRUE(isBlack(reference.mean.pixels));
  }
}

TEST(RenderReference, anotherReferenceIsNotContinued) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path("r.exr");
  const Scene scene = tinyScene();
  renderReference(scene, settingsOf(Method::pt), "test", iterations(1), file, {});
  RenderSettings otherSeed = settingsOf(Method::pt), otherDepth = settingsOf(Method::pt);
  otherSeed.seed = 5;
  otherDepth.limits.maxDepth = 3;
  EXPECT_THROW(renderReference(scene, otherSeed, "test", iterations(2), file, {}), ReferenceMismatch);
  EXPECT_THROW(renderReference(scene, otherDepth, "test", iterations(2), file, {}), ReferenceMismatch);
  EXPECT_THROW(renderReference(scene, settingsOf(Method::bpt), "test", iterations(2), file, {}), ReferenceMismatch);
  EXPECT_THROW(renderReference(tinyScene("cornell-mirror"), settingsOf(Method::pt), "test", iterations(2), file, {}),
               ReferenceMismatch);
}

TEST(RenderReference, valuesThatAreNotFiniteDoNotGoOn) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path("r.exr");
  const Scene scene = tinyScene();
  const Reference whole = renderReference(scene, settingsOf(Method::pt), "test", iterations(1), file, {});
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Reference broken = whole;
    broken.mean.pixels[7] = value;
    writeReference(file, broken);
    EXPECT_THROW(renderReference(scene, settingsOf(Method::pt), "test", iterations(2), file, {}), ReferenceMismatch);
    broken = whole;
    broken.difference->pixels[7] = value;
    writeReference(file, broken);
    EXPECT_THROW(renderReference(scene, settingsOf(Method::pt), "test", iterations(2), file, {}), ReferenceMismatch);
  }
}

TEST(RenderReference, hasSeedsThatNoCampaignHas) {
  std::set<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    for (const size_t half : {0u, 1u}) {
      const uint64_t own = referenceSeed(seed, half);
      EXPECT_GE(own, uint64_t{1} << 32);
      seeds.insert(own);
    }
  }
  EXPECT_EQ(seeds.size(), 100u * 2) << "and no two alike";
}

TEST(RenderReference, aStopKeepsWholeIterationsOfBothHalves) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path("r.exr");
  const Scene scene = tinyScene();
  int watched = 0;
  // Stops in the second round, after its first half.
  const ReferenceHooks hooks{.session = {.watch = [&](Session* session) { watched += session != nullptr ? 1 : 0; }},
                             .stopped = [&] { return watched >= 3; },
                             .saveNow = {},
                             .advance = {}};
  const Reference stopped = renderReference(scene, settingsOf(Method::pt), "test", iterations(1000), file, hooks);
  EXPECT_EQ(stopped.info.iterations, 1u);
  EXPECT_EQ(readReference(file).mean.pixels, stopped.mean.pixels);
}

}  // namespace
}  // namespace wavecrest
