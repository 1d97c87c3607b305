// A small reference from a larger one is what a render of the small film would have been.
#include "bench/campaign/shrunk_reference.h"

#include <gtest/gtest.h>

#include "bench/campaign/reference_agreement.h"
#include "engine/scene/hash_text.h"
#include "tests/bench/campaign/small_references.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using test::sceneOf, test::settingsOf;

class ShrunkReferenceTest : public testing::TestWithParam<Method> {
 protected:
  // Of so many iterations of each half.
  Reference render(const Scene& scene, uint64_t iterations, const std::string& name) const {
    return renderReference(scene, settingsOf(GetParam()), "test", test::iterations(iterations), folder_.path(name), {});
  }
  void begin(const Scene& scene, const std::string& larger, const std::string& name) const {
    beginReference(scene, settingsOf(GetParam()), folder_.path(larger), folder_.path(name));
  }
  const test::TemporaryFolder folder_;
  const Scene large_ = sceneOf(256, 192), small_ = sceneOf(64, 48);
};

TEST_P(ShrunkReferenceTest, isOfTheSameTruthAndNoiseAsARenderOfItsSize) {
  const Reference larger = render(large_, 2, "larger.exr");
  const Reference own = render(small_, 2 * 16, "own.exr");
  const Reference shrunk = shrunkReference(larger, small_);
  EXPECT_EQ(shrunk.mean.width, 64u);
  EXPECT_EQ(shrunk.mean.height, 48u);
  EXPECT_EQ(shrunk.info.iterations, own.info.iterations);
  EXPECT_EQ(shrunk.info.sceneHash, own.info.sceneHash);
  const Agreement agreement = compareReferences(shrunk, own);
  EXPECT_TRUE(agreement.agrees()) << agreement.describe();
  // As many samples a pixel, hence about the same error.
  EXPECT_NEAR(shrunk.info.relativeError / own.info.relativeError, 1, 0.2);
  EXPECT_NEAR(shrunk.noiseFloors.at("ssim"), own.noiseFloors.at("ssim"), 0.1);
}

TEST_P(ShrunkReferenceTest, goesOn) {
  render(large_, 1, "larger.exr");
  begin(small_, "larger.exr", "r.exr");
  const Reference begun = readReference(folder_.path("r.exr"));
  const Reference more = render(small_, 64, "r.exr");
  EXPECT_EQ(begun.info.iterations, 16u);
  EXPECT_EQ(more.info.iterations, 64u);
  // Four times the samples halve the error, about, as single bright samples of bpt are much of it.
  EXPECT_GT(begun.info.relativeError, 1.3 * more.info.relativeError) << "the samples are not new ones";
  const Agreement agreement = compareReferences(more, render(small_, 64, "own.exr"));
  EXPECT_TRUE(agreement.agrees()) << agreement.describe();
  EXPECT_THROW(begin(small_, "larger.exr", "r.exr"), ReferenceMismatch) << "there is one already";
}

INSTANTIATE_TEST_SUITE_P(Methods, ShrunkReferenceTest, testing::Values(Method::pt, Method::lt, Method::bpt),
                         [](const auto& method) { return std::string(toString(method.param)); });

// A reference of a grey film, without noise.
Reference grey(const Scene& scene, uint32_t width, uint32_t height) {
  const Image image{
      .width = width, .height = height, .channels = 3, .pixels = std::vector<float>(3 * width * height, 1)};
  Reference reference{.mean = image, .difference = image, .info = {}, .noiseFloors = {}};
  reference.info.sceneHash = hashText(scene.hash);
  return reference;
}

void expectRefused(const Reference& larger, const Scene& scene, const std::string& why) {
  try {
    shrunkReference(larger, scene);
    FAIL() << "expected: " << why;
  } catch (const ShrinkError& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(ShrunkReference, blocksAreAveraged) {
  const Scene small = sceneOf(16, 12);
  Reference larger = grey(sceneOf(32, 24), 32, 24);
  for (size_t i = 0; i < larger.mean.pixels.size(); ++i) larger.mean.pixels[i] = static_cast<float>(i);
  const Reference shrunk = shrunkReference(larger, small);
  // Pixel (3, 2), green: columns 6 and 7 of rows 4 and 5.
  const double expected =
      ((4 * 32 + 6) * 3 + 1 + (4 * 32 + 7) * 3 + 1 + (5 * 32 + 6) * 3 + 1 + (5 * 32 + 7) * 3 + 1) / 4.0;
  EXPECT_FLOAT_EQ(shrunk.mean.pixels[(2 * 16 + 3) * 3 + 1], static_cast<float>(expected));
}

TEST(ShrunkReference, refusesWhatCannotBeShrunk) {
  const Scene small = sceneOf(16, 12);
  expectRefused(grey(sceneOf(40, 30), 40, 30), small, "40x30 pixels; expected a whole multiple of 16x12");
  expectRefused(grey(sceneOf(32, 36), 32, 36), small, "whole multiple");
  expectRefused(grey(small, 16, 12), small, "whole multiple");
  expectRefused(grey(sceneOf(32, 24, "cornell-mirror"), 32, 24), small, "of this cornell-diffuse");
  Reference wrong = grey(sceneOf(32, 24), 32, 24);
  wrong.info.radius = 1e-3;
  expectRefused(wrong, small, "merges");
  wrong = grey(sceneOf(32, 24), 32, 24);
  wrong.info.samples = ReferenceInfo::kCompactSamples;
  expectRefused(wrong, small, "compact");
  wrong = grey(sceneOf(32, 24), 32, 24);
  wrong.difference.reset();
  expectRefused(wrong, small, "plain image");
  Scene filtered = small;
  filtered.film.filter = ReconstructionFilter::gaussian;
  expectRefused(grey(sceneOf(32, 24), 32, 24), filtered, "box filter");
}

}  // namespace
}  // namespace wavecrest
