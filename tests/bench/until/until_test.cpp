// Renders end when they resemble the reference, or at their settings' end.
#include "bench/until/until.h"

#include <gtest/gtest.h>

#include "bench/film_image.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

PreparedReference referenceOf(const Scene& scene) {
  const auto session = Session::create(scene, settingsOf(Method::pt, 1000));
  session->renderUntil(2048, std::nullopt);
  return {"reference", {filmImage(*session), Encoding::linear, {}}};
}

// The SSIM of a render of its own with so many iterations.
double ssimAfter(const Scene& scene, const PreparedReference& reference, uint64_t iterations) {
  const auto session = Session::create(scene, settingsOf(Method::pt, 1));
  session->renderUntil(iterations, std::nullopt);
  return reference.ssim()
      .compare(reference.prepareTest("test", {filmImage(*session), Encoding::linear, {}}).codes)
      .mean;
}

TEST(UntilSsim, endsAtTheFirstLookThatResemblesTheReference) {
  const Scene scene = smallBox(32, 24);
  const PreparedReference reference = referenceOf(scene);
  const auto session = Session::create(scene, settingsOf(Method::pt, 1));
  const SsimNow now = renderUntilSsim(*session, settingsOf(Method::pt, 1), {.reference = reference, .ssim = 0.9});
  EXPECT_TRUE(now.reached);
  EXPECT_EQ(now.ssim, ssimAfter(scene, reference, now.iterations));
  ASSERT_TRUE(now.ssim);
  EXPECT_GE(*now.ssim, 0.9);
  ASSERT_GT(now.iterations, 8u);
  EXPECT_LT(ssimAfter(scene, reference, now.iterations * 3 / 4), 0.9);  // looks are a quarter apart at most
}

TEST(UntilSsim, endsAtTheIterationsOfTheSettingsUnreached) {
  const Scene scene = smallBox(32, 24);
  const PreparedReference reference = referenceOf(scene);
  RenderSettings settings = settingsOf(Method::pt, 1);
  settings.iterations = 7;
  const auto session = Session::create(scene, settings);
  const SsimNow now = renderUntilSsim(*session, settings, {.reference = reference, .ssim = 0.999});
  EXPECT_FALSE(now.reached);
  EXPECT_EQ(now.iterations, 7u);
  EXPECT_EQ(now.ssim, ssimAfter(scene, reference, 7));
}

TEST(UntilSsim, isNotKnownBeforeTheFirstWholeImage) {
  const Scene scene = smallBox(32, 24);
  const PreparedReference reference = referenceOf(scene);
  RenderSettings settings = settingsOf(Method::pt, 1);
  settings.seconds = 0;
  const auto session = Session::create(scene, settings);
  const SsimNow now = renderUntilSsim(*session, settings, {.reference = reference, .ssim = 1e-9});
  EXPECT_EQ(now.iterations, 0u);
  EXPECT_FALSE(now.ssim);
  EXPECT_FALSE(now.reached);
}

TEST(UntilSsim, goesOnWithTheFirstLookThatIsAhead) {
  const Scene scene = smallBox(32, 24);
  const PreparedReference reference = referenceOf(scene);
  const auto session = Session::create(scene, settingsOf(Method::pt, 1));
  session->renderUntil(9, std::nullopt);  // between the looks at 8 and 10
  const SsimNow now = renderUntilSsim(*session, settingsOf(Method::pt, 1), {.reference = reference, .ssim = 1e-9});
  EXPECT_TRUE(now.reached);
  EXPECT_EQ(now.iterations, 10u);
}

}  // namespace
}  // namespace wavecrest
