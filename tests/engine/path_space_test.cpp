// Mutations of paths: the laws that they choose by, the patterns that they keep, and detailed balance with densities
// computed from scratch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/chains/chain_worker.h"
#include "engine/plan/chain_layout.h"
#include "kernels/mutate/path_pattern.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/path_transition.h"

namespace wavecrest {
namespace {

TEST(PathLaw, deletionsOfEveryLengthAddUpToOne) {
  const PathLaws laws(1, 12);
  const PathLaw law = laws.law();
  EXPECT_EQ(law.firstDeletion[2], 0u);  // no part of a light in view can be deleted
  for (uint32_t edges = 2; edges <= 12; ++edges) {
    const uint32_t first = law.firstDeletion[edges], count = law.firstDeletion[edges + 1] - first;
    ASSERT_GT(count, 0u);
    std::vector<double> byTable(count, 0);
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const AliasEntry& entry = law.deletions[first + i];
      byTable[i] += double{entry.keep} / count;
      byTable[entry.other] += (1 - double{entry.keep}) / count;
    }
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t kept = law.ranges[first + i] & 0xffffu, from = law.ranges[first + i] >> 16;
      EXPECT_TRUE(kept != 1 && kept <= edges && from >= std::max(kept, 1u) && from <= edges + 1 && from != edges);
      const double share = law.deletionShare[edges * law.deletionStride() + from + 1 - kept];
      EXPECT_NEAR(byTable[i], share, 1e-6) << edges << " edges, " << kept << " to " << from;
      sum += share;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << edges;
  }
}

TEST(PathLaw, lengthsOfNewPathsAddUpToOne) {
  const PathLaws laws(3, 9);
  const PathLaw law = laws.law();
  EXPECT_EQ(law.lengthsUpTo[2], 0.0f);
  EXPECT_FLOAT_EQ(law.lengthsUpTo[9], 1.0f);
  for (uint32_t k = 4; k <= 9; ++k) {
    const double ratio =
        double{law.lengthsUpTo[k] - law.lengthsUpTo[k - 1]} / double{law.lengthsUpTo[k - 1] - law.lengthsUpTo[k - 2]};
    EXPECT_NEAR(ratio, 0.85, 1e-5);
  }
}

// Events from the light to the eye; the first and the last letter stand for x_0 and the lens.
PathPattern patternOf(const std::string& path, bool lightTurns = true) {
  std::vector<uint32_t> events;
  for (const char c : path) events.push_back(c == 'S' ? 1 : 0);
  return pathPattern(events.data(), 1, static_cast<uint32_t>(path.size() - 1), lightTurns);
}

TEST(PathPattern, perturbationsFromTheEyeEndAtTheFirstJoint) {
  EXPECT_EQ(patternOf("LE").eyeEnd, 0u);
  EXPECT_EQ(patternOf("LDE").eyeEnd, 1u);
  EXPECT_EQ(patternOf("LSE").eyeEnd, 0u);
  EXPECT_EQ(patternOf("LDDSE").eyeEnd, 2u);
  EXPECT_EQ(patternOf("LDDSSE").eyeEnd, 2u);
  for (const char* lens : {"LE", "LDE", "LSE", "LDDSE", "LDSSE", "LDDDE"})
    EXPECT_FALSE(patternOf(lens).multiChain) << lens;
  EXPECT_TRUE(patternOf("LDDSDE").multiChain);
  EXPECT_EQ(patternOf("LDDSDE").eyeEnd, 2u);
  EXPECT_TRUE(patternOf("LDSDSDE").multiChain);
  EXPECT_EQ(patternOf("LDSDSDE").eyeEnd, 1u);
  EXPECT_TRUE(patternOf("LSDE").multiChain);
  EXPECT_EQ(patternOf("LSDE").eyeEnd, 0u);
}

TEST(PathPattern, causticsBeginBehindTheirLastDeltas) {
  EXPECT_EQ(patternOf("LE").causticStart, 0u);
  EXPECT_EQ(patternOf("LSE").causticStart, 0u);
  EXPECT_EQ(patternOf("LDSE").causticStart, 0u);
  EXPECT_EQ(patternOf("LDE").causticStart, 1u);
  EXPECT_EQ(patternOf("LSSDE").causticStart, 1u);
  EXPECT_EQ(patternOf("LSSDE", false).causticStart, 0u);
  EXPECT_EQ(patternOf("LDSDE").causticStart, 2u);
  EXPECT_EQ(patternOf("LDDE").causticStart, 2u);
}

// Diffuse walls, a mirror ball and a glass ball under a quad light.
Scene ballRoom() {
  Scene scene = roomScene({.width = 24, .height = 18});
  const uint32_t mirror =
      addMaterial(scene, Conductor{.perfectMirror = true, .specularReflectance = {{0.9, 0.8, 0.7}}});
  const uint32_t glass =
      addMaterial(scene, Dielectric{.intIor = 1.5, .extIor = 1, .specularTransmittance = {{0.7, 0.9, 0.8}}});
  addShape(scene, Sphere{.center = {0.4, -0.5, 0.3}, .radius = 0.45}, glass);
  addShape(scene, Sphere{.center = {0.5, 0.3, -0.5}, .radius = 0.4}, mirror);
  return scene;
}

struct Balance {
  std::array<size_t, kMutationKinds> compared{}, forbidden{}, apart{};
  double largest = 0;
};

// Runs chains, and compares the ratio of every whole proposal with f(y) T(y -> x) / (f(x) T(x -> y)). For it the step
// is accepted with min(1, ratio), and f(x) T(x -> y) a(x -> y) is then the same from either side.
template <class S>
Balance compareRatios(Precision precision, double tolerance) {
  constexpr size_t kChains = 777;
  constexpr uint32_t kSteps = 60;
  const Scene scene = ballRoom();
  RenderSettings settings;
  settings.method = Method::mlt;
  settings.metropolis.variant = MetropolisVariant::pathspace;
  settings.metropolis.directPass = false;
  settings.limits.maxDepth = 9;
  settings.precision = precision;
  settings.accel = Accel::small;
  settings.isa = bestIsa();
  settings.seed = 11;
  const RenderPlan<S> plan = planRender<S>(scene, settings);
  const FilmArea area = filmArea(scene.film);
  ChainState state(kChains, keptSamples(plan.pipeline, plan.view, settings.limits.maxDepth));
  state.multiplexed = true;
  PathStore<S> paths(kChains, plan.pathLaws.law().maxEdges, plan.needs);
  SplatFilms films(area.pixels.size(), 1, 1.0);
  ChainWorker<S> worker(plan, kChains, films);
  StageContext<S> context = chainContext(plan, settings, area);
  const auto pixels = static_cast<double>(area.pixels.size());
  const PathTransition<S> scratch(plan.view, pixels, {1, 9, double{state.samples.largeStep}});
  for (uint32_t i = 0; i < kChains; ++i) {
    state.columns.source[i] = i;
    state.columns.length[i] = 1 + i % 9;
  }
  Balance out;
  for (uint32_t step = 0; step < kSteps; ++step) {
    context.sampler.iteration = step;
    worker.trace(context, state, kChains, false, &paths);
    const PathMutations<S>& mutations = worker.mutations();
    const auto& radiance = worker.wave().radiance;
    for (size_t n = 0; n < mutations.laneCount; ++n) {
      const uint32_t lane = mutations.lanes[n];
      if (paths.headers.edges[lane] == 0) continue;
      const ScratchPath x = scratchPath(paths, lane), y = scratchPath(mutations.proposed, lane);
      const PathPlans& plans = mutations.plans;
      const Replacement forth{static_cast<Mutation>(plans.kind[lane]), plans.lightKept[lane], plans.eyeFrom[lane],
                              plans.eyeTo[lane]};
      const double luminance = 0.2126 * static_cast<double>(radiance.red[lane]) +
                               0.7152 * static_cast<double>(radiance.green[lane]) +
                               0.0722 * static_cast<double>(radiance.blue[lane]);
      const double ratio = luminance * static_cast<double>(state.columns.scale[lane]);
      const double there = scratch.contribution(y) * scratch.transition(y, x, forth.reversed());
      const double here = scratch.contribution(x) * scratch.transition(x, y, forth);
      const double expected = there / here;
      EXPECT_GT(here, 0) << "an impossible step: kind " << plans.kind[lane];
      const auto kind = static_cast<size_t>(forth.kind);
      ++out.compared[kind];
      out.forbidden[kind] += expected > 0 ? 0 : 1;
      // The float rounding of the scale is all that a ratio beyond measure has left.
      const double error = std::abs(ratio - expected) / std::max(expected, 1e-12);
      if (!(error <= tolerance)) {
        ++out.apart[kind];
        if (out.apart[kind] <= 3 && precision == Precision::doubled) {
          ADD_FAILURE() << "kind " << kind << ", k = " << x.size() - 1 << " -> " << y.size() - 1 << ", rows "
                        << forth.kept << " to " << forth.fromEnd << " -> " << forth.end << ": ratio " << ratio
                        << ", from scratch " << expected;
        }
      } else {
        out.largest = std::max(out.largest, error);
      }
    }
    worker.decide(context, state, false);
    if (step == 4) std::fill_n(static_cast<uint32_t*>(state.columns.length), kChains, 0u);
  }
  return out;
}

constexpr std::array kPathKinds{Mutation::large, Mutation::bidirectional, Mutation::lens, Mutation::multiChain,
                                Mutation::caustic};

// Shading is in double, but hits are float, so positions are off by 2^-24 along their surfaces. A path through a ball
// turns that into some 1e-3 of its Fresnel terms and cosines where it grazes; elsewhere ratios agree to 1e-6.
TEST(DetailedBalance, holdsForEveryKindOfMutation) {
  const Balance balance = compareRatios<double>(Precision::doubled, 5e-3);
  for (const Mutation kind : kPathKinds) {
    const auto i = static_cast<size_t>(kind);
    EXPECT_GT(balance.compared[i], 150u) << i;
    EXPECT_EQ(balance.apart[i], 0u) << i << " of " << balance.compared[i];
  }
}

// In float, vertices are rounded to 2^-24 of their coordinates; what hangs on tiny distances or grazing angles is off
// by more, and that is seldom.
TEST(DetailedBalance, holdsInFloatUpToRounding) {
  const Balance balance = compareRatios<float>(Precision::floating, 5e-3);
  for (const Mutation kind : kPathKinds) {
    const auto i = static_cast<size_t>(kind);
    EXPECT_GT(balance.compared[i], 150u) << i;
    EXPECT_LE(balance.apart[i], balance.compared[i] / 50) << i;
  }
}

}  // namespace
}  // namespace wavecrest
