// Bytes of stages follow from the columns of the scene's waves; ceilings are measured and plausible.
#include "bench/score/roofline.h"

#include <gtest/gtest.h>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

TEST(StageTraffic, isThatOfTheColumnsOfTheContract) {
  const StageTraffic pathTracing(smallBox(8, 8), settingsOf(Method::pt));
  // extend reads origin and direction and writes u, v and primitive.
  EXPECT_EQ(pathTracing.bytesPerItem("extend"), 9 * sizeof(float));
  // nextEvent reads a vertex and writes a shadow ray of ten columns.
  const size_t shadowRay = 10 * sizeof(float), radiance = 3 * sizeof(float);
  EXPECT_EQ(pathTracing.bytesPerItem("occlude"), shadowRay + radiance);
  EXPECT_EQ(*pathTracing.bytesPerItem("next event") - *pathTracing.bytesPerItem("scatter"),
            shadowRay - (*pathTracing.bytesPerItem("generate") - radiance));
}

TEST(StageTraffic, knowsRowsByTheNameOfTheirStage) {
  const StageTraffic traffic(smallBox(8, 8), settingsOf(Method::vcm));
  EXPECT_EQ(traffic.bytesPerItem("extend light"), traffic.bytesPerItem("extend"));
  EXPECT_NE(traffic.bytesPerItem("connect to camera"), traffic.bytesPerItem("connect"));
  EXPECT_EQ(traffic.bytesPerItem("photon map"), std::nullopt);
  EXPECT_EQ(traffic.bytesPerItem("extended"), std::nullopt);
}

TEST(StageTraffic, growsWithTheColumnsThatAMethodNeeds) {
  const Scene scene = smallBox(8, 8);
  EXPECT_GT(StageTraffic(scene, settingsOf(Method::vcm)).bytesPerItem("scatter"),
            StageTraffic(scene, settingsOf(Method::pt)).bytesPerItem("scatter"));
}

// Not a test of speed: that the loops do what they count, in units that make sense.
TEST(Ceilings, areThoseOfACore) {
  const Ceilings ceilings = measureCeilings(bestIsa());
  EXPECT_GT(ceilings.operationsPerSecond, 1e8);
  EXPECT_LT(ceilings.operationsPerSecond, 1e13);
  EXPECT_GT(ceilings.cacheBytesPerSecond, 1e8);
  EXPECT_LT(ceilings.cacheBytesPerSecond, 1e13);
  EXPECT_GT(ceilings.memoryBytesPerSecond, 1e7);
}

}  // namespace
}  // namespace wavecrest
