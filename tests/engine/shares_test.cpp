// Sessions that each render a share of an image: their films add up to that of one session.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <memory>

#include "engine/plan/share_iterations.h"
#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/rendered_session.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kShareWidth = 40, kShareHeight = 27, kShares = 3;
constexpr uint64_t kShareIterations = 7;  // not the same number for each share

struct ShareCase {
  Method method;
  MetropolisVariant metropolis = MetropolisVariant::mmlt;
  Precision precision = Precision::floating;
  bool directPass = true;
  bool spreads = false;  // the scene's filter is no box
};

RenderSettings settingsOf(const ShareCase& one) {
  RenderSettings settings;
  settings.method = one.method;
  settings.precision = one.precision;
  settings.isa = bestIsa();
  settings.waveSize = 64;
  settings.seed = 5;
  settings.radius = 0.05;  // so that merging finds photons
  settings.metropolis.variant = one.metropolis;
  settings.metropolis.chains = 500;
  settings.metropolis.bootstrapSamples = 4000;
  settings.metropolis.restartSteps = 4;  // so that iterations lie across a restart
  settings.metropolis.directPass = one.directPass;
  settings.guide = GuideTarget::off;  // a share would learn from its own iterations alone
  settings.iterations = kShareIterations;
  return settings;
}

std::unique_ptr<Film> filmOf(const Session& session) {
  const std::vector<unsigned char> state = savedState(session);
  StateReader in(state);
  return Film::fromState(in);
}

// The sum of the films of all shares, added in an order that is not theirs.
std::unique_ptr<Film> sumOfShares(const Scene& scene, const RenderSettings& settings) {
  const auto share = [&](uint32_t part) {
    return filmOf(*renderedSession(scene, settingsOfShare(settings, part, kShares)));
  };
  std::unique_ptr<Film> sum = share(1);
  sum->add(*share(2));
  sum->add(*share(0));
  return sum;
}

// Sums of seven samples in another order differ by 7 x 2^-52 of themselves at most, so images in float by a unit.
TEST(SharesTest, filmsAddUpToThatOfOneSession) {
  std::vector<ShareCase> cases{{.method = Method::pt, .spreads = true}, {.method = Method::bpt, .spreads = true}};
  for (const MethodEntry& entry : kMethods) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      // Films are of doubles in both precisions, whichever method fills them: under sanitizers vcm stands for the
      // others, and for those that merge alone.
      if (!kFullSpeed && (entry.method == Method::ppm || entry.method == Method::bpm)) continue;
      if (!kFullSpeed && precision == Precision::doubled && entry.method != Method::vcm) continue;
      cases.push_back({.method = entry.method, .precision = precision});
    }
  }
  for (const ShareCase& one : cases) {
    Scene scene = sceneFile("cornell-diffuse", kShareWidth, kShareHeight);
    if (one.spreads) scene.film.filter = ReconstructionFilter::gaussian;
    const RenderSettings settings = settingsOf(one);
    const std::unique_ptr<Session> whole = renderedSession(scene, settings);
    EXPECT_EQ(whole->film().spreads(), one.spreads);
    const std::unique_ptr<Film> sum = sumOfShares(scene, settings);
    EXPECT_EQ(sum->allSamples(), whole->film().allSamples());
    EXPECT_EQ(sum->splatCount(), whole->film().splatCount());
    EXPECT_LE(worstDistance(sum->resolve(), whole->film().resolve()), 1) << toString(one.method);
  }
}

// Chains add splats alone, which are integers.
TEST(SharesTest, filmsOfChainsAddUpToTheBit) {
  const Scene scene = sceneFile("cornell-diffuse", kShareWidth, kShareHeight);
  for (const MetropolisVariant variant :
       {MetropolisVariant::mmlt, MetropolisVariant::pathspace, MetropolisVariant::pssmlt}) {
    const RenderSettings settings =
        settingsOf({.method = Method::mlt, .metropolis = variant, .directPass = variant == MetropolisVariant::pssmlt});
    const std::unique_ptr<Session> whole = renderedSession(scene, settings);
    EXPECT_EQ(sumOfShares(scene, settings)->resolve(), whole->film().resolve());
  }
}

// A share that is broken goes on as what it was, with other threads and waves.
TEST(SharesTest, aShareOfChainsThatIsBrokenGoesOn) {
  const Scene scene = sceneFile("cornell-diffuse", kShareWidth, kShareHeight);
  RenderSettings settings = settingsOfShare(settingsOf({.method = Method::mlt}), 1, kShares);
  const std::unique_ptr<Session> whole = renderedSession(scene, settings);
  const auto first = Session::create(scene, settings);
  first->renderUntil(3, std::nullopt);
  settings.threads = 3;
  settings.waveSize = 200;
  const auto second = Session::create(scene, settings);
  restoreState(*second, savedState(*first));
  second->renderUntil(settings.iterations, std::nullopt);
  EXPECT_EQ(second->film().resolve(), whole->film().resolve());
  EXPECT_EQ(second->statistics().iterations, kShareIterations);
  EXPECT_EQ(second->statistics().chains->directPaths, whole->statistics().chains->directPaths);
}

// Of shares that are rendered at the same time every iteration belongs to one, whether the image has an end or not.
TEST(ShareIterationsTest, everyIterationIsInOneShare) {
  for (uint32_t parts = 1; parts <= 7; ++parts) {
    for (const uint64_t all : std::initializer_list<uint64_t>{0, 1, 5, 6, 7, 20, 21, 22, 150}) {
      RenderSettings image;
      image.iterations = all;
      std::vector<int> seen(all);
      uint64_t most = 0, least = all;
      for (uint32_t part = 0; part < parts; ++part) {
        const RenderSettings share = settingsOfJointShare(image, part, parts);
        const ShareIterations numbers(share);
        most = std::max(most, *share.iterations);
        least = std::min(least, *share.iterations);
        for (uint64_t own = 0; own < *share.iterations; ++own) ++seen.at(numbers.number(own));
        uint64_t inRuns = 0;
        for (const auto& [begin, end] : numbers.runs(*share.iterations)) inRuns += end - begin;
        EXPECT_EQ(inRuns, *share.iterations);
      }
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(all)) << parts << " of " << all;
      EXPECT_LE(most - least, 1u);
    }
  }
}

TEST(ShareIterationsTest, roundsDouble) {
  RenderSettings settings;
  settings.seconds = 1;
  const ShareIterations numbers(settingsOfJointShare(settings, 1, 3));
  EXPECT_EQ(numbers.runs(7), (std::vector<ShareIterations::Run>{{1, 2}, {5, 7}, {13, 17}}));
  EXPECT_EQ(numbers.number(5), 15u);
  EXPECT_EQ(numbers.together(5), 2u);
  EXPECT_EQ(numbers.together(6), 1u);
  EXPECT_GT(numbers.number(uint64_t{1} << 60), numbers.number((uint64_t{1} << 60) - 1));
}

TEST(SharesTest, filmsOfSharesAtTheSameTimeAddUp) {
  for (const bool spreads : {false, true}) {
    Scene scene = sceneFile("cornell-diffuse", kShareWidth, kShareHeight);
    if (spreads) scene.film.filter = ReconstructionFilter::gaussian;
    for (const MethodEntry& entry : kMethods) {
      if (entry.method == Method::gpt) continue;  // which learns from what it has rendered itself
      // Under sanitizers one method stands for all that merge, and none where films spread samples, which they do alike
      // whichever method fills them.
      if (!kFullSpeed && strategiesOf(entry.method).merge && (spreads || entry.method != Method::vcm)) continue;
      RenderSettings settings = settingsOf({.method = entry.method});
      settings.iterations = effort(50, 16);  // so that path tracing takes several at once
      const std::unique_ptr<Session> whole = renderedSession(scene, settings);
      std::unique_ptr<Film> sum;
      for (uint32_t part = 0; part < kShares; ++part) {
        const auto share = renderedSession(scene, settingsOfJointShare(settings, part, kShares));
        const std::vector<unsigned char> state = savedState(share->film());
        StateReader in(state);
        if (sum) {
          sum->addSaved(in);
          in.finish();
        } else {
          sum = Film::fromState(in);
        }
      }
      EXPECT_EQ(sum->allSamples(), whole->film().allSamples());
      EXPECT_EQ(sum->splatCount(), whole->film().splatCount());
      // Sums of as many samples in another order.
      EXPECT_LE(worstDistance(sum->resolve(), whole->film().resolve()), 1) << toString(entry.method);
    }
  }
}

// A share that is broken within a round goes on with the number that comes next.
TEST(SharesTest, aShareOfRoundsThatIsBrokenGoesOn) {
  const Scene scene = sceneFile("cornell-diffuse", kShareWidth, kShareHeight);
  for (const Method method : {Method::pt, Method::vcm}) {
    RenderSettings settings = settingsOf({.method = method});
    settings.iterations = 50;
    settings = settingsOfJointShare(settings, 1, kShares);
    const std::unique_ptr<Session> whole = renderedSession(scene, settings);
    const auto first = Session::create(scene, settings);
    first->renderUntil(9, std::nullopt);
    const auto second = Session::create(scene, settings);
    restoreState(*second, savedState(*first));
    second->renderUntil(settings.iterations, std::nullopt);
    EXPECT_EQ(second->film().resolve(), whole->film().resolve());
  }
}

TEST(SharesTest, filmsOfOtherKindsAreNotAdded) {
  const auto film = [](Method method, uint32_t width, bool spreads) {
    Scene scene = sceneFile("cornell-diffuse", width, kShareHeight);
    if (spreads) scene.film.filter = ReconstructionFilter::gaussian;
    return filmOf(*renderedSession(scene, settingsOf({.method = method})));
  };
  const std::unique_ptr<Film> one = film(Method::pt, kShareWidth, false);
  EXPECT_THROW(one->add(*film(Method::pt, kShareWidth + 1, false)), StateError);
  EXPECT_THROW(one->add(*film(Method::pt, kShareWidth, true)), StateError);
  EXPECT_THROW(one->add(*film(Method::lt, kShareWidth, false)), StateError);
}

}  // namespace
}  // namespace wavecrest
