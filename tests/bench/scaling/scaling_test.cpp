// What processes render, and which rows the table has.
#include "bench/scaling/scaling.h"

#include <gtest/gtest.h>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

TEST(Scaling, processesRenderTheSameImageAsThreads) {
  Scene scene = smallBox(48, 32);
  const ChildRequest whole = processRequest(scene, "box.xml", Method::bpt, 3);
  EXPECT_EQ(whole.method, "bpt");
  EXPECT_EQ(whole.size, "48x32");
  EXPECT_EQ(whole.iterations, 3u);
  scene.film.cropWidth = 16;
  scene.film.cropHeight = 8;
  EXPECT_EQ(processRequest(scene, "box.xml", Method::bpt, 3).size, "") << "a size would take the place of the crop";
}

TEST(Scaling, hasARowForAllThreadsOfALargeMachine) {
  ScalingResult result;
  result.measured.resize(2);
  result.measured.back().threads = 384;
  EXPECT_NE(toText(result).find("\n      384 "), std::string::npos) << toText(result);
}

}  // namespace
}  // namespace wavecrest
