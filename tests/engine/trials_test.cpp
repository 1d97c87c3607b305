// evcm and gpt: what trials make of images, and what they choose.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "engine/pilot/finished_plan.h"
#include "engine/session/session.h"
#include "engine/trials/choose_method.h"
#include "engine/trials/trial_error.h"
#include "engine/waves/wave_session.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 32;

// An image whose pixels are `value` with this chance, and black otherwise.
std::vector<float> rareImage(std::mt19937& random, float value, double chance) {
  std::vector<float> image(3 * kSide * kSide);
  std::bernoulli_distribution found(chance);
  for (size_t i = 0; i < image.size(); i += 3) image[i] = image[i + 1] = image[i + 2] = found(random) ? value : 0;
  return image;
}

TrialImages imagesOf(float value, double chance, uint64_t iterations = 1) {
  std::mt19937 random(7);
  TrialImages images(kSide, kSide);
  const std::vector<float> first = rareImage(random, value, chance);
  images.add(first, rareImage(random, value, chance), iterations);
  return images;
}

TEST(TrialError, isTheRelativeVarianceOfOneIteration) {
  // A pixel of 2 or 0, evenly, has the mean 1 and the variance 1. It is that of one iteration, so images of four have
  // four times that.
  for (const uint64_t iterations : {uint64_t{1}, uint64_t{4}}) {
    const std::array candidates{imagesOf(2, 0.5, iterations), imagesOf(1, 1, iterations)};
    const std::vector<TrialError> errors = trialErrors(candidates);
    EXPECT_NEAR(errors[0].variance, static_cast<double>(iterations), 0.1 * static_cast<double>(iterations));
    EXPECT_EQ(errors[1].variance, 0);
    EXPECT_NEAR(errors[0].missed, 0, 0.1 * static_cast<double>(iterations));
  }
}

TEST(TrialError, doesNotDependOnTheUnitOfLight) {
  const std::array dim{imagesOf(2e-4f, 0.5), imagesOf(1e-4f, 1)}, bright{imagesOf(2e4f, 0.5), imagesOf(1e4f, 1)};
  EXPECT_NEAR(trialErrors(dim)[0].variance, trialErrors(bright)[0].variance, 1e-4);
}

TEST(TrialError, countsLightThatWasNotFound) {
  // The second misses half of what the first is sure of: per tile n f^2 with n = 64 pixels x 2 iterations, f = 1/2.
  const std::array candidates{imagesOf(2, 1), imagesOf(1, 1)};
  const std::vector<TrialError> errors = trialErrors(candidates);
  EXPECT_EQ(errors[0].missed, 0);
  EXPECT_NEAR(errors[1].missed, 64 * 2 * 0.25, 0.1);
}

TEST(TrialError, countsAllLightWhereNoneWasFound) {
  // So rare that the others are not sure of it either.
  const std::array candidates{imagesOf(1, 0), imagesOf(100, 0.01)};
  const std::vector<TrialError> errors = trialErrors(candidates);
  EXPECT_EQ(errors[0].variance, 0);
  EXPECT_GT(errors[0].missed, 0.5 * errors[1].variance);
  EXPECT_EQ(errors[1].missed, 0);
}

TEST(TrialError, isZeroOfBlackImages) {
  const std::array candidates{imagesOf(0, 1), imagesOf(0, 1)};
  EXPECT_EQ(candidates[0].brightness(), 0);
  for (const TrialError& error : trialErrors(candidates)) EXPECT_EQ(error.variance + error.missed, 0);
}

TEST(TrialError, leavesTheNoisiestPixelsOut) {
  std::vector<float> plain(3 * kSide * kSide, 1), firefly = plain;
  firefly[0] = firefly[1] = firefly[2] = 1000;
  TrialImages images(kSide, kSide);
  images.add(plain, firefly, 1);
  EXPECT_EQ(images.variance(0), 0);
  EXPECT_GT(images.standardError(0), 1);
}

RenderSettings triedSettings(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  takeProgramDefaults(settings);
  settings.sampler = bestSampler(settings);
  return settings;
}

RenderSettings evcmSettings() { return triedSettings(Method::evcm); }

MethodChoice choiceFor(const Scene& scene, const RenderSettings& settings = evcmSettings()) {
  return *chooseMethod<float>(scene, settings).choice;
}

TEST(Evcm, neverChoosesAMethodThatWasLeftOut) {
  // Short trials look good where they have not met a rare bright path.
  const std::vector<MethodTrial> trials{{.method = Method::pt, .iterations = 10, .variance = 1, .cost = 1},
                                        {.method = Method::bpt, .iterations = 42, .variance = 3, .cost = 1},
                                        {.method = Method::vcm, .iterations = 42, .variance = 2, .cost = 1}};
  EXPECT_EQ(bestOf(trials).method, Method::vcm);
}

TEST(Evcm, choosesByTheScene) {
  EXPECT_EQ(choiceFor(sceneFile("cornell-diffuse", 64, 48)).method, Method::pt);
  EXPECT_EQ(choiceFor(sceneFile("cornell-glossy", 64, 48)).method, Method::bpt);
  // Caustics seen in a mirror: only merges make them.
  EXPECT_EQ(choiceFor(sceneFile("cornell-spheres", 64, 48)).method, Method::vcm);
}

// Trials of evcm draw independent samples. The render has less variance by Sobol points, where they serve the method.
TEST(Evcm, countsWhatMethodsGainBySobolPoints) {
  const Scene scene = sceneFile("cornell-diffuse", 64, 48);  // no candidate is far behind the best
  RenderSettings settings = evcmSettings();
  ASSERT_EQ(settings.sampler, SamplerKind::sobol);
  const MethodChoice bySobol = choiceFor(scene, settings);
  settings.sampler = SamplerKind::independent;
  const MethodChoice byIndependent = choiceFor(scene, settings);
  ASSERT_EQ(bySobol.trials.size(), 4u);
  for (size_t i = 0; i < bySobol.trials.size(); ++i) {
    const MethodTrial &sobol = bySobol.trials[i], &independent = byIndependent.trials[i];
    const double gain = sobol.method == Method::lt ? 1 : 1.15;
    EXPECT_EQ(sobol.iterations, independent.iterations) << toString(sobol.method);
    EXPECT_NEAR(independent.variance / sobol.variance, gain, 1e-9) << toString(sobol.method);
    EXPECT_EQ(independent.missed, sobol.missed) << toString(sobol.method);
  }
}

TEST(Trials, areTheSameForAnySeedThreadsAndWaves) {
  const Scene scene = sceneFile("cornell-mirror", 64, 48);
  for (const Method method : {Method::evcm, Method::gpt}) {
    const MethodChoice choice = choiceFor(scene, triedSettings(method));
    RenderSettings other = triedSettings(method);
    other.seed = 9;
    other.threads = 3;
    other.waveSize = 512;
    other.iterations = 7;
    other.seconds = 1;
    const MethodChoice same = choiceFor(scene, other);
    EXPECT_EQ(same.method, choice.method);
    ASSERT_EQ(same.trials.size(), choice.trials.size());
    for (size_t i = 0; i < choice.trials.size(); ++i) {
      EXPECT_EQ(same.trials[i].inefficiency(), choice.trials[i].inefficiency()) << i;
      EXPECT_EQ(same.trials[i].iterations, choice.trials[i].iterations) << i;
    }
  }
}

TEST(Gpt, takesAGuideWhereItPays) {
  const RenderSettings settings = triedSettings(Method::gpt);
  // Nearly all surfaces see the lamp, which next event estimation finds; and a box with the caustic of a mirror, which
  // only directions find.
  EXPECT_EQ(choiceFor(sceneFile("cornell-diffuse", 64, 48), settings).method, Method::pt);
  EXPECT_EQ(choiceFor(sceneFile("cornell-mirror", 64, 48), settings).method, Method::gpt);
}

TEST(Gpt, isNotTriedWhereItsGuideIsGiven) {
  for (const GuideTarget guide : {GuideTarget::radiance, GuideTarget::variance, GuideTarget::off}) {
    RenderSettings settings = triedSettings(Method::gpt);
    settings.guide = guide;
    const auto session = Session::create(sceneFile("cornell-diffuse", 8, 6), settings);
    EXPECT_FALSE(session->statistics().choice);
    EXPECT_EQ(session->statistics().guide.has_value(), guide != GuideTarget::off);
  }
}

TEST(Evcm, looksAtNoMoreThanASmallImage) {
  // The variances of a pixel are about the same at every size; the trials of a large film cost no more.
  const MethodChoice small = choiceFor(sceneFile("cornell-diffuse", 64, 48)),
                     large = choiceFor(sceneFile("cornell-diffuse", 1024, 768));
  for (size_t i = 0; i < small.trials.size(); ++i) {
    EXPECT_EQ(large.trials[i].inefficiency(), small.trials[i].inefficiency()) << i;
  }
}

TEST(Evcm, isNotHeldToTheBudgetOfASmallFilm) {
  const Scene scene = sceneFile("cornell-diffuse", 16, 12);
  RenderSettings settings = evcmSettings();
  RenderSettings vcm = settings;
  vcm.method = Method::vcm;
  settings.memoryBytes = planMemory(scene, vcm).use.total();
  EXPECT_EQ(choiceFor(scene, settings).method, choiceFor(scene).method);
}

// Searches of trials are as on a film of 256x192, for which they scale the light paths.
TEST(Evcm, takesAsManyLightPathsOnASmallFilmAsVcm) {
  RenderSettings settings = evcmSettings();
  settings.lightPaths = 6000;
  EXPECT_GT(choiceFor(sceneFile("cornell-diffuse", 1, 1), settings).trials.size(), 0u);
}

// Under a filter that spreads, all paths of an iteration share one place in their pixels.
TEST(Trials, doNotDependOnTheFilter) {
  Scene scene = sceneFile("cornell-mirror", 64, 48);
  const MethodChoice box = choiceFor(scene, triedSettings(Method::gpt));
  scene.film.filter = ReconstructionFilter::gaussian;
  scene.film.filterRadius = 2;
  const MethodChoice gaussian = choiceFor(scene, triedSettings(Method::gpt));
  for (size_t i = 0; i < box.trials.size(); ++i) {
    EXPECT_EQ(gaussian.trials[i].inefficiency(), box.trials[i].inefficiency()) << i;
  }
}

TEST(Trials, keepASamplerThatWasChosen) {
  RenderSettings settings = triedSettings(Method::gpt);
  settings.sampler = SamplerKind::sobol;
  EXPECT_EQ(withMethod(settings, Method::gpt).sampler, SamplerKind::independent);
  settings.samplerIsChosen = true;
  EXPECT_EQ(withMethod(settings, Method::gpt).sampler, SamplerKind::sobol);
}

TEST(Evcm, takesAllStrategiesWhereTrialsFindNoLight) {
  Scene scene = sceneFile("cornell-diffuse", 16, 12);
  for (Emitter& emitter : scene.emitters) {
    if (auto* area = std::get_if<AreaEmitter>(&emitter.kind)) area->radiance.value = {};
  }
  EXPECT_EQ(choiceFor(scene).method, Method::vcm);
}

TEST(Evcm, choosesForCropsAndSinglePixels) {
  Scene scene = sceneFile("cornell-diffuse", 640, 480);
  scene.film.cropX = 600;
  scene.film.cropY = 470;
  scene.film.cropWidth = 40;
  scene.film.cropHeight = 10;
  EXPECT_GT(choiceFor(scene).trials.front().iterations, 0u);
  EXPECT_GT(choiceFor(sceneFile("cornell-diffuse", 1, 1)).trials.front().iterations, 0u);
}

void expectImageOfChoice(const Scene& scene, Method method) {
  RenderSettings settings = triedSettings(method);
  const auto session = Session::create(scene, settings);
  session->renderUntil(2, std::nullopt);
  const RenderStatistics statistics = session->statistics();
  ASSERT_TRUE(statistics.choice);
  settings.method = statistics.choice->method;
  settings.guide = GuideTarget::radiance;
  settings.sampler = statistics.sampler;
  const auto chosen = Session::create(scene, settings);
  chosen->renderUntil(2, std::nullopt);
  EXPECT_EQ(session->film().resolve(), chosen->film().resolve()) << scene.name;
  EXPECT_FALSE(chosen->statistics().choice);
}

TEST(Trials, leadToTheImageOfTheirChoice) {
  for (const char* name : {"cornell-diffuse", "cornell-spheres"})
    expectImageOfChoice(sceneFile(name, 32, 24), Method::evcm);
  for (const char* name : {"cornell-diffuse", "cornell-mirror"})
    expectImageOfChoice(sceneFile(name, 32, 24), Method::gpt);
}

TEST(Evcm, isChargedForItsTrials) {
  const auto session = Session::create(sceneFile("cornell-diffuse", 32, 24), evcmSettings());
  const RenderStatistics statistics = session->statistics();
  EXPECT_GT(statistics.choice->seconds, 0);
  EXPECT_EQ(statistics.renderSeconds, statistics.choice->seconds);
  EXPECT_EQ(statistics.cpuSeconds, statistics.choice->cpuSeconds);
}

TEST(Evcm, countsTheCompilationAsBuilding) {
  const Scene scene = sceneFile("veach-door", 16, 12);
  const Prepared<float> prepared = chooseMethod<float>(scene, evcmSettings());
  EXPECT_GT(prepared.buildSeconds, 0);
  const RenderSettings settings = withMethod(evcmSettings(), prepared.choice->method);
  Prepared<float> built{.scene = prepared.scene, .choice = prepared.choice, .buildSeconds = 1000};
  EXPECT_GT(makeWaveSession<float>(scene, settings, std::move(built))->statistics().buildSeconds, 1000);
}

// What trials rest on: a session of another film than the scene's, and of a scene that others have compiled.
TEST(Session, rendersAnotherFilm) {
  for (const Method method : {Method::pt, Method::vcm}) {
    RenderSettings settings;
    settings.method = method;
    settings.isa = bestIsa();
    const Scene small = sceneFile("veach-door", 32, 24), large = sceneFile("veach-door", 64, 48);
    const auto expected = Session::create(small, settings);
    expected->renderUntil(1, std::nullopt);
    settings.film = small.film;
    const auto session = Session::create(large, settings);
    session->renderUntil(1, std::nullopt);
    EXPECT_EQ(session->film().resolve(), expected->film().resolve()) << toString(method);
  }
}

}  // namespace
}  // namespace wavecrest
