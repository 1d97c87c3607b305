// The sun and sky of Mitsuba 3 and of 0.6: where the sun stands, and which names are read.
#include <cmath>

#include "engine/load/sun_position.h"
#include "engine/scene/vector_math.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

constexpr double kTokyoHeight = 0.720308;  // of the sun at the default place and time, Mitsuba 3.9.1
constexpr double kDegree = 3.14159265358979324 / 180;

SunskyEmitter skyOf(const std::string& emitters, std::string_view version = "3.0.0") {
  const Scene scene = load(sceneXml(emitters + std::string(kSensor) + std::string(kSphere), version));
  EXPECT_EQ(scene.emitters.size(), 1u);
  return std::get<SunskyEmitter>(scene.emitters.at(0).kind);
}

void expectNear(const Double3& a, const Double3& b, double tolerance) {
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "coordinate " << i;
}

// Positions published by the US Naval Observatory would need a network; noon of an equinox and of the solstices do not.
// The sun crosses the meridian within a quarter of an hour of noon, at 90 degrees - latitude + declination.
TEST(SunPosition, IsInTheSouthAtNoonAsHighAsTheSeasonHasIt) {
  const struct {
    int month, day;
    double declination;
  } seasons[] = {{3, 20, 0}, {6, 21, 23.44}, {9, 23, 0}, {12, 21, -23.44}};
  for (const auto& season : seasons) {
    const SunPosition sun = sunPosition({.latitude = 50,
                                         .longitude = 15,
                                         .timezone = 1,
                                         .year = 2020,
                                         .month = season.month,
                                         .day = season.day,
                                         .hour = 12});
    EXPECT_NEAR(sun.zenithAngle / kDegree, 50 - season.declination, 0.4) << season.month;
    EXPECT_NEAR(std::abs(sun.azimuth) / kDegree, 180, 6) << season.month;
  }
}

TEST(SunPosition, IsInTheEastInTheMorningAndInTheWestInTheEvening) {
  PlaceAndTime at{.latitude = 0, .longitude = 0, .timezone = 0, .year = 2020, .month = 3, .day = 20, .hour = 9};
  EXPECT_NEAR(sunPosition(at).azimuth / kDegree, 90, 2);
  EXPECT_NEAR(sunPosition(at).zenithAngle / kDegree, 45, 2.5);
  at.hour = 15;
  EXPECT_NEAR(sunPosition(at).azimuth / kDegree, -90, 2);
}

TEST(Sunsky, DefaultsAreMitsubas) {
  const SunskyEmitter sky = skyOf(R"(<emitter type="sunsky"/>)");
  EXPECT_EQ(sky.turbidity, 3);
  EXPECT_EQ(sky.albedo, (Rgb{0.3, 0.3, 0.3}));
  EXPECT_EQ(sky.sunScale, 1);
  EXPECT_EQ(sky.skyScale, 1);
  EXPECT_EQ(sky.sunAperture, 0.5358);
  // As Mitsuba 3.9.1 prints it: Tokyo, 10 July 2010, 15:00.
  expectNear(sky.sunDirection, {0.0513851, 0.691748, kTokyoHeight}, 1e-4);
}

TEST(Sunsky, DirectionIsGivenInTheWorld) {
  const SunskyEmitter sky = skyOf(R"(<emitter type="sunsky"><vector name="sun_direction" value="0, 3, 4"/>
      <transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>)");
  expectNear(sky.sunDirection, {0, 0.6, 0.8}, 1e-15);
  expectNear(transformVector(sky.toWorld, {0, 0, 1}), {0, 1, 0}, 1e-15);
}

TEST(Sunsky, OfVersion06HasItsZenithAlongYAndNorthAlongMinusZ) {
  const SunskyEmitter sky = skyOf(R"(<emitter type="sunsky"><float name="sunScale" value="2"/>
      <float name="sunRadiusScale" value="3"/><integer name="resolution" value="64"/></emitter>)",
                                  "0.6.0");
  EXPECT_EQ(sky.sunScale, 2);
  EXPECT_EQ(sky.skyScale, 1);
  EXPECT_EQ(sky.albedo, (Rgb{0.2, 0.2, 0.2}));
  EXPECT_NEAR(sky.sunAperture, 3 * 0.5358, 1e-12);
  expectNear(transformVector(sky.toWorld, {0, 0, 1}), {0, 1, 0}, 1e-15);
  // The afternoon's sun is in the west, south of the zenith.
  EXPECT_NEAR(sky.sunDirection[1], kTokyoHeight, 1e-4);
  EXPECT_LT(sky.sunDirection[0], -0.5);
}

TEST(Sunsky, OfVersion06ScalesTheAperture) {
  const auto sceneOf = [](const std::string& content) {
    return load(sceneXml(
        "<emitter type=\"sunsky\">" + content + "</emitter>" + std::string(kSensor) + std::string(kSphere), "0.6.0"));
  };
  const auto apertureOf = [](const Scene& scene) {
    return std::get<SunskyEmitter>(scene.emitters.at(0).kind).sunAperture;
  };
  const std::string two = R"(<float name="sunAperture" value="2"/>)";
  EXPECT_EQ(apertureOf(sceneOf(two)), 2);
  EXPECT_EQ(apertureOf(sceneOf(two + R"(<float name="sunRadiusScale" value="1.5"/>)")), 3);
  const Scene point = sceneOf(R"(<float name="sunRadiusScale" value="0"/>)");
  EXPECT_EQ(apertureOf(point), 0.02);
  ASSERT_EQ(point.notes.size(), 2u);  // one more says which sky it is
  EXPECT_EQ(point.notes[0].what, "sun_aperture below 0.02 degrees");
}

TEST(Sunsky, SunAndSkyOfOneDayAreOneLight) {
  const SunskyEmitter both = skyOf(R"(<emitter type="sky"><float name="scale" value="3"/></emitter>
      <emitter type="sun"><float name="scale" value="5"/></emitter>)",
                                   "0.6.0");
  EXPECT_EQ(both.skyScale, 3);
  EXPECT_EQ(both.sunScale, 5);
  EXPECT_EQ(skyOf(R"(<emitter type="sun"/>)", "0.6.0").skyScale, 0);
  EXPECT_EQ(skyOf(R"(<emitter type="sky"/>)", "0.6.0").sunScale, 0);
  expectErrorOnLine2(R"(<emitter type="sun"/><emitter type="sky"><vector name="sun_direction" value="1"/></emitter>)",
                     "second environment light");
}

TEST(Sunsky, MistakesAreErrors) {
  const auto expectSkyError = [](const std::string& content, std::string_view text) {
    expectErrorOnLine2("<emitter type=\"sunsky\">" + content + "</emitter>", text);
  };
  expectSkyError(R"(<float name="turbidity" value="0.9"/>)", "expected 1 to 10");
  expectSkyError(R"(<float name="sun_scale" value="-1"/>)", "is negative");
  expectSkyError(R"(<vector name="sun_direction" value="0"/>)", "no direction");
  expectSkyError(R"(<vector name="sun_direction" value="1"/><float name="hour" value="3"/>)", "beside sun_direction");
  expectSkyError(R"(<float name="sun_aperture" value="180"/>)", "below 180");
  expectSkyError(R"(<rgb name="albedo" value="2"/>)", "out of range");
  expectSkyError(R"(<spectrum name="albedo" type="uniform"><float name="value" value="5"/></spectrum>)",
                 "albedo of the ground is above 1");
  expectSkyError(R"(<integer name="month" value="13"/>)", "13");
  expectSkyError(R"(<transform name="to_world"><matrix value="1 1 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>)",
                 "of the environment shears");
}

TEST(Sunsky, ASunTooSmallForFloatIsWidened) {
  const auto sunOf = [](const std::string& aperture) {
    return load(sceneXml("<emitter type=\"sunsky\"><float name=\"sun_aperture\" value=\"" + aperture +
                         "\"/></emitter>" + std::string(kSensor) + std::string(kSphere)));
  };
  const Scene small = sunOf("1e-4"), smallest = sunOf("0.02");
  EXPECT_EQ(std::get<SunskyEmitter>(small.emitters.at(0).kind).sunAperture, 0.02);
  ASSERT_EQ(small.notes.size(), 1u);
  EXPECT_EQ(small.notes[0].what, "sun_aperture below 0.02 degrees");
  EXPECT_TRUE(smallest.notes.empty());
}

TEST(Sunsky, NotesWhatItLeavesOut) {
  const Scene scene = load(sceneXml(R"(<emitter type="sunsky"><boolean name="complex_sun" value="true"/>
      <vector name="sun_direction" value="0, 0, -1"/></emitter>)" +
                                    std::string(kSensor) + std::string(kSphere)));
  ASSERT_EQ(scene.notes.size(), 2u);
  EXPECT_EQ(scene.notes[0].what, "complex_sun");
  EXPECT_EQ(scene.notes[0].effect,
            "the sun's disc is evenly bright, with the irradiance of Mitsuba's plain sun: a sun below 5 degrees is too "
            "bright");
  EXPECT_EQ(scene.notes[1].what, "sun below the horizon");
}

}  // namespace
}  // namespace wavecrest
