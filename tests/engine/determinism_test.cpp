// The same image bit for bit, whatever the number of threads, the size of the waves and the way the iterations are cut
// into calls; and another image for another seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kUnevenWidth = 40, kUnevenHeight = 27;  // 1080 pixels: no multiple of any wave size below
constexpr uint64_t kFewIterations = 3;

bool sameBits(const RgbImage& a, const RgbImage& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

size_t differentPixels(const RgbImage& a, const RgbImage& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); i += 3) count += std::equal(&a[i], &a[i] + 3, &b[i]) ? 0 : 1;
  return count;
}

struct MethodVariant {
  Method method;
  Variant variant;
  MetropolisVariant metropolis;
};

std::string nameOf(const MethodVariant& v) {
  const std::string_view name =
      v.method == Method::mlt ? kMetropolisVariantNames[static_cast<size_t>(v.metropolis)] : toString(v.method);
  return std::string(name) + "_" + nameOf(v.variant);
}

// Path tracing in all variants, the other methods in the default one.
std::vector<MethodVariant> methodVariants() {
  std::vector<MethodVariant> list;
  for (const Variant& variant : allVariants()) list.push_back({Method::pt, variant, MetropolisVariant::mmlt});
  for (const MethodEntry& entry : kMethods) {
    if (entry.method == Method::pt) continue;
    if (entry.method == Method::mlt) {
      list.push_back(
          {entry.method, {Precision::floating, SamplerKind::independent, Accel::bvh}, MetropolisVariant::pssmlt});
      list.push_back(
          {entry.method, {Precision::floating, SamplerKind::independent, Accel::small}, MetropolisVariant::pathspace});
    }
    list.push_back(
        {entry.method, {Precision::floating, SamplerKind::independent, Accel::small}, MetropolisVariant::mmlt});
  }
  return list;
}

class DeterminismTest : public testing::TestWithParam<MethodVariant> {
 protected:
  DeterminismTest() : scene_(sceneFile("cornell-diffuse", kUnevenWidth, kUnevenHeight)) {}

  RenderSettings settings() const {
    RenderSettings settings = settingsFor(GetParam().variant);
    settings.method = GetParam().method;
    settings.balancedWalks = true;
    settings.metropolis.variant = GetParam().metropolis;
    settings.metropolis.chains = 500;
    settings.metropolis.bootstrapSamples = 4000;
    settings.metropolis.restartSteps = 4;  // so that iterations lie across a restart
    settings.threads = 1;
    settings.waveSize = 256;
    settings.seed = 5;
    return settings;
  }

  const Scene scene_;
};

TEST_P(DeterminismTest, anyNumberOfThreadsGivesTheSameImage) {
  RenderSettings chosen = settings();
  const RgbImage one = render(scene_, chosen, kFewIterations);
  for (const uint32_t threads : {2u, 3u}) {
    chosen.threads = threads;
    EXPECT_TRUE(sameBits(one, render(scene_, chosen, kFewIterations))) << threads << " threads";
  }
}

TEST_P(DeterminismTest, anySizeOfWavesGivesTheSameImage) {
  RenderSettings chosen = settings();
  const RgbImage expected = render(scene_, chosen, kFewIterations);
  for (const uint32_t waveSize : {64u, 1000u, 2048u}) {
    chosen.waveSize = waveSize;
    EXPECT_TRUE(sameBits(expected, render(scene_, chosen, kFewIterations))) << "waves of " << waveSize;
  }
}

TEST_P(DeterminismTest, iterationsInSeveralCallsGiveTheImageOfOne) {
  const auto session = Session::create(scene_, settings());
  for (uint64_t iterations = 1; iterations <= kFewIterations; ++iterations) {
    session->renderUntil(iterations, std::nullopt);
    EXPECT_EQ(session->statistics().iterations, iterations);
  }
  session->renderUntil(kFewIterations, std::nullopt);  // nothing left to do
  EXPECT_TRUE(sameBits(render(scene_, settings(), kFewIterations), session->film().resolve()));
}

// A stop by the clock falls anywhere; what has been done is not done again.
TEST_P(DeterminismTest, stopsByTheClockChangeNothing) {
  const auto session = Session::create(scene_, settings());
  for (int stop = 1; stop <= 5; ++stop) session->renderUntil(kFewIterations, 1e-3 * stop);
  session->renderUntil(kFewIterations, std::nullopt);
  EXPECT_TRUE(sameBits(render(scene_, settings(), kFewIterations), session->film().resolve()));
}

TEST_P(DeterminismTest, seedsDiffer) {
  RenderSettings chosen = settings();
  chosen.radius = 0.05;  // so that pure merging finds photons at most pixels
  const RgbImage first = render(scene_, chosen, kFewIterations);
  chosen.seed = 6;
  EXPECT_GT(differentPixels(first, render(scene_, chosen, kFewIterations)), kUnevenWidth * kUnevenHeight / 2);
}

INSTANTIATE_TEST_SUITE_P(Engine, DeterminismTest, testing::ValuesIn(methodVariants()),
                         [](const auto& instance) { return nameOf(instance.param); });

// Path tracing takes up to sixteen iterations of a pixel at a time, but no more than it has done, and from a multiple
// of their number on: here 1, 1, 1, 2, 2, 4, 8, 8, 16, 16 and 1.
class IterationsTogetherTest : public testing::TestWithParam<SamplerKind> {
 protected:
  static constexpr uint64_t kMany = 60;
  IterationsTogetherTest() {
    settings_.threads = 2;
    settings_.waveSize = 250;
    settings_.seed = 5;
    settings_.firstIteration = 5;
  }
  const Scene scene_ = sceneFile("cornell-diffuse", kUnevenWidth, kUnevenHeight);
  RenderSettings settings_ = settingsFor({Precision::floating, GetParam(), Accel::automatic});
};

TEST_P(IterationsTogetherTest, giveTheImageOfOneByOne) {
  const auto oneByOne = Session::create(scene_, settings_);
  for (uint64_t iterations = 1; iterations <= kMany; ++iterations) oneByOne->renderUntil(iterations, std::nullopt);
  EXPECT_TRUE(sameBits(oneByOne->film().resolve(), render(scene_, settings_, kMany)));
}

TEST_P(IterationsTogetherTest, stopsByTheClockChangeNothing) {
  const auto session = Session::create(scene_, settings_);
  uint64_t partial = 0;
  for (int stop = 1; stop <= 20; ++stop) {
    // From where it stands: sanitized waves take so long that the first would be over time for all that follow.
    session->renderUntil(kMany, session->progressSeconds() + 1e-3);
    partial += session->statistics().paths % (kUnevenWidth * kUnevenHeight) != 0 ? 1 : 0;
  }
  EXPECT_GT(partial, 0u) << "the clock never stopped within an iteration";
  session->renderUntil(kMany, std::nullopt);
  EXPECT_EQ(session->statistics().paths, kMany * kUnevenWidth * kUnevenHeight);
  EXPECT_TRUE(sameBits(render(scene_, settings_, kMany), session->film().resolve()));
}

INSTANTIATE_TEST_SUITE_P(Engine, IterationsTogetherTest, testing::ValuesIn(kAllSamplerKinds),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

}  // namespace
}  // namespace wavecrest
