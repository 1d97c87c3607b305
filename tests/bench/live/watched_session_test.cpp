// When a watched session looks, and of which iterations it tells an error: of independent ones alone.
#include "bench/live/watched_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/bench/small_box.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

// The error as of the last look at a render of so many iterations, the first of which has this number in the image.
std::optional<FilmError> errorAfter(uint64_t iterations, uint64_t first) {
  Scene scene = smallBox(32, 24);
  scene.film.filter = ReconstructionFilter::gaussian;
  RenderSettings settings = settingsOf(Method::pt);
  settings.firstIteration = first;
  std::optional<FilmError> error;
  WatchedSession session(Session::create(scene, settings), settings,
                         [&](const std::shared_ptr<const Look>& look) { error = look->error; });
  EXPECT_TRUE(session.film().spreads());
  session.renderUntil(iterations, std::nullopt);
  session.look(true);
  return error;
}

// How many iterations, a power of two up to 2^15, are enough for an error: it depends on the machine's speed.
std::optional<uint64_t> iterationsUntilError(uint64_t first) {
  for (uint64_t iterations = 64; iterations <= (1u << 15); iterations *= 2) {
    if (errorAfter(iterations, first)) return iterations;
  }
  return std::nullopt;
}

// Two iterations of a film that spreads samples have mirrored places in the filter.
TEST(WatchedSession, tellsNoErrorWhereItsFirstIterationIsTheSecondOfTwo) {
  const std::optional<uint64_t> ofFirst = iterationsUntilError(0), ofThird = iterationsUntilError(2);
  ASSERT_TRUE(ofFirst && ofThird);
  EXPECT_FALSE(errorAfter(2 * std::max(*ofFirst, *ofThird), 1));
}

// A session with a clock of its own, by which the first iteration and each of the others take so many seconds. As
// chains do, it begins none that would end after its limit, besides the first.
class SteppedSession final : public Session {
 public:
  struct Seconds {
    double begin = 0, first = 0, others = 0;
  };
  SteppedSession(std::unique_ptr<Session> within, Seconds seconds) : within_(std::move(within)), seconds_(seconds) {}

  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) override {
    for (;;) {
      const uint64_t done = within_->statistics().iterations;
      if (iterations && done >= *iterations) return;
      if (seconds && (done == 0 ? seconds_.begin >= *seconds : secondsAfter(done + 1) > *seconds)) return;
      within_->renderUntil(done + 1, std::nullopt);
    }
  }
  RenderStatistics statistics() const override { return within_->statistics(); }
  const Film& film() const override { return within_->film(); }
  const MemoryPlan& memoryPlan() const override { return within_->memoryPlan(); }
  void save(StateWriter& out) const override { within_->save(out); }
  void restore(StateReader& in) override { within_->restore(in); }
  double progressSeconds() const override { return secondsAfter(within_->statistics().iterations); }
  uint64_t progressPaths() const override { return within_->progressPaths(); }

 private:
  double secondsAfter(uint64_t iterations) const {
    return iterations == 0 ? seconds_.begin
                           : seconds_.begin + seconds_.first + seconds_.others * static_cast<double>(iterations - 1);
  }

  const std::unique_ptr<Session> within_;
  const Seconds seconds_;
};

// A session of which no error is known, as of chains, whose iterations take so many seconds, from `begin` on. looks: is
// told at which seconds it was looked at.
WatchedSession sessionOfChains(double begin, double step, std::vector<double>& looks) {
  RenderSettings settings = settingsOf(Method::pt);
  auto within =
      std::make_unique<SteppedSession>(Session::create(smallBox(8, 8), settings),
                                       SteppedSession::Seconds{.begin = begin, .first = step, .others = step});
  settings.method = Method::mlt;
  return {std::move(within), settings,
          [&looks](const std::shared_ptr<const Look>& look) { looks.push_back(look->renderSeconds); }};
}

// The look after the first iteration, by which slices begin, is the one that is due then.
TEST(WatchedSession, looksOnceAfterASlowFirstIteration) {
  const RenderSettings settings = settingsOf(Method::pt);
  size_t looks = 0;
  WatchedSession session(std::make_unique<SteppedSession>(Session::create(smallBox(32, 24), settings),
                                                          SteppedSession::Seconds{.first = 10}),
                         settings, [&](const std::shared_ptr<const Look>&) { ++looks; });
  session.renderUntil(2, std::nullopt);
  EXPECT_EQ(looks, 1u);
}

// Renders with steps of so many seconds. It begins at an hour, so that the cost of the looks puts none of them off.
void expectLooks(double step, double until, const std::vector<double>& expected) {
  std::vector<double> looks;
  WatchedSession session = sessionOfChains(3600, step, looks);
  session.renderUntil(std::nullopt, until);
  EXPECT_EQ(session.progressSeconds(), until);
  EXPECT_EQ(looks, expected);
}

TEST(WatchedSession, looksAfterEachStepThatIsLongerThanTheTimeBetweenLooks) {
  expectLooks(3, 3612, {3600, 3603, 3606, 3609});
}

TEST(WatchedSession, looksASecondApartWhereStepsAreAlmostAsLong) {
  expectLooks(0.75, 3606, {3600, 3601.5, 3603, 3604.5});
}

TEST(WatchedSession, leavesTheLookAtACallersLimitToTheCaller) {
  std::vector<double> looks;
  WatchedSession session = sessionOfChains(0, 1.0 / 64, looks);
  session.renderUntil(std::nullopt, 0.125);
  EXPECT_TRUE(looks.empty());
}

// The error of a sky that is the same everywhere, after so many iterations. Slices are of one iteration: the first has
// taken ten seconds.
std::optional<FilmError> errorOfSky(uint64_t iterations) {
  const test::TemporaryFolder folder;
  LoadOptions options;
  options.filmSize = {16, 8};
  const Scene scene = loadScene(
      folder.write(
          "scene.xml",
          R"(<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm"><rfilter type="box"/></film></sensor>
             <emitter type="constant"/><shape type="sphere"><point name="center" z="-9"/></shape></scene>)"),
      options);
  const RenderSettings settings = settingsOf(Method::pt);
  std::optional<FilmError> error;
  WatchedSession session(
      std::make_unique<SteppedSession>(Session::create(scene, settings), SteppedSession::Seconds{.first = 10}),
      settings, [&](const std::shared_ptr<const Look>& look) { error = look->error; });
  session.renderUntil(iterations, std::nullopt);
  session.look(true);
  return error;
}

// A small lamp that no path has hit yet would look the same.
TEST(WatchedSession, believesInAFilmWithoutVarianceOnlyAfterManyIterations) {
  EXPECT_FALSE(errorOfSky(kBlackIterations / 2));
  EXPECT_TRUE(errorOfSky(kBlackIterations));
}

}  // namespace
}  // namespace wavecrest
