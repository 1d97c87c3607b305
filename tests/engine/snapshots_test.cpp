// When snapshots are due, and that no render goes on past its time.
#include "engine/session/snapshots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/effort.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

TEST(SnapshotSchedule, isRegularLogarithmicDoublingOrNone) {
  EXPECT_DOUBLE_EQ(*SnapshotSchedule::every(6).due(0).seconds, 6);
  EXPECT_DOUBLE_EQ(*SnapshotSchedule::every(6).due(9).seconds, 60);
  const SnapshotSchedule logarithmic = SnapshotSchedule::logarithmic();
  EXPECT_DOUBLE_EQ(*logarithmic.due(0).seconds, 0.1);
  EXPECT_NEAR(*logarithmic.due(12).seconds, 10, 1e-12) << "six per decade";
  EXPECT_EQ(*SnapshotSchedule::doubling().due(5).iterations, 32u);
  EXPECT_FALSE(SnapshotSchedule::doubling().due(5).seconds);
  EXPECT_FALSE(SnapshotSchedule::none().due(0).seconds || SnapshotSchedule::none().due(0).iterations);
}

TEST(SnapshotSchedule, logarithmicGoesOverIntoRegularOnes) {
  const SnapshotSchedule both = SnapshotSchedule::logarithmicThenEvery(10);
  double before = 0;
  unsigned number = 0;
  for (; *both.due(number).seconds < 300; ++number) {
    const double seconds = *both.due(number).seconds;
    EXPECT_GT(seconds, before);
    EXPECT_LE(seconds - before, 10 + 1e-9) << number;
    if (seconds > 40) {
      EXPECT_NEAR(seconds, 10 * std::round(seconds / 10), 1e-9);
    }
    before = seconds;
  }
  EXPECT_DOUBLE_EQ(*both.due(0).seconds, 0.1);
  EXPECT_NEAR(*both.due(12).seconds, 10, 1e-9) << "like the logarithmic one at first";
  EXPECT_DOUBLE_EQ(*both.due(number).seconds, 300);
}

class SnapshotsTest : public testing::TestWithParam<MethodEntry> {
 protected:
  std::unique_ptr<Session> session() const { return Session::create(scene_, settings_); }
  SnapshotsTest() {
    settings_.method = GetParam().method;
    settings_.isa = bestIsa();
    settings_.threads = 2;
    settings_.waveSize = 256;
    settings_.metropolis.chains = 270;  // four steps of all chains are a mutation per pixel
    settings_.metropolis.bootstrapSamples = 4096;
  }
  const Scene scene_ = sceneFile("cornell-diffuse", 40, 27);
  RenderSettings settings_;
};

TEST_P(SnapshotsTest, areTakenAfterTheirIterations) {
  settings_.iterations = 5;
  const auto own = session();
  std::vector<uint64_t> iterations;
  const unsigned count = renderWithSnapshots(*own, settings_, SnapshotSchedule::doubling(), [&](unsigned number) {
    EXPECT_EQ(number, iterations.size());
    iterations.push_back(own->statistics().iterations);
  });
  EXPECT_EQ(iterations, (std::vector<uint64_t>{1, 2, 4}));
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(own->statistics().iterations, 5u);
}

// The clock is looked at before every wave: a session that is out of time starts none, so a limit is overrun by what
// is under way, one wave per worker, and no more.
TEST_P(SnapshotsTest, noWaveStartsAfterTheEnd) {
  const auto own = session();
  own->renderUntil(std::nullopt, 1e-9);
  EXPECT_EQ(own->progressPaths(), 0u);
  EXPECT_EQ(own->statistics().lightPaths, 0u);
  own->renderUntil(std::nullopt, 0.02);
  const RenderStatistics before = own->statistics();
  own->renderUntil(std::nullopt, 0.02);
  const RenderStatistics after = own->statistics();
  EXPECT_EQ(after.paths, before.paths);
  EXPECT_EQ(after.lightPaths, before.lightPaths);
  const auto items = [](const RenderStatistics& s) {
    return std::accumulate(s.stages.begin(), s.stages.end(), uint64_t{0},
                           [](uint64_t sum, const auto& stage) { return sum + stage.items; });
  };
  EXPECT_EQ(items(after), items(before));
}

class BootstrapTest : public SnapshotsTest {};

// Renders in stretches as short as the machine allows: where it was too slow to trace anything in one, the next is
// twice as long.
class ShortStretches {
 public:
  explicit ShortStretches(Session& session) : session_(session) {}
  void renderOne() {
    const uint64_t before = rays();
    session_.renderUntil(std::nullopt, session_.progressSeconds() + seconds_);
    if (rays() == before) seconds_ *= 2;
    ++count_;
  }
  unsigned count() const { return count_; }

 private:
  uint64_t rays() const { return session_.statistics().counters.raysClosest; }
  Session& session_;
  double seconds_ = 1e-5;
  unsigned count_ = 0;
};

// However often a render stops, all pixels have a first sample before any has a second.
TEST_P(SnapshotsTest, theFirstPassGoesThroughAllPixels) {
  settings_.threads = 1;
  settings_.waveSize = 64;
  const auto own = session();
  ShortStretches stretches(*own);
  while (own->film().minSamples() == 0) {
    ASSERT_LE(own->film().maxSamples(), 1u);
    stretches.renderOne();
  }
  // Iterations with a photon map that have begun are finished.
  if (!strategiesOf(GetParam().method).merge) {
    EXPECT_GT(stretches.count(), 3u);
  }
}

// Chains render what the direct pass leaves out: without that pass their image would lack it.
TEST_P(BootstrapTest, mutationsComeAfterDirectLight) {
  const auto own = session();
  ShortStretches stretches(*own);
  while (own->statistics().iterations == 0) {
    stretches.renderOne();
    EXPECT_TRUE(own->progressPaths() == 0 || own->film().minSamples() > 0);
  }
}

// What a method does before its first path of the image, Metropolis' bootstrap above all, ends with the time as well.
TEST_P(SnapshotsTest, preparationsKeepToTheTime) {
  settings_.metropolis.bootstrapSamples = effort(1 << 18, 1 << 14);
  const auto whole = session();
  whole->renderUntil(20, std::nullopt);
  settings_.seconds = 1e-4;
  const auto own = session();
  own->renderUntil(std::nullopt, settings_.seconds);
  EXPECT_LT(own->statistics().counters.raysClosest, whole->statistics().counters.raysClosest / 2);
}

// A bootstrap that is stopped, over and over, is that of an unbroken render.
TEST_P(BootstrapTest, goesOnWhereItStopped) {
  settings_.metropolis.bootstrapSamples = effort(1 << 16, 1 << 13);
  const auto whole = session(), own = session();
  whole->renderUntil(20, std::nullopt);
  ShortStretches stretches(*own);
  while (own->progressPaths() == 0) stretches.renderOne();
  EXPECT_GT(stretches.count(), 1u);
  ASSERT_LT(own->statistics().iterations, 20u);
  own->renderUntil(20, std::nullopt);
  EXPECT_EQ(own->statistics().chains->directPaths, whole->statistics().chains->directPaths);
  EXPECT_EQ(own->film().resolve(), whole->film().resolve());
}

// A limit is not overrun because all chains move together, nor is a snapshot at its end lost where they stop before it.
// However long a step takes: chains end where the time left is too short for another.
TEST_P(SnapshotsTest, theLastSnapshotIsAtTheLimit) {
  for (const double seconds : {0.05, 0.002, 0.0001}) {
    settings_.seconds = seconds;
    const auto own = session();
    unsigned taken = 0;
    const unsigned count =
        renderWithSnapshots(*own, settings_, SnapshotSchedule::every(seconds / 2), [&](unsigned) { ++taken; });
    EXPECT_EQ(taken, 2u) << seconds;
    EXPECT_EQ(count, 2u) << seconds;
  }
}

// The limits of a call may lie behind those of the settings.
TEST_P(SnapshotsTest, theLimitsAreThoseOfTheCall) {
  settings_.seconds = 1e-9;
  const auto own = session();
  own->renderUntil(1, std::nullopt);
  EXPECT_EQ(own->statistics().iterations, 1u);
}

// Iterations of a session that starts at k are those of one that rendered k before: sums agree, to rounding.
TEST_P(SnapshotsTest, aSessionMayStartAtALaterIteration) {
  settings_.guide = GuideTarget::off;  // a session learns from its own iterations
  const auto image = [&](uint64_t first, uint64_t count) {
    settings_.firstIteration = first;
    if (GetParam().method == Method::mlt && first != 0) {  // where chains stand follows from all steps before
      EXPECT_THROW(session(), std::invalid_argument);
      return std::vector<float>();
    }
    const auto own = session();
    own->renderUntil(count, std::nullopt);
    EXPECT_EQ(own->statistics().iterations, count);
    return own->film().resolve();
  };
  const std::vector<float> all = image(0, 3), begin = image(0, 1), end = image(1, 2);
  if (end.empty()) return;
  for (size_t i = 0; i < all.size(); ++i) {
    const float parts = (begin[i] + 2 * end[i]) / 3;
    ASSERT_NEAR(all[i], parts, 1e-6f + 1e-5f * all[i]) << i;
  }
}

std::string nameOfEntry(const testing::TestParamInfo<MethodEntry>& entry) { return std::string(entry.param.name); }

// Under sanitizers without evcm, which renders by one of the others.
std::vector<MethodEntry> snapshotMethods() {
  std::vector<MethodEntry> methods(kMethods.begin(), kMethods.end());
  if (!kFullSpeed) std::erase_if(methods, [](const MethodEntry& entry) { return isChosenByTrials(entry.method); });
  return methods;
}

INSTANTIATE_TEST_SUITE_P(Methods, SnapshotsTest, testing::ValuesIn(snapshotMethods()), nameOfEntry);
INSTANTIATE_TEST_SUITE_P(Methods, BootstrapTest, testing::Values(entryOf(Method::mlt)), nameOfEntry);

}  // namespace
}  // namespace wavecrest
