// Errors at equal time are measured against an image that has all of the scene's light.
#include "bench/throughput/equal_time.h"

#include <gtest/gtest.h>

#include "bench/throughput/bench_scene.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

// The ceiling lit through the mirror is bpt's.
TEST(EqualTime, theReferenceIsByTheMethodThatInspectNames) {
  const Scene scene = loadScene(findScene("cornell-mirror"), {.filmSize = std::array{64u, 48u}});
  const NoisyReference reference = renderReference(scene, settingsOf(Method::pt), 0);
  EXPECT_EQ(reference.method, Method::bpt);
  EXPECT_FALSE(reference.biased);
  // One iteration of each half: the same bits whatever method is measured.
  EXPECT_EQ(reference.image.pixels, renderReference(scene, settingsOf(Method::bpt), 0).image.pixels);
}

TEST(EqualTime, aReferenceThatBlursIsDoubted) {
  const Scene scene = loadScene(findScene("cornell-spheres"), {.filmSize = std::array{32u, 24u}});
  SceneResult result{
      .scene = scene.name, .reference = renderReference(scene, settingsOf(Method::pt), 0), .methods = {}, .errors = {}};
  EXPECT_EQ(result.reference.method, Method::vcm);
  EXPECT_NE(toText(result).find("doubt: the reference is by vcm, which blurs"), std::string::npos);
  result.reference.biased = false;
  EXPECT_EQ(toText(result).find("doubt"), std::string::npos);
}

}  // namespace
}  // namespace wavecrest
