// Errors at equal time are measured against an image that has all of the scene's light.
#include "bench/throughput/equal_time.h"

#include <gtest/gtest.h>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

// The ceiling lit through the mirror is bpt's.
TEST(EqualTime, theReferenceIsByTheMethodThatInspectNames) {
  const Scene scene = loadScene(findScene("cornell-mirror"), {.filmSize = std::array{64u, 48u}});
  const NoisyReference reference = renderReference(scene, settingsOf(Method::pt), 0);
  EXPECT_EQ(reference.method, Method::bpt);
  // One iteration of each half: the same bits whatever method is measured.
  EXPECT_EQ(reference.image.pixels, renderReference(scene, settingsOf(Method::bpt), 0).image.pixels);
}

}  // namespace
}  // namespace wavecrest
