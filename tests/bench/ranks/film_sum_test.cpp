// The contributions of processes that share a render add up to that render.
#include "bench/ranks/film_sum.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/ranks/sum_tree.h"
#include "engine/state/state_stream.h"
#include "tests/engine/rendered_session.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

using Contribution = std::vector<unsigned char>;
constexpr uint32_t kProcesses = 3;
constexpr uint64_t kIterationsOfAll = 11;  // three rounds of 3, 6 and 2

RenderSettings settingsOfSum(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.waveSize = 64;
  settings.radius = 0.05;
  settings.metropolis.chains = 300;
  settings.metropolis.bootstrapSamples = 3000;
  settings.iterations = kIterationsOfAll;
  return settings;
}

// As the tree does: the sum of two goes on as a contribution. The sum has a film that was used before.
TEST(FilmSumTest, contributionsOfProcessesAreOneRender) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 27);
  for (const MethodEntry& entry : kMethods) {
    if (entry.method == Method::gpt) continue;  // which learns from what it has rendered itself
    const RenderSettings settings = settingsOfSum(entry.method);
    const std::unique_ptr<Session> whole = renderedSession(scene, settings);
    std::vector<Contribution> contributions;
    RenderStatistics own;
    for (uint32_t rank = 0; rank < kProcesses; ++rank) {
      const auto session = renderedSession(scene, settingsOfJointShare(settings, rank, kProcesses));
      if (rank == 0) own = session->statistics();
      contributions.push_back(contributionOf(*session, recordOf(rank, 2, session->statistics())));
    }
    FilmSum inner, outer;
    inner.sumUp({contributions[2], contributions[1]});
    outer.sumUp({contributions[1], contributions[1]});
    int added = 0;
    outer.sumUp({contributions[0], inner.contribution()}, [&] { ++added; });
    EXPECT_EQ(added, 2);
    EXPECT_LE(worstDistance(outer.film().resolve(), whole->film().resolve()), 1) << entry.name;
    const RenderStatistics sum = outer.statistics(own), expected = whole->statistics();
    EXPECT_EQ(sum.iterations, expected.iterations) << entry.name;
    EXPECT_EQ(sum.paths, expected.paths) << entry.name;
    EXPECT_EQ(sum.lightPaths, expected.lightPaths) << entry.name;
    EXPECT_GT(sum.counters.raysClosest, own.counters.raysClosest) << entry.name;
    EXPECT_GT(sum.cpuSeconds, own.cpuSeconds) << entry.name;
    if (sum.chains) {
      EXPECT_EQ(sum.chains->mutations, expected.chains->mutations);
      EXPECT_EQ(sum.chains->directPaths, expected.chains->directPaths);
      // By the large steps of all chains, whose sums are rounded in another order.
      const double pooled = expected.chains->pooledBrightness, error = expected.chains->pooledError;
      EXPECT_NEAR(sum.chains->pooledBrightness, pooled, 1e-9 * pooled);
      EXPECT_NEAR(sum.chains->pooledError, error, 1e-9 * error);
    }
    ASSERT_EQ(outer.processes().size(), kProcesses);
    for (uint32_t rank = 0; rank < kProcesses; ++rank) EXPECT_EQ(outer.processes()[rank].rank, rank);
  }
}

// Of two iterations the direct pass has two samples of each pixel, in the first two shares.
TEST(FilmSumTest, chainsWithoutDirectLightAreNoWholeImage) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 27);
  RenderSettings settings = settingsOfSum(Method::mlt);
  settings.iterations = 2;
  constexpr uint32_t kShares = 4;
  for (const bool directPass : {true, false}) {
    settings.metropolis.directPass = directPass;
    std::vector<Contribution> contributions;
    RenderStatistics own;
    for (uint32_t rank = 0; rank < kShares; ++rank) {
      const auto session = renderedSession(scene, settingsOfJointShare(settings, rank, kShares));
      own = session->statistics();
      contributions.push_back(contributionOf(*session, recordOf(rank, 1, own)));
    }
    FilmSum sum;
    sum.sumUp({contributions[2], contributions[3]});
    EXPECT_EQ(sum.statistics(own).hasWholeImage(), !directPass);
    sum.sumUp({contributions[0], contributions[2], contributions[3]});
    EXPECT_TRUE(sum.statistics(own).hasWholeImage());
  }
}

// Films with splats and margins, the largest there are.
TEST(FilmSumTest, memoryOfSumsIsThatOfTheirFilms) {
  Scene scene = sceneFile("cornell-diffuse", 96, 64);
  scene.film.filter = ReconstructionFilter::gaussian;
  const RenderSettings settings = settingsOfSum(Method::vcm);
  const auto session = Session::create(scene, settings);
  ASSERT_TRUE(session->film().spreads() && session->film().hasSplats());
  const auto bytes = static_cast<double>(contributionOf(*session, recordOf(0, 1, session->statistics())).size());
  for (const uint32_t ranks : {2u, 3u, 8u}) {
    // Of the process that holds most: its own film, those of its children, the sum's, and the sum that it sends on.
    size_t most = 0;
    for (uint32_t rank = 0; rank < ranks; ++rank) {
      most = std::max(most, 2 + SumTree(rank, ranks).children().size() + (rank == 0 ? 0 : 1));
    }
    const double films = static_cast<double>(bytesOfSums(scene, settings, ranks)) / bytes;
    EXPECT_GE(films, static_cast<double>(most)) << ranks;
    EXPECT_LT(films, 1.25 * static_cast<double>(most)) << ranks;
  }
}

TEST(FilmSumTest, otherRendersDoNotAddUp) {
  const auto contribution = [](Method method, uint32_t width) {
    const auto session = renderedSession(sceneFile("cornell-diffuse", width, 27), settingsOfSum(method));
    return contributionOf(*session, recordOf(0, 1, session->statistics()));
  };
  const Contribution pt = contribution(Method::pt, 40);
  FilmSum sum;
  EXPECT_THROW(sum.sumUp({pt, contribution(Method::pt, 41)}), StateError);
  EXPECT_THROW(sum.sumUp({pt, contribution(Method::lt, 40)}), StateError);
  EXPECT_THROW(sum.sumUp({pt, FilmSum::Bytes(pt).first(pt.size() - 1)}), StateError);
}

}  // namespace
}  // namespace wavecrest
