// What becomes of whole scenes in the intersector of small ones: without boxes images are as right, only later.
#include <gtest/gtest.h>

#include "engine/compile/compiled_scene.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

TEST(SmallSceneTest, roomAndBlocksOfTheCornellBoxAreBoxes) {
  const auto compiled = compileScene<float>(sceneFile("mitsuba-cornell-box", 64, 64), Accel::small);
  const SmallSceneView& view = compiled->small->view();
  EXPECT_EQ(view.closedBoxCount, 2u);
  EXPECT_EQ(view.openBoxCount, 1u);
  EXPECT_EQ(view.quadCount, 1u);  // the lamp
}

TEST(SmallSceneTest, theRoomAroundTheSpheresIsABox) {
  const auto compiled = compileScene<float>(sceneFile("cornell-spheres", 64, 64), Accel::small);
  const SmallSceneView& view = compiled->small->view();
  EXPECT_EQ(view.openBoxCount, 1u);
  EXPECT_EQ(view.quadCount, 0u);
  EXPECT_EQ(view.sphereCount, 2u);
}

}  // namespace
}  // namespace wavecrest
