// The error that a watched session tells is of independent iterations alone.
#include "bench/live/watched_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

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

}  // namespace
}  // namespace wavecrest
