// Lights: defaults, parameters, and what is refused.
#include <cmath>

#include "metrics/image/image_io.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

template <class Kind>
Kind emitterOf(std::string_view type, std::string_view content = "") {
  const Scene scene = loadBody("<emitter type=\"" + std::string(type) + "\">" + std::string(content) + "</emitter>");
  return std::get<Kind>(scene.emitters.at(0).kind);
}
void expectEmitterError(std::string_view type, std::string_view content, std::string_view text) {
  expectErrorOnLine2("<emitter type=\"" + std::string(type) + "\">" + std::string(content) + "</emitter>", text);
}

constexpr Rgb kOne{1, 1, 1};

TEST(AreaLight, BelongsToItsShape) {
  const Scene scene = loadBody(R"(<shape type="sphere"/><shape type="rectangle"><emitter type="area">
      <rgb name="radiance" value="17, 12, 4"/></emitter></shape>)");
  ASSERT_EQ(scene.emitters.size(), 1u);
  const AreaEmitter& light = std::get<AreaEmitter>(scene.emitters[0].kind);
  EXPECT_EQ(light.radiance.value, (Rgb{17, 12, 4}));
  EXPECT_EQ(light.shape, 1u);
  EXPECT_EQ(scene.shapes[1].emitter, 0u);
  EXPECT_EQ(scene.shapes[0].emitter, kNone);
}

TEST(AreaLight, RadianceDefaultsToOne) {
  const Scene scene = loadBody(R"(<shape type="sphere"><emitter type="area"/></shape>)");
  EXPECT_EQ(std::get<AreaEmitter>(scene.emitters.at(0).kind).radiance.value, kOne);
}

TEST(AreaLight, RadianceCanBeATexture) {
  const Scene scene = loadBody(
      R"(<shape type="sphere"><emitter type="area"><texture type="checkerboard" name="radiance"/></emitter></shape>)");
  EXPECT_EQ(std::get<AreaEmitter>(scene.emitters.at(0).kind).radiance.texture, 0u);
}

TEST(AreaLight, OfTheSceneBelongsToTheShapesThatReferToIt) {
  const Scene scene =
      loadBody(R"(<shape type="sphere"><ref id="lamp"/></shape><shape type="cube"><ref id="lamp"/></shape>
      <emitter type="area" id="lamp"><rgb name="radiance" value="3"/></emitter>)");
  ASSERT_EQ(scene.emitters.size(), 2u);
  EXPECT_EQ(scene.shapes[1].emitter, 1u);
  EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[1].kind).shape, 1u);
  EXPECT_EQ(std::get<AreaEmitter>(scene.emitters[0].kind).radiance.value, (Rgb{3, 3, 3}));
}

TEST(AreaLight, OutsideOfAShapeIsAnError) { expectEmitterError("area", "", "area light outside of a shape"); }

TEST(AreaLight, OtherLightsInsideAShapeAreErrors) {
  expectErrorOnLine2(R"(<shape type="sphere"><emitter type="point"/></shape>)", "inside a shape; expected \"area\"");
}

TEST(PointLight, Defaults) {
  EXPECT_EQ(emitterOf<PointEmitter>("point").position, (Double3{0, 0, 0}));
  EXPECT_EQ(emitterOf<PointEmitter>("point").intensity, kOne);
}

TEST(PointLight, PositionOrToWorld) {
  EXPECT_EQ(emitterOf<PointEmitter>("point", R"(<point name="position" x="1" y="2" z="3"/>)").position,
            (Double3{1, 2, 3}));
  EXPECT_EQ(emitterOf<PointEmitter>("point", R"(<transform name="to_world"><translate y="4"/></transform>)").position,
            (Double3{0, 4, 0}));
  expectEmitterError("point", R"(<point name="position" value="1"/><transform name="to_world"/>)", "one of the two");
}

TEST(PointLight, TexturedIntensityIsAnError) {
  expectEmitterError("point", R"(<texture type="checkerboard" name="intensity"/>)", "is a texture");
}

TEST(SpotLight, Defaults) {
  const SpotEmitter spot = emitterOf<SpotEmitter>("spot");
  EXPECT_EQ(spot.direction, (Double3{0, 0, 1}));
  EXPECT_EQ(spot.intensity, kOne);
  EXPECT_EQ(spot.cutoffAngle, 20);
  EXPECT_EQ(spot.beamWidth, 15);
  EXPECT_EQ(spot.texture, kNone);
}

TEST(SpotLight, MayHaveATexture) {
  const std::string texture = R"(<texture type="checkerboard" name="texture"/>)";
  EXPECT_EQ(emitterOf<SpotEmitter>("spot", texture).texture, 0u);
  expectEmitterError("spot",
                     texture + R"(<transform name="to_world"><matrix value="1 1 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/>)"
                               R"(</transform>)",
                     "of the spot light shears");
  expectEmitterError(
      "spot", R"(<texture type="rawconstant" name="texture"><vector name="value" x="-1" y="0" z="0"/></texture>)",
      "emission texture has a value of -1");
}

TEST(Projector, Defaults) {
  const auto projector = emitterOf<ProjectorEmitter>("projector");
  EXPECT_EQ(projector.irradiance.value, kOne);
  EXPECT_EQ(projector.irradiance.texture, kNone);
  EXPECT_EQ(projector.scale, 1);
  EXPECT_EQ(projector.aspect, 1);
  // 50 mm of focal length over the diagonal of a square.
  EXPECT_NEAR(projector.fovX, 2 * std::atan(std::hypot(36, 24) / 100 / std::sqrt(2)) * 180 / 3.141592653589793, 1e-12);
}

TEST(Projector, PictureGivesTheAspect) {
  const Folder folder;
  writeExr((folder.path() / "picture.exr").string(),
           {.width = 2, .height = 1, .channels = 3, .pixels = {1, 2, 3, 4, 5, 6}});
  const Scene scene = loadBody(folder, R"(<emitter type="projector"><float name="fov" value="90"/>
      <string name="fov_axis" value="y"/><float name="scale" value="3"/><texture type="bitmap" name="irradiance">
      <string name="filename" value="picture.exr"/></texture></emitter>)");
  const auto& projector = std::get<ProjectorEmitter>(scene.emitters.at(0).kind);
  EXPECT_EQ(projector.irradiance.texture, 0u);
  EXPECT_EQ(projector.scale, 3);
  EXPECT_EQ(projector.aspect, 2);
  EXPECT_NEAR(projector.fovX, 2 * std::atan(2.0) * 180 / 3.141592653589793, 1e-12);
}

TEST(Projector, MistakesAreErrors) {
  expectEmitterError("projector", R"(<float name="scale" value="-1"/>)", "scale of the projector is negative");
  expectEmitterError("projector", R"(<transform name="to_world"><scale value="2"/></transform>)",
                     "of the projector scales");
  expectEmitterError("projector", R"(<float name="fov" value="180"/>)", "field of view");
}

TEST(SpotLight, BeamIsThreeQuartersOfTheCutoff) {
  EXPECT_EQ(emitterOf<SpotEmitter>("spot", R"(<float name="cutoff_angle" value="40"/>)").beamWidth, 30);
}

TEST(SpotLight, LooksAlongItsTransform) {
  const SpotEmitter spot = emitterOf<SpotEmitter>(
      "spot", R"(<transform name="to_world"><lookat origin="0,5,0" target="0,0,0" up="1,0,0"/></transform>)");
  EXPECT_EQ(spot.position, (Double3{0, 5, 0}));
  EXPECT_EQ(spot.direction, (Double3{0, -1, 0}));
}

TEST(SpotLight, ConeThatMitsubaDeformsIsNoted) {
  const auto scene = [](const std::string& scale) {
    return loadBody(R"(<emitter type="spot"><transform name="to_world"><scale )" + scale + "/></transform></emitter>");
  };
  ASSERT_EQ(scene(R"(x="2")").notes.size(), 1u);
  EXPECT_NE(scene(R"(x="2")").notes[0].effect.find("stays circular"), std::string::npos);
  EXPECT_TRUE(scene(R"(value="2")").notes.empty());
}

TEST(SpotLight, AnglesAreChecked) {
  expectEmitterError("spot", R"(<float name="cutoff_angle" value="91"/>)", "above 90 degrees");
  expectEmitterError("spot", R"(<float name="beam_width" value="30"/>)",
                     "beam_width is 30.000000; expected 0 to the cutoff_angle, 20.000000 degrees");
  expectEmitterError("spot", R"(<float name="beam_width" value="-5"/>)", "beam_width is -5.000000; expected 0 to");
}

TEST(DirectionalLight, Defaults) {
  EXPECT_EQ(emitterOf<DirectionalEmitter>("directional").direction, (Double3{0, 0, 1}));
  EXPECT_EQ(emitterOf<DirectionalEmitter>("directional").irradiance, kOne);
}

TEST(DirectionalLight, DirectionIsNormalised) {
  EXPECT_EQ(emitterOf<DirectionalEmitter>("directional", R"(<vector name="direction" x="0" y="-3" z="4"/>)").direction,
            (Double3{0, -0.6000000000000001, 0.8}));
}

TEST(DirectionalLight, MistakesAreErrors) {
  expectEmitterError("directional", R"(<vector name="direction" value="0"/>)", "no direction");
  expectEmitterError("directional", R"(<vector name="direction" value="1"/><transform name="to_world"/>)",
                     "one of the two");
}

TEST(ConstantLight, RadianceDefaultsToOne) { EXPECT_EQ(emitterOf<ConstantEmitter>("constant").radiance, kOne); }

TEST(ConstantLight, SecondEnvironmentIsAnError) {
  expectErrorOnLine2(R"(<emitter type="constant"/><emitter type="constant"/>)", "second environment light");
}

TEST(EnvironmentMap, KeepsPixelsScaleAndTransform) {
  const Folder folder;
  writeExr((folder.path() / "sky.exr").string(),
           {.width = 2, .height = 1, .channels = 3, .pixels = {1, 2, 3, 4, 5, 6}});
  const Scene scene = loadBody(folder, R"(<emitter type="envmap"><string name="filename" value="sky.exr"/>
      <float name="scale" value="2"/><transform name="to_world"><rotate y="1" angle="180"/></transform></emitter>)");
  const EnvmapEmitter& sky = std::get<EnvmapEmitter>(scene.emitters.at(0).kind);
  EXPECT_EQ(sky.bitmap->width, 2u);
  EXPECT_EQ(sky.bitmap->pixels, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(sky.scale, 2);
  EXPECT_EQ(sky.toWorld[0][0], -1);
}

TEST(EnvironmentMap, TexelsOfNegativeLuminanceAndNonFiniteValuesAreBlackAndCounted) {
  const Folder folder;
  writeExr((folder.path() / "sky.exr").string(),
           {.width = 2, .height = 1, .channels = 3, .pixels = {1, -1, 1, NAN, 2, -3}});
  const Scene scene = loadBody(folder, R"(<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>)");
  EXPECT_EQ(std::get<EnvmapEmitter>(scene.emitters.at(0).kind).bitmap->pixels, (std::vector<float>{0, 0, 0, 0, 2, -3}));
  ASSERT_EQ(scene.notes.size(), 2u);
  EXPECT_EQ(scene.notes[0].what, "values in \"sky.exr\" that are not finite: 1");
  EXPECT_EQ(scene.notes[1].what, "texels of negative luminance in the environment \"sky.exr\": 1");
}

TEST(EnvironmentMap, MayScaleUnevenlyWithANoteButNotShearOrFlatten) {
  const Folder folder;
  writeExr((folder.path() / "sky.exr").string(), {.width = 1, .height = 1, .channels = 3, .pixels = {1, 1, 1}});
  const auto withMatrix = [](std::string_view rows) {
    return "\n<emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/><transform name=\"to_world\">"
           "<matrix value=\"" +
           std::string(rows) + "\"/></transform></emitter>";
  };
  const Scene scene = loadBody(folder, withMatrix("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "environment whose to_world scales unevenly");
  EXPECT_TRUE(loadBody(folder, withMatrix("-2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1")).notes.empty());
  for (const char* rows : {"1 0.5 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "1 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1"}) {
    expectError(folder, sceneXml(std::string(kSensor) + std::string(kSphere) + withMatrix(rows)), 2,
                "of the environment shears or flattens");
  }
}

TEST(EnvironmentMap, MissingFileIsReportedWhereItIsNamed) {
  expectErrorOnLine2(R"(<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>)", "not found");
}

TEST(Light, SamplingWeightIsAccepted) {
  EXPECT_EQ(emitterOf<ConstantEmitter>("constant", R"(<float name="sampling_weight" value="2"/>)").radiance, kOne);
}

TEST(Light, OfSamplingWeight0IsLeftOutIfPathsCannotHitIt) {
  const auto sceneOf = [](const std::string& type) {
    return loadBody("<emitter type=\"" + type + R"("><float name="sampling_weight" value="0"/></emitter>)");
  };
  for (const char* type : {"point", "spot", "projector", "directional"}) {
    const Scene scene = sceneOf(type);
    EXPECT_TRUE(scene.emitters.empty()) << type;
    ASSERT_EQ(scene.notes.size(), 1u) << type;
    EXPECT_EQ(scene.notes[0].what, "emitter \"" + std::string(type) + "\" of sampling_weight 0");
  }
  EXPECT_EQ(sceneOf("constant").emitters.size(), 1u);
  expectEmitterError("point", R"(<float name="sampling_weight" value="-1"/>)", "sampling_weight is negative");
}

}  // namespace
}  // namespace wavecrest
