// Metropolis light transport against what is known, and against path tracing and bidirectional path tracing.
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "engine/scene/scene_error.h"
#include "tests/effort.h"
#include "tests/engine/metropolis_settings.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

double luminance(const float* rgb) {
  return 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) +
         0.0722 * static_cast<double>(rgb[2]);
}

double meanLuminance(const RgbImage& image) {
  double sum = 0;
  for (size_t i = 0; i < image.size(); i += 3) sum += luminance(&image[i]);
  return sum / (static_cast<double>(image.size()) / 3);
}

// What L = L_e (1 - rho^K) / (1 - rho) adds up to.
double series(double rho, uint32_t maxDepth) { return (1 - std::pow(rho, maxDepth)) / (1 - rho); }

struct MetropolisCase {
  MetropolisVariant variant;
  bool directPass;
};

class MetropolisTest : public testing::TestWithParam<MetropolisCase> {
 protected:
  RenderSettings settings() const {
    RenderSettings settings = metropolis(GetParam().variant);
    settings.metropolis.directPass = GetParam().directPass;
    return settings;
  }
  // The method whose image the variant's must be.
  static Method reference() { return GetParam().variant == MetropolisVariant::pssmlt ? Method::pt : Method::bpt; }

  void expectReference(const Scene& scene, const RenderSettings& chosen, uint64_t mutations, uint64_t paths) {
    RenderSettings other = chosen;
    other.method = reference();
    expectSameTruth(renderSeeds(scene, chosen, mutations), renderSeeds(scene, other, paths, 2000), scene.name);
  }
};

TEST_P(MetropolisTest, closedBoxForEachDepth) {
  for (const uint32_t maxDepth : {1u, 2u, 3u, 6u}) {
    const Scene scene = sceneFile("validation/closed-box", kWidth, kHeight, {{"albedo", "0.5"}});
    RenderSettings chosen = settings();
    chosen.limits.maxDepth = maxDepth;
    expectTruth(
        renderSeeds(scene, chosen, samples(64, 16)),
        [&](uint32_t, uint32_t, size_t) -> std::optional<double> { return series(0.5, maxDepth); },
        "K = " + std::to_string(maxDepth));
  }
}

TEST_P(MetropolisTest, closedBoxWithLongPaths) {
  const Scene scene = sceneFile("validation/closed-box", kWidth, kHeight, {{"albedo", "0.8"}});
  expectTruth(
      renderSeeds(scene, settings(), samples(96, 24)),
      [&](uint32_t, uint32_t, size_t) -> std::optional<double> { return series(0.8, kUnlimitedDepth); }, "albedo 0.8");
}

TEST_P(MetropolisTest, pointLightInADiffuseSphere) {
  const Scene scene = sceneFile("validation/point-in-sphere", kWidth, kHeight, {{"albedo", "0.5"}});
  expectTruth(
      renderSeeds(scene, settings(), samples(64, 16)),
      [&](uint32_t, uint32_t, size_t) -> std::optional<double> {
        return (series(0.5, kUnlimitedDepth) - 1) / std::numbers::pi;
      },
      "point light");
}

TEST_P(MetropolisTest, diffuseBoxIsThatOfPathTracing) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings other = defaults();
  expectSameTruth(renderSeeds(scene, settings(), samples(128, 32)), renderSeeds(scene, other, samples(128, 32), 2000),
                  scene.name);
}

TEST_P(MetropolisTest, parallelRaysSeeWhatThoseOfTheUnderlyingMethodDo) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  scene.sensor.kind = Sensor::Kind::orthographic;
  scene.sensor.toWorld = {{{278, 0, 0, 278}, {0, 278, 0, 273}, {0, 0, 1, -800}, {0, 0, 0, 1}}};
  if (settings().metropolis.variant == MetropolisVariant::pathspace) {
    EXPECT_THROW(Session::create(scene, settings()), SceneError) << "its perturbations turn rays about one point";
    return;
  }
  expectReference(scene, settings(), samples(128, 32), samples(128, 32));
}

TEST_P(MetropolisTest, causticIsThatOfTheUnderlyingMethod) {
  expectReference(sceneFile("cornell-mirror", kWidth, kHeight), settings(), samples(192, 48), samples(192, 48));
}

TEST_P(MetropolisTest, aSkyThatIsHiddenFromTheCameraLightsTheScene) {
  expectReference(sceneFile("features/hide-emitters", kWidth, kHeight), settings(), samples(192, 48), samples(192, 48));
}

TEST_P(MetropolisTest, everyPrecisionGivesTheSameImage) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  const SeedMeans expected = renderSeeds(scene, settings(), samples(64, 16));
  RenderSettings chosen = settings();
  chosen.precision = Precision::doubled;
  expectSameTruth(expected, renderSeeds(scene, chosen, samples(64, 16), 3000), "double");
}

// A crop window is rendered for itself: chains do not look elsewhere, and the image is the same there.
TEST_P(MetropolisTest, cropWindowShowsItsPartOfTheImage) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings other = settings();
  other.method = Method::pt;
  scene.film.cropX = 9;
  scene.film.cropY = 5;
  scene.film.cropWidth = 16;
  scene.film.cropHeight = 11;
  expectSameTruth(renderSeeds(scene, settings(), samples(256, 64)), renderSeeds(scene, other, samples(256, 64), 2000),
                  "crop");
}

// A narrow tent, whose sum over pixels is far from 1, and a wide Gaussian: what lies around the rectangle counts.
TEST_P(MetropolisTest, everyFilterShowsTheImageOfPathTracing) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings other = defaults();
  for (const bool gaussian : {false, true}) {
    scene.film.filter = gaussian ? ReconstructionFilter::gaussian : ReconstructionFilter::tent;
    scene.film.filterRadius = 0.7;
    scene.film.gaussianStddev = 0.9;
    expectSameTruth(renderSeeds(scene, settings(), samples(96, 24)), renderSeeds(scene, other, samples(128, 32), 2000),
                    gaussian ? "gaussian" : "tent");
  }
}

TEST_P(MetropolisTest, aFilterSeesWhatLiesAroundACropWindow) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings other = defaults();
  scene.film.cropX = 9;
  scene.film.cropY = 5;
  scene.film.cropWidth = 16;
  scene.film.cropHeight = 11;
  scene.film.filter = ReconstructionFilter::gaussian;
  expectSameTruth(renderSeeds(scene, settings(), samples(256, 64)), renderSeeds(scene, other, samples(256, 64), 2000),
                  "crop, gaussian");
}

TEST_P(MetropolisTest, aLensShowsTheImageOfPathTracing) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  scene.sensor.kind = Sensor::Kind::thinlens;
  scene.sensor.apertureRadius = 60;
  scene.sensor.focusDistance = 900;
  scene.film.filter = ReconstructionFilter::gaussian;
  if (settings().metropolis.variant == MetropolisVariant::pathspace) {
    EXPECT_THROW(Session::create(scene, settings()), SceneError) << "its perturbations turn rays about one point";
    return;
  }
  RenderSettings other = defaults();
  expectSameTruth(renderSeeds(scene, settings(), samples(128, 32)), renderSeeds(scene, other, samples(128, 32), 2000),
                  "lens");
}

// b is the mean luminance of the image; its error says how far off it may be.
class MetropolisOfAllLightTest : public MetropolisTest {};
TEST_P(MetropolisOfAllLightTest, brightnessIsThatOfTheImageWithinItsError) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings other = defaults();
  std::vector<double> truths;
  const SeedMeans seeds = renderSeeds(scene, other, samples(256, 64), 2000);
  for (const RgbImage& image : seeds.images) truths.push_back(meanLuminance(image));
  const double truth = std::accumulate(truths.begin(), truths.end(), 0.0) / kSeeds;
  double squares = 0;
  for (const double t : truths) squares += (t - truth) * (t - truth);
  const double truthError2 = squares / (kSeeds - 1) / kSeeds;
  double z2 = 0;
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    RenderSettings chosen = settings();
    chosen.metropolis.bootstrapSamples = static_cast<uint32_t>(samples(1 << 19, 1 << 17));
    chosen.seed = 4000 + seed;
    const auto session = Session::create(scene, chosen);
    session->renderUntil(1, std::nullopt);
    const ChainStatistics chains = *session->statistics().chains;
    EXPECT_GT(chains.brightnessError, 0);
    EXPECT_LT(chains.brightnessError, 0.1 * chains.brightness);
    const double error2 = chains.brightnessError * chains.brightnessError + truthError2;
    z2 += (chains.brightness - truth) * (chains.brightness - truth) / error2;
  }
  // Chi-square with 16 degrees of freedom: mean 16, standard deviation 5.7; too small would be a wrong error too.
  EXPECT_LT(z2, 16 + 6 * 5.7);
  EXPECT_GT(z2, 3);
}

// Three steps per chain are far from any equilibrium, and still unbiased: chains start where they should.
TEST_P(MetropolisTest, hasNoStartUpBias) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings few = settings();
  few.metropolis.chains = 4096;
  few.metropolis.bootstrapSamples = 8192;
  few.metropolis.restartSteps = 3;
  RenderSettings other = defaults();
  expectSameTruth(renderSeeds(scene, few, samples(96, 32)), renderSeeds(scene, other, samples(128, 32), 2000),
                  "restarts every third step");
}

// Chains count their visits to a state in floats.
TEST(Metropolis, epochsAreNoLongerThanVisitsAreCounted) {
  MetropolisSettings settings;
  EXPECT_EQ(epochSteps(settings, 131072), 16 * 131072 / settings.chains);
  settings.chains = 1;
  EXPECT_EQ(epochSteps(settings, uint64_t{1} << 28), uint64_t{1} << 24);
}

// Bootstraps are as many as a render is long, so that b is never what limits it: over nine epochs its error falls to a
// third.
TEST_P(MetropolisTest, errorOfBrightnessFallsAsARenderGoesOn) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  const auto session = Session::create(scene, settings());
  const uint64_t samples = settings().metropolis.bootstrapSamples, perEpoch = kMutationsPerBootstrapSample * samples;
  const auto after = [&](uint64_t epochs) {
    session->renderUntil(epochs * perEpoch / (kWidth * kHeight), std::nullopt);
    return *session->statistics().chains;
  };
  const ChainStatistics one = after(1), nine = after(9);
  EXPECT_EQ(one.epochs, 1u);
  EXPECT_EQ(nine.epochs, 9u);
  // An estimated error is itself off by a few percent.
  EXPECT_NEAR(nine.brightnessError / one.brightnessError, 1.0 / 3, 0.05);
  EXPECT_NEAR(nine.brightness, one.brightness, 6 * one.brightnessError);
}

TEST_P(MetropolisTest, largeStepsAloneArePlainMonteCarlo) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings independent = settings();
  independent.metropolis.largeStep = 1;
  RenderSettings other = defaults();
  expectSameTruth(renderSeeds(scene, independent, samples(96, 24)), renderSeeds(scene, other, samples(96, 24), 2000),
                  "large steps");
  const auto session = Session::create(scene, independent);
  session->renderUntil(4, std::nullopt);
  EXPECT_EQ(session->statistics().chains->counters.proposedOf(Mutation::small), 0u);
}

// The image's mean luminance is b by construction: every step splats a luminance of 1.
TEST_P(MetropolisOfAllLightTest, everyStepIsOnTheFilm) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  const auto session = Session::create(scene, settings());
  for (const uint64_t iterations : {1u, 7u}) {
    session->renderUntil(iterations, std::nullopt);
    const double b = session->statistics().chains->brightness;
    EXPECT_NEAR(meanLuminance(session->film().resolve()), b, 1e-5 * b) << iterations << " iterations";
  }
}

// Epochs are independent estimates of the image. The spread of whole renders over seeds is what the spread of the
// epochs within one predicts, tile by tile.
TEST_P(MetropolisTest, spreadOverSeedsIsThatPredictedWithinARender) {
  constexpr uint64_t kEpochs = 16, kSteps = 24;  // of 512 chains: 16 mutations per pixel
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings chosen = settings();
  chosen.metropolis.restartSteps = kSteps;
  const auto quarters = [](const RgbImage& image) {  // luminance in 4 x 4 tiles
    std::vector<double> sums(16, 0);
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      sums[i / kWidth / (kHeight / 4) * 4 + i % kWidth / (kWidth / 4)] += luminance(&image[3 * i]) / (kWidth * kHeight);
    }
    return sums;
  };
  double predicted = 0;
  std::vector<std::vector<double>> wholes;
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    chosen.seed = 5000 + seed;
    const auto session = Session::create(scene, chosen);
    std::vector<double> before(16, 0);
    std::vector<std::vector<double>> epochs;
    for (uint64_t epoch = 1; epoch <= kEpochs; ++epoch) {
      session->renderUntil(epoch * kSteps * 512 / (kWidth * kHeight), std::nullopt);
      std::vector<double> sum = quarters(session->film().resolve());
      for (double& s : sum) s *= static_cast<double>(epoch);
      epochs.push_back(sum);
      for (size_t i = 0; i < 16; ++i) epochs.back()[i] -= before[i];
      before = std::move(sum);
    }
    wholes.push_back(before);
    for (size_t i = 0; i < 16; ++i) {
      const double mean = before[i] / kEpochs;
      double squares = 0;
      for (const auto& epoch : epochs) squares += (epoch[i] - mean) * (epoch[i] - mean);
      predicted += squares / (kEpochs - 1) / kEpochs;  // variance of the mean
    }
  }
  double actual = 0;
  for (size_t i = 0; i < 16; ++i) {
    double mean = 0, squares = 0;
    for (const auto& whole : wholes) mean += whole[i] / kEpochs / kSeeds;
    for (const auto& whole : wholes) squares += (whole[i] / kEpochs - mean) * (whole[i] / kEpochs - mean);
    actual += squares / (kSeeds - 1) * kSeeds;
  }
  // The variance of 16 tiles over 16 seeds has about 240 degrees of freedom, fewer as tiles share b.
  EXPECT_NEAR(std::sqrt(actual / predicted), 1, 0.2);
}

std::string nameOf(const testing::TestParamInfo<MetropolisCase>& instance) {
  const auto name = kMetropolisVariantNames[static_cast<size_t>(instance.param.variant)];
  return std::string(name) + (instance.param.directPass ? "_direct_pass" : "");
}
INSTANTIATE_TEST_SUITE_P(Engine, MetropolisTest,
                         testing::Values(MetropolisCase{MetropolisVariant::pssmlt, false},
                                         MetropolisCase{MetropolisVariant::mmlt, false},
                                         MetropolisCase{MetropolisVariant::mmlt, true},
                                         MetropolisCase{MetropolisVariant::pathspace, false},
                                         MetropolisCase{MetropolisVariant::pathspace, true}),
                         nameOf);
// With a direct pass, b leaves out direct light.
INSTANTIATE_TEST_SUITE_P(Engine, MetropolisOfAllLightTest,
                         testing::Values(MetropolisCase{MetropolisVariant::pssmlt, false},
                                         MetropolisCase{MetropolisVariant::mmlt, false},
                                         MetropolisCase{MetropolisVariant::pathspace, false}),
                         nameOf);

// Two edges leave nothing to chains. Their steps, which then cost no time, do not run ahead of direct light.
TEST(Metropolis, directLightKeepsUpWithChainsThatHaveNone) {
  const Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  RenderSettings chosen = metropolis(MetropolisVariant::mmlt);
  chosen.metropolis.directPass = true;
  chosen.limits.maxDepth = 2;
  const auto session = Session::create(scene, chosen);
  session->renderUntil(std::nullopt, 0.2);
  const RenderStatistics statistics = session->statistics();
  constexpr uint64_t kPixels = uint64_t{kWidth} * kHeight;
  ASSERT_TRUE(statistics.chains);
  EXPECT_GT(statistics.chains->directPaths, 0u);
  EXPECT_GE(statistics.chains->directPaths + 4 * kPixels, statistics.chains->mutations / 2);
  EXPECT_EQ(session->progressPaths(), statistics.chains->mutations);
}

// A lamp fills half of the view, so half of all bootstraps of one sample are dark. The steps of a dark epoch do not
// tell how long those of the next one take.
TEST(Metropolis, timeLimitsTheEpochAfterADarkOne) {
  Scene scene;
  addShape(scene, Rectangle{{0, -1, 0}, {1, 0, 0}, {0, 2, 0}}, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, {1, 1, 1});
  setCamera(scene, {0, 0, 1}, 60, kWidth, kHeight);
  RenderSettings chosen = metropolis(MetropolisVariant::pssmlt);
  chosen.limits.maxDepth = 1;
  chosen.metropolis.bootstrapSamples = 1;
  // Find a seed whose first epoch is dark and whose second is lit. Here an iteration is a step, and a step an epoch.
  chosen.metropolis.chains = kWidth * kHeight;
  chosen.metropolis.restartSteps = 1;
  const auto isLitAfter = [&](uint64_t epochs) {
    const auto session = Session::create(scene, chosen);
    session->renderUntil(epochs, std::nullopt);
    return session->statistics().chains->brightness > 0;
  };
  while (isLitAfter(1) || !isLitAfter(2)) ASSERT_LT(++chosen.seed, 100u);
  // An epoch takes seconds.
  constexpr uint32_t kChains = 1 << 16, kSteps = 2000;
  chosen.metropolis.chains = kChains;
  chosen.metropolis.restartSteps = kSteps;
  const auto session = Session::create(scene, chosen);
  session->renderUntil(std::nullopt, 0.2);
  EXPECT_LT(session->statistics().chains->mutations, 2 * uint64_t{kSteps} * kChains);
}

TEST(Metropolis, rendersNothingWhereThereIsNoLight) {
  Scene scene = sceneFile("cornell-diffuse", kWidth, kHeight);
  scene.emitters.clear();
  for (Shape& shape : scene.shapes) shape.emitter = kNone;
  for (const MetropolisVariant variant :
       {MetropolisVariant::pssmlt, MetropolisVariant::mmlt, MetropolisVariant::pathspace}) {
    for (const float value : render(scene, metropolis(variant), 2)) EXPECT_EQ(value, 0.0f);
  }
}

}  // namespace
}  // namespace wavecrest
