// The error that a watched session tells is of independent iterations alone.
#include "bench/live/watched_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "tests/bench/small_box.h"

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

// A session whose first iteration takes ten seconds by its clock, and the others none.
class SlowSession final : public Session {
 public:
  explicit SlowSession(std::unique_ptr<Session> within) : within_(std::move(within)) {}
  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> /*seconds*/) override {
    within_->renderUntil(iterations, std::nullopt);
  }
  RenderStatistics statistics() const override { return within_->statistics(); }
  const Film& film() const override { return within_->film(); }
  const MemoryPlan& memoryPlan() const override { return within_->memoryPlan(); }
  void save(StateWriter& out) const override { within_->save(out); }
  void restore(StateReader& in) override { within_->restore(in); }
  double progressSeconds() const override { return statistics().iterations == 0 ? 0 : 10; }
  uint64_t progressPaths() const override { return within_->progressPaths(); }

 private:
  const std::unique_ptr<Session> within_;
};

// The look after the first iteration, by which slices begin, is the one that is due then.
TEST(WatchedSession, looksOnceAfterASlowFirstIteration) {
  const RenderSettings settings = settingsOf(Method::pt);
  size_t looks = 0;
  WatchedSession session(std::make_unique<SlowSession>(Session::create(smallBox(32, 24), settings)), settings,
                         [&](const std::shared_ptr<const Look>&) { ++looks; });
  session.renderUntil(1, std::nullopt);
  EXPECT_EQ(looks, 1u);
}

}  // namespace
}  // namespace wavecrest
