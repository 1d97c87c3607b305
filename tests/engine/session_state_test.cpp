// A render that is broken anywhere and goes on in another session, with other threads and waves, is bit for bit the
// one that was never broken; and a state of another render is refused.
#include "engine/state/state_stream.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 40, kHeight = 27;   // 1080 pixels: no multiple of any wave size below
constexpr uint64_t kIterations = effort(7, 3);  // across a restart of chains, with each number of threads and wave size

struct Kind {
  Method method;
  MetropolisVariant metropolis = MetropolisVariant::mmlt;
  Precision precision = Precision::floating;
  SamplerKind sampler = SamplerKind::independent;
  MergeVertices mergeVertices = MergeVertices::all;
};

std::string nameOf(const Kind& kind) {
  const std::string_view name = kind.method == Method::mlt
                                    ? kMetropolisVariantNames[static_cast<size_t>(kind.metropolis)]
                                    : toString(kind.method);
  return std::string(name) + "_" + std::string(kPrecisionNames[static_cast<size_t>(kind.precision)]) + "_" +
         std::string(toString(kind.sampler)) + (kind.mergeVertices == MergeVertices::first ? "_first" : "");
}

// evcm renders by one of the others, in either precision. State has the same shape in both, and in all methods that
// merge: under sanitizers vcm stands for these, and for all in double.
bool isLeftOut(Method method, Precision precision) {
  const bool isDouble = precision == Precision::doubled;
  if (isChosenByTrials(method)) return isDouble || !kFullSpeed;
  return !kFullSpeed && method != Method::vcm && (isDouble || strategiesOf(method).merge);
}

std::vector<Kind> kinds() {
  std::vector<Kind> list{{.method = Method::pt, .sampler = SamplerKind::sobol},
                         {.method = Method::lt, .sampler = SamplerKind::sobol}};
  if (kFullSpeed) list.push_back({.method = Method::vcm, .mergeVertices = MergeVertices::first});
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const MethodEntry& entry : kMethods) {
      if (isLeftOut(entry.method, precision)) continue;
      list.push_back({.method = entry.method, .precision = precision});
      if (entry.method != Method::mlt) continue;
      for (const MetropolisVariant variant : {MetropolisVariant::pssmlt, MetropolisVariant::pathspace}) {
        list.push_back({.method = entry.method, .metropolis = variant, .precision = precision});
      }
    }
  }
  return list;
}

// Merging adds up photons in an order that follows from how light paths are cut into waves: sessions that go on from
// each other cut them alike.
class SessionStateTest : public testing::TestWithParam<Kind> {
 protected:
  RenderSettings settings(uint32_t threads = 1, uint32_t waveSize = 256) const {
    RenderSettings settings;
    settings.method = GetParam().method;
    settings.precision = GetParam().precision;
    settings.sampler = GetParam().sampler;
    settings.mergeVertices = GetParam().mergeVertices;
    settings.balancedWalks = true;
    settings.isa = bestIsa();
    settings.threads = threads;
    settings.waveSize = waveSize;
    settings.seed = 5;
    settings.radius = 0.05;  // so that merging finds photons
    if (strategiesOf(settings.method).merge) {
      settings.waveSize = 256;
      settings.piecesForThreads = 1;
    }
    settings.metropolis.variant = GetParam().metropolis;
    settings.metropolis.chains = 500;
    settings.metropolis.bootstrapSamples = 4000;
    settings.metropolis.restartSteps = 4;  // so that iterations lie across a restart
    settings.measureStages = true;
    return settings;
  }
  std::unique_ptr<Session> session(const RenderSettings& settings) const { return Session::create(scene_, settings); }
  std::unique_ptr<Session> restored(const RenderSettings& settings, std::span<const unsigned char> state) const {
    auto session = Session::create(scene_, settings);
    restoreState(*session, state);
    return session;
  }

  const Scene scene_ = sceneFile("cornell-diffuse", kWidth, kHeight);
};

// Compares the counts that follow from the paths. mlt may have traced more rays, as it repeats a bootstrap that was
// interrupted.
void expectSameWork(const RenderStatistics& a, const RenderStatistics& b) {
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.paths, b.paths);
  EXPECT_EQ(a.lightPaths, b.lightPaths);
  ASSERT_EQ(a.stages.size(), b.stages.size());
  if (!a.chains) {
    EXPECT_EQ(a.counters.connections, b.counters.connections);
    EXPECT_EQ(a.counters.merges, b.counters.merges);
    EXPECT_EQ(a.counters.raysClosest, b.counters.raysClosest);
    EXPECT_EQ(a.counters.raysShadow, b.counters.raysShadow);
    EXPECT_EQ(a.counters.misses, b.counters.misses);
    for (size_t i = 0; i < a.stages.size(); ++i) EXPECT_EQ(a.stages[i].items, b.stages[i].items) << a.stages[i].name;
    return;
  }
  EXPECT_EQ(a.chains->mutations, b.chains->mutations);
  EXPECT_EQ(a.chains->directPaths, b.chains->directPaths);
  EXPECT_EQ(a.chains->epochs, b.chains->epochs);
  EXPECT_EQ(a.chains->brightness, b.chains->brightness);
  EXPECT_EQ(a.chains->counters.proposed, b.chains->counters.proposed);
  EXPECT_EQ(a.chains->counters.accepted, b.chains->counters.accepted);
  EXPECT_EQ(a.chains->counters.longestRejection, b.chains->counters.longestRejection);
  EXPECT_NEAR(a.chains->pooledBrightness, b.chains->pooledBrightness, 1e-9 * a.chains->pooledBrightness);
}

// After each iteration, in a session with other threads and waves each time.
TEST_P(SessionStateTest, iterationsInSeveralSessionsGiveTheImageOfOne) {
  const auto whole = session(settings());
  whole->renderUntil(kIterations, std::nullopt);
  const uint32_t threads[] = {1, 3, 2}, waves[] = {256, 64, 1000, 2048};
  std::vector<unsigned char> state = savedState(*session(settings()));
  std::unique_ptr<Session> part;
  for (uint64_t iterations = 0; iterations <= kIterations; ++iterations) {
    part = restored(settings(threads[iterations % 3], waves[iterations % 4]), state);
    part->renderUntil(iterations, std::nullopt);
    EXPECT_EQ(part->statistics().iterations, iterations);
    state = savedState(*part);
  }
  EXPECT_EQ(part->film().resolve(), whole->film().resolve());
  expectSameWork(part->statistics(), whole->statistics());
}

// Wherever the clock stops it: within bootstraps, iterations and direct passes.
TEST_P(SessionStateTest, stopsByTheClockChangeNothing) {
  constexpr uint64_t kMany = effort(40, 16);  // so many that paths of a pixel are traced together
  const auto whole = session(settings());
  whole->renderUntil(kMany, std::nullopt);
  std::vector<unsigned char> state = savedState(*session(settings()));
  int uneven = 0;
  constexpr double kShortest = kFullSpeed ? 5e-4 : 2e-3;  // seconds between stops
  // Merging methods finish iterations that have begun, and under sanitizers each of their sessions begins with a second
  // of pilot paths.
  const size_t stops = effort(40, strategiesOf(GetParam().method).merge ? 4 : 10);
  for (uint32_t stop = 0; stop < stops; ++stop) {
    RenderSettings own = settings(1 + stop % 3, stop % 2 == 0 ? 64 : 200);
    own.clock = ClockKind::cpu;  // which stands still while other programs run
    const auto part = restored(own, state);
    part->renderUntil(kMany, part->progressSeconds() + kShortest * (1 + stop % 8));
    uneven += part->film().minSamples() != part->film().maxSamples() ? 1 : 0;
    state = savedState(*part);
  }
  const bool wavesAreFree = !strategiesOf(GetParam().method).merge && GetParam().method != Method::mlt;
  EXPECT_TRUE(uneven > 0 || !wavesAreFree) << "the clock never stopped within an iteration";
  const auto last = restored(settings(2), state);
  last->renderUntil(kMany, std::nullopt);
  EXPECT_EQ(last->film().resolve(), whole->film().resolve());
  expectSameWork(last->statistics(), whole->statistics());
}

// The image is there at once, before anything more is rendered, and so are counts and clocks; bytes are the same again.
TEST_P(SessionStateTest, aRestoredSessionIsWhatWasSaved) {
  const auto before = session(settings());
  before->renderUntil(3, std::nullopt);
  const std::vector<unsigned char> state = savedState(*before);
  const auto after = restored(settings(2, 100), state);
  EXPECT_EQ(after->film().resolve(), before->film().resolve());
  expectSameWork(after->statistics(), before->statistics());
  EXPECT_EQ(after->statistics().renderSeconds, before->statistics().renderSeconds);
  EXPECT_EQ(after->statistics().cpuSeconds, before->statistics().cpuSeconds);
  EXPECT_EQ(after->progressSeconds(), before->progressSeconds());
  EXPECT_EQ(after->progressPaths(), before->progressPaths());
  EXPECT_EQ(savedState(*after), state);
}

// A goal that has been reached already is left as it is.
TEST_P(SessionStateTest, nothingIsLeftToDoAtTheGoal) {
  const auto before = session(settings());
  before->renderUntil(3, std::nullopt);
  const auto after = restored(settings(2), savedState(*before));
  after->renderUntil(3, std::nullopt);
  after->renderUntil(1, std::nullopt);
  EXPECT_EQ(after->statistics().iterations, 3u);
  EXPECT_EQ(after->statistics().paths, before->statistics().paths);
}

// However long the part that is left of it, a state ends in an error and not in memory that it does not have.
TEST_P(SessionStateTest, aStateThatEndsEarlyOrLateIsRefused) {
  const auto before = session(settings());
  before->renderUntil(2, std::nullopt);
  std::vector<unsigned char> state = savedState(*before);
  const auto other = session(settings());
  for (size_t length = 0; length < state.size(); length += std::max<size_t>(state.size() / 40, 1)) {
    EXPECT_THROW(restoreState(*other, std::span(state).first(length)), StateError) << length;
  }
  EXPECT_THROW(restoreState(*other, std::span(state).first(state.size() - 1)), StateError);
  state.push_back(0);
  EXPECT_THROW(restoreState(*other, state), StateError);
}

TEST_P(SessionStateTest, aFilmOfAnotherSizeIsRefused) {
  const std::vector<unsigned char> state = savedState(*session(settings()));
  const Scene scene = sceneFile("cornell-diffuse", kHeight, kWidth + 1);
  EXPECT_THROW(restoreState(*Session::create(scene, settings()), state), StateError);
}

INSTANTIATE_TEST_SUITE_P(Methods, SessionStateTest, testing::ValuesIn(kinds()),
                         [](const auto& instance) { return nameOf(instance.param); });

}  // namespace
}  // namespace wavecrest
