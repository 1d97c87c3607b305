// Picks of emitters by what each gives to the film: seven eighths of the shares, the rest is even among emitters that
// are not black.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/pilot/light_picks.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// A floor seen from above.
Scene floorUnder(const std::string& emitters) {
  return loadBody(
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"20\"/><transform name=\"to_world\">"
      "<lookat origin=\"0, 0, 5\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"32\"/><integer name=\"height\" value=\"24\"/></film>"
      "</sensor><shape type=\"rectangle\"/>" +
      emitters);
}

// Faces down.
std::string lamp(const char* place, double radiance) {
  return std::string(
             "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.2\"/>"
             "<rotate x=\"1\" angle=\"180\"/><translate value=\"") +
         place + "\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"" + std::to_string(radiance) +
         "\"/></emitter></shape>";
}

template <class S>
std::vector<double> picksOf(const Scene& scene, Precision precision) {
  RenderSettings settings;
  settings.method = Method::pt;
  settings.precision = precision;
  RenderPlan<S> plan = planRender<S>(scene, settings);
  pickLightsByView(plan, settings, filmArea(scene.film));
  std::vector<double> picks;
  for (uint32_t i = 0; i < plan.view.lightCount; ++i) picks.push_back(plan.view.lights[i].pick);
  return picks;
}

TEST(LightPicksByView, areEvenAloneForALampOutOfView) {
  const std::vector<double> picks =
      picksOf<float>(floorUnder(lamp("2, 0, 1", 1) + lamp("0, 0, -1", 100)), Precision::floating);
  ASSERT_EQ(picks.size(), 2u);
  EXPECT_NEAR(picks[0], 1 - 0.125 / 2, 1e-6);
  EXPECT_NEAR(picks[1], 0.125 / 2, 1e-6);
}

TEST(LightPicksByView, areNeverOfABlackLamp) {
  const std::string lit = lamp("2, 0, 1", 1), black = lamp("-2, 0, 1", 0), outOfView = lamp("0, 0, -1", 100);
  const std::vector<double> ofOneLit = picksOf<float>(floorUnder(lit + black), Precision::floating);
  ASSERT_EQ(ofOneLit.size(), 2u);
  EXPECT_EQ(ofOneLit[0], 1);
  EXPECT_EQ(ofOneLit[1], 0);
  // The even eighth is divided among the two lit ones.
  const std::vector<double> picks = picksOf<float>(floorUnder(lit + black + outOfView), Precision::floating);
  ASSERT_EQ(picks.size(), 3u);
  EXPECT_NEAR(picks[0], 1 - 0.125 / 2, 1e-6);
  EXPECT_EQ(picks[1], 0);
  EXPECT_NEAR(picks[2], 0.125 / 2, 1e-6);
}

TEST(LightPicksByView, areThoseOfALampForASpotThatIsAsBright) {
  const std::string spot =
      "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"40\"/><rgb name=\"intensity\" value=\"1\"/>"
      "<transform name=\"to_world\"><lookat origin=\"0, 0, 2\" target=\"0, 0, 0\" up=\"0, 1, "
      "0\"/></transform></emitter>";
  const std::string point =
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"2\"/><rgb name=\"intensity\" "
      "value=\"1\"/></emitter>";
  const std::vector<double> picks = picksOf<float>(floorUnder(spot + point), Precision::floating);
  ASSERT_EQ(picks.size(), 2u);
  EXPECT_NEAR(picks[0], 0.5, 0.05);
  const auto byPower = planRender<float>(floorUnder(spot + point), {});
  EXPECT_LT(byPower.scene->lights.records[0].pick, 0.35f);
}

TEST(LightPicksByView, areTheSameInDouble) {
  const Scene scene = floorUnder(lamp("0.5, 0, 1", 3) + lamp("-0.5, 0, 1", 1) + "<emitter type=\"constant\"/>");
  const std::vector<double> inFloat = picksOf<float>(scene, Precision::floating),
                            inDouble = picksOf<double>(scene, Precision::doubled);
  ASSERT_EQ(inFloat.size(), 3u);
  for (size_t i = 0; i < inFloat.size(); ++i) EXPECT_NEAR(inFloat[i], inDouble[i], 1e-7) << i;
}

}  // namespace
}  // namespace wavecrest
