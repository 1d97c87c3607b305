// The parts of Metropolis light transport that need no image: what chains start from, and that a chain's state is what
// its primary samples say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/chains/chain_waves.h"
#include "engine/chains/chain_worker.h"
#include "engine/chains/epochs.h"
#include "engine/pilot/bootstrap.h"
#include "engine/plan/chain_layout.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

TEST(Bootstrap, hasSamplesOfEveryLengthThatStandForItsWhole) {
  const BootstrapPlan plan = bootstrapByLength(20'000, 1, 64);
  ASSERT_EQ(plan.length.size(), plan.share.size());
  ASSERT_EQ(plan.length.size() + 1, plan.blocks.size());
  EXPECT_TRUE(std::is_sorted(plan.length.begin(), plan.length.end()));
  std::vector<double> whole(65, 0);
  for (size_t i = 0; i < plan.length.size(); ++i) {
    const size_t first = plan.blocks[i], end = plan.blocks[i + 1];
    whole[plan.length[i]] += plan.share[i] * static_cast<double>(end - first);
    EXPECT_EQ(plan.lengthOf(first), plan.length[i]);
    EXPECT_EQ(plan.lengthOf(end - 1), plan.length[i]);
  }
  EXPECT_EQ(whole[0], 0);
  for (size_t length = 1; length <= 64; ++length) EXPECT_NEAR(whole[length], 1, 1e-9) << length;
  EXPECT_NEAR(static_cast<double>(plan.samples()), 20'000, 2'500);
}

TEST(Bootstrap, leavesOutTheShortestIfAsked) {
  EXPECT_EQ(bootstrapByLength(1'000, 3, 9).length.front(), 3u);
  EXPECT_EQ(bootstrapByLength(1'000, 3, 9).length.back(), 9u);
  EXPECT_TRUE(bootstrapByLength(1'000, 3, 2).length.empty());
}

// Lengths 1 and 2 with three and two samples: 1/3 (1 + 2 + 3) + 1/2 (4 + 8).
TEST(Bootstrap, addsUpTheMeansOfTheLengths) {
  BootstrapPlan plan;
  plan.add(1, 3);
  plan.add(2, 2);
  const Brightness b = brightnessOf(plan, sumsOf(plan, {1, 2, 3, 4, 8}));
  EXPECT_DOUBLE_EQ(b.mean, 8);
  EXPECT_DOUBLE_EQ(b.standardError, std::sqrt(1.0 / 3 + 8.0 / 2));
  EXPECT_DOUBLE_EQ(b.largestShare, 0.5);
}

// A sample gets its share of the chains, up to one, and over all offsets exactly its share.
TEST(Bootstrap, startsChainsInProportionToTheTarget) {
  const BootstrapPlan plan = plainBootstrap(5);
  const std::vector<float> targets{0, 1, 2, 0, 5};
  constexpr uint32_t kChains = 13, kOffsets = 64;
  std::vector<double> total(5, 0);
  for (uint32_t k = 0; k < kOffsets; ++k) {
    const std::vector<uint32_t> starts =
        startSamples(plan, targets, sumsOf(plan, targets), kChains, (k + 0.5) / kOffsets);
    ASSERT_EQ(starts.size(), kChains);
    EXPECT_TRUE(std::is_sorted(starts.begin(), starts.end()));
    std::vector<double> count(5, 0);
    for (const uint32_t start : starts) ++count[start];
    for (size_t i = 0; i < 5; ++i) {
      EXPECT_LE(std::abs(count[i] - kChains * targets[i] / 8.0), 1) << i;
      total[i] += count[i];
    }
  }
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(total[i] / kOffsets, kChains * targets[i] / 8.0, 2.0 / kOffsets) << i;
}

// Many blocks of samples and chains, in two lengths, some blocks dark: as one walk through all samples.
TEST(Bootstrap, blocksMakeNoDifference) {
  BootstrapPlan plan;
  plan.add(3, 20'000);
  plan.add(4, 9'000);
  std::vector<float> targets(29'000, 0.0f);
  for (size_t i = 5'000; i < 27'000; ++i) {
    if (i % 3 != 0 && (i < 9'000 || i > 14'000)) targets[i] = static_cast<float>(i * 7919 % 1000) / 16;
  }
  const std::vector<BlockSums> blocks = sumsOf(plan, targets);
  ASSERT_GT(blocks.size(), 10u);

  double mean = 0, variance = 0, sum = 0;
  for (const auto& [begin, end] : {std::pair<size_t, size_t>{0, 20'000}, {20'000, 29'000}}) {
    const auto count = static_cast<double>(end - begin);
    double total = 0, squares = 0;
    for (size_t i = begin; i < end; ++i) total += static_cast<double>(targets[i]);
    for (size_t i = begin; i < end; ++i) squares += std::pow(static_cast<double>(targets[i]) - total / count, 2);
    mean += total / count;
    variance += squares / (count - 1) / count;
  }
  const Brightness b = brightnessOf(plan, blocks);
  EXPECT_NEAR(b.mean, mean, 1e-12 * mean);
  EXPECT_NEAR(b.standardError, std::sqrt(variance), 1e-12 * std::sqrt(variance));

  constexpr uint32_t kChains = 5'000;
  constexpr double kOffset = 0.37;
  const auto weight = [&](size_t i) {
    return (i < 20'000 ? 1.0 / 20'000 : 1.0 / 9'000) * static_cast<double>(targets[i]);
  };
  for (size_t i = 0; i < targets.size(); ++i) sum += weight(i);
  const std::vector<uint32_t> starts = startSamples(plan, targets, blocks, kChains, kOffset);
  ASSERT_EQ(starts.size(), kChains);
  double reached = 0;
  size_t sample = 0;
  for (uint32_t chain = 0; chain < kChains; ++chain) {
    const double goal = (chain + kOffset) / kChains * sum;
    while (reached + weight(sample) <= goal) reached += weight(sample++);
    EXPECT_EQ(starts[chain], sample) << chain;
  }
}

TEST(Bootstrap, noChainStartsInTheDarkAtTheEnd) {
  BootstrapPlan plan;
  plan.add(1, 5'000);
  std::vector<float> targets(5'000, 0.0f);
  targets[10] = 0.1f;
  targets[2'500] = 0.7f;
  const std::vector<uint32_t> starts = startSamples(plan, targets, sumsOf(plan, targets), 3'000, 1 - 0x1p-53);
  EXPECT_EQ(starts.back(), 2'500u);
  for (const uint32_t start : starts) EXPECT_GT(targets[start], 0);
}

// A dark epoch, one of b = 2, and one of b = 5 that goes on three times as long.
TEST(Epochs, weighTheirBrightnessBySteps) {
  Epochs epochs(plainBootstrap(2));
  const auto begin = [&](float first, float second, uint64_t steps) {
    epochs.targets = {first, second};
    epochs.begin();
    epochs.addSteps(steps);
  };
  begin(0, 0, 10);
  EXPECT_TRUE(epochs.dark());
  EXPECT_EQ(epochs.unit(), 0);
  begin(1, 3, 10);
  EXPECT_FALSE(epochs.dark());
  EXPECT_DOUBLE_EQ(epochs.unit(), 2);
  EXPECT_DOUBLE_EQ(epochs.scale(), 1);
  begin(5, 5, 20);
  epochs.addSteps(10);
  EXPECT_DOUBLE_EQ(epochs.unit(), 2);
  EXPECT_DOUBLE_EQ(epochs.scale(), 2.5);
  EXPECT_EQ(epochs.count(), 3u);

  const Brightness film = epochs.ofFilm();
  EXPECT_DOUBLE_EQ(film.mean, (0 * 10 + 2 * 10 + 5 * 30) / 50.0);
  EXPECT_DOUBLE_EQ(film.standardError, 10 * std::sqrt(2.0 / 2) / 50);
  EXPECT_DOUBLE_EQ(film.largestShare, 0.75);
  // Six samples of three bootstraps, and two more.
  ChainStatistics chains;
  chains.bootstraps = epochs.bootstraps();
  chains.largeSteps.add(epochs.plan().lengthOf(0), 7);
  chains.largeSteps.add(epochs.plan().lengthOf(0), 11);
  poolBrightness(chains);
  EXPECT_DOUBLE_EQ(chains.pooledBrightness, (0 + 0 + 1 + 3 + 5 + 5 + 7 + 11) / 8.0);
}

// An offset of 0 would always start the first chain from the first sample with light.
TEST(Epochs, startWithinTheUnitInterval) {
  for (uint64_t seed = 0; seed < 16; ++seed) {
    for (uint64_t epoch = 0; epoch < 16; ++epoch) {
      EXPECT_GT(startOffset(seed, epoch), 0) << seed << ' ' << epoch;
      EXPECT_LT(startOffset(seed, epoch), 1) << seed << ' ' << epoch;
    }
  }
}

// Chains that are stuck at the end of an epoch are listed then, and not again after an epoch without light.
TEST(ChainWaves, areNotStuckOnceTheyAreNowhere) {
  Scene scene = sceneFile("cornell-diffuse", 40, 30);
  scene.emitters.clear();  // all proposals are dark and rejected
  for (Shape& shape : scene.shapes) shape.emitter = kNone;
  RenderSettings settings;
  settings.method = Method::mlt;
  settings.metropolis.variant = MetropolisVariant::pssmlt;
  settings.metropolis.chains = 40;
  settings.isa = bestIsa();
  const RenderPlan<float> plan = planRender<float>(scene, settings);
  const FilmArea area = filmArea(scene.film);
  SplatFilms films(area.pixels.size(), 1, 1.0);
  ChainWorker<float> worker(plan, settings.waveSize, films);
  ChainWaves<float> chains(plan, settings, area);
  ASSERT_EQ(chains.size(), 1u);
  chains.start(0, 0, plainBootstrap(1), std::vector<uint32_t>(40, 0u), 1, worker);
  chains.advance(0, 0, kStuckRejections, worker);
  std::vector<StuckChain> stuck;
  chains.listStuck(stuck);
  EXPECT_EQ(stuck.size(), kListedStuckChains);
  chains.clear();
  stuck.clear();
  chains.listStuck(stuck);
  EXPECT_TRUE(stuck.empty());
}

struct ChainCase {
  const char* scene;
  MetropolisVariant variant;
};

// Chains of a scene that begin nowhere and take what they get.
class SceneChains {
 public:
  SceneChains(const Scene& scene, const ChainCase& chosen, Isa isa, size_t count)
      : settings_(settingsOf(chosen.variant, isa)),
        plan_(planRender<float>(scene, settings_)),
        area_(filmArea(scene.film)),
        state(count, keptSamples(plan_.pipeline, plan_.view, settings_.limits.maxDepth)),
        paths_(count, std::max(plan_.pathLaws.law().maxEdges, 1u), plan_.needs),
        films_(area_.pixels.size(), 1, 1.0),
        worker_(plan_, count, films_),
        context_(chainContext(plan_, settings_, area_)),
        count_(count) {
    state.multiplexed = chosen.variant != MetropolisVariant::pssmlt;
    for (uint32_t i = 0; i < count; ++i) {
      state.columns.source[i] = i;
      state.columns.length[i] = 1 + i % 7;
    }
  }

  void trace(uint32_t step) {
    context_.sampler.iteration = step;
    worker_.trace(context_, state, count_, false, &paths_);
  }
  void decide() { worker_.decide(context_, state, false); }
  // In path space: where the chains are, and what they propose.
  PathStore<float>& paths() { return paths_; }
  const PathMutations<float>& mutations() const { return worker_.mutations(); }
  // Luminance of a chain's proposal.
  double proposed(size_t i) const {
    const auto& radiance = worker_.wave().radiance;
    return static_cast<double>(state.columns.scale[i]) *
           (0.2126 * static_cast<double>(radiance.red[i]) + 0.7152 * static_cast<double>(radiance.green[i]) +
            0.0722 * static_cast<double>(radiance.blue[i]));
  }

 private:
  static RenderSettings settingsOf(MetropolisVariant variant, Isa isa) {
    RenderSettings settings;
    settings.method = Method::mlt;
    settings.metropolis.variant = variant;
    settings.isa = isa;
    settings.seed = 3;
    return settings;
  }
  const RenderSettings settings_;
  const RenderPlan<float> plan_;
  const FilmArea area_;

 public:
  ChainState state;

 private:
  PathStore<float> paths_;
  SplatFilms films_;
  ChainWorker<float> worker_;
  StageContext<float> context_;
  size_t count_;
};

class ChainTest : public testing::TestWithParam<ChainCase> {};

// A proposal that changes nothing finds what the chain already has: every number that a path uses was kept when the
// path was accepted, whether by a large or by a small step, and however long the path before it was.
TEST_P(ChainTest, stateIsWhatItsSamplesSay) {
  SceneChains chains(sceneFile(GetParam().scene, 40, 30), GetParam(), bestIsa(), 333);
  for (uint32_t step = 0; step < 30; ++step) {
    chains.trace(step);
    chains.decide();
  }
  EXPECT_GT(chains.state.counters.acceptedOf(Mutation::small), 300u);
  EXPECT_GT(chains.state.counters.acceptedOf(Mutation::large), 300u);
  chains.state.samples.stepBits = 0;
  chains.state.samples.largeStep = 0;
  chains.trace(30);
  size_t lit = 0;
  for (size_t i = 0; i < 333; ++i) {
    const double target = chains.state.columns.target[i];
    if (!(target > 0)) continue;  // still nowhere
    EXPECT_NEAR(chains.proposed(i), target, 1e-6 * target) << "chain " << i;
    EXPECT_EQ(chains.state.columns.proposedPixel[i], chains.state.columns.pixel[i]) << "chain " << i;
    ++lit;
  }
  EXPECT_GT(lit, 100u);
}

// Whether the factors of a path's contribution are numbers.
bool hasNumbers(const PathStore<float>& paths, size_t lane) {
  for (size_t row = 1; row < paths.headers.edges[lane]; ++row) {
    if (!std::isfinite(paths.vertices.stepR[row * paths.stride() + lane])) return false;
  }
  return true;
}

// Some proposals keep the vertex whose factor is no number. They are counted.
TEST(PathSpaceChains, countWhatIsNoNumber) {
  constexpr size_t kChains = 333;
  const ChainCase chosen{"cornell-diffuse", MetropolisVariant::pathspace};
  SceneChains chains(sceneFile(chosen.scene, 40, 30), chosen, bestIsa(), kChains);
  constexpr uint32_t kSteps = 20;
  for (uint32_t step = 0; step < kSteps; ++step) {
    chains.trace(step);
    chains.decide();
  }
  EXPECT_EQ(chains.state.counters.nonFinite, 0u);
  PathStore<float>& paths = chains.paths();
  for (size_t i = 0; i < kChains; ++i) {
    if (paths.headers.edges[i] < 4) continue;
    paths.vertices.stepR[paths.stride() + i] = std::numeric_limits<float>::quiet_NaN();  // of row 1
  }
  chains.trace(kSteps);
  const PathMutations<float>& mutations = chains.mutations();
  size_t expected = 0;
  for (size_t i = 0; i < mutations.laneCount; ++i) {
    expected += hasNumbers(mutations.proposed, mutations.lanes[i]) ? 0 : 1;
  }
  EXPECT_GT(expected, 0u);
  chains.decide();
  EXPECT_EQ(chains.state.counters.nonFinite, expected);
}

// Walks, their ends and what joins them, at odd counts: the scalar twin's proposals are the same. A path that only
// rounding decides about may differ.
class ChainTwinTest : public ChainTest {};
TEST_P(ChainTwinTest, proposalsAreThoseOfTheScalarTwin) {
  const Scene scene = sceneFile(GetParam().scene, 40, 30);
  for (const Isa isa : availableIsas()) {
    if (isa == Isa::scalar) continue;
    size_t lit = 0, different = 0, all = 0;
    for (const size_t count : {1u, 15u, 17u, 333u}) {
      SceneChains expected(scene, GetParam(), Isa::scalar, count), actual(scene, GetParam(), isa, count);
      for (uint32_t step = 0; step < 4; ++step) {
        expected.trace(step);
        actual.trace(step);
        for (size_t i = 0; i < count; ++i) {
          const double want = expected.proposed(i), got = actual.proposed(i);
          lit += want > 0 ? 1 : 0;
          different += std::abs(got - want) > 1e-3 * want ? 1 : 0;
          ++all;
        }
        if (GetParam().variant != MetropolisVariant::pathspace) continue;
        // In path space mutations need a path to change.
        expected.decide();
        actual.decide();
      }
    }
    EXPECT_GT(lit, all / 50);
    EXPECT_LE(different, all / 200) << toString(isa);
  }
}

std::string nameOfChains(const testing::TestParamInfo<ChainCase>& instance) {
  std::string name = instance.param.scene;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '/'; }, '_');
  return name + "_" + std::string(kMetropolisVariantNames[static_cast<size_t>(instance.param.variant)]);
}

const std::vector<ChainCase> kPrimarySamples{
    {"cornell-diffuse", MetropolisVariant::pssmlt}, {"cornell-diffuse", MetropolisVariant::mmlt},
    {"cornell-mirror", MetropolisVariant::mmlt},    {"cornell-glossy", MetropolisVariant::pssmlt},
    {"cornell-spheres", MetropolisVariant::mmlt},   {"features/roughplastic", MetropolisVariant::mmlt},
    {"features/envmap", MetropolisVariant::pssmlt}, {"features/envmap", MetropolisVariant::mmlt}};
const std::vector<ChainCase> kPaths{{"cornell-diffuse", MetropolisVariant::pathspace},
                                    {"cornell-mirror", MetropolisVariant::pathspace},
                                    {"features/roughplastic", MetropolisVariant::pathspace},
                                    {"features/envmap", MetropolisVariant::pathspace}};
INSTANTIATE_TEST_SUITE_P(Engine, ChainTest, testing::ValuesIn(kPrimarySamples), nameOfChains);
INSTANTIATE_TEST_SUITE_P(PrimarySamples, ChainTwinTest, testing::ValuesIn(kPrimarySamples), nameOfChains);
INSTANTIATE_TEST_SUITE_P(Paths, ChainTwinTest, testing::ValuesIn(kPaths), nameOfChains);

}  // namespace
}  // namespace wavecrest
