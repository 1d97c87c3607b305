// Textures that no image file belongs to, and what all textures have.
#include <utility>

#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

TEST(RawConstant, IsAValue) {
  const Scene scene = loadBody(texturedSphere(
      R"(<texture name="reflectance" type="rawconstant"><vector name="value" x="0.1" y="0.2" z="0.3"/></texture>)"));
  EXPECT_EQ(scene.textures.size(), 0u);
  const Rgb value = std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value;
  EXPECT_FLOAT_EQ(static_cast<float>(value[1]), 0.2f);
}

TEST(RawConstant, IsInTheRangeOfWhatItStandsFor) {
  const std::string negative =
      R"(<texture name="NAME" type="rawconstant"><vector name="value" x="-1" y="0" z="0"/></texture>)";
  const auto named = [&](const std::string& name) {
    return std::string(negative).replace(negative.find("NAME"), 4, name);
  };
  expectErrorOnLine2(texturedSphere(named("reflectance")), "a value of -1");
  expectErrorOnLine2(R"(<shape type="sphere"><emitter type="area">)" + named("radiance") + "</emitter></shape>",
                     "emission texture has a value of -1");
  const auto rough = [](const std::string& value) {
    return R"(<shape type="sphere"><bsdf type="principled"><texture name="roughness" type="rawconstant">)"
           R"(<vector name="value" value=")" +
           value + R"("/></texture></bsdf></shape>)";
  };
  expectErrorOnLine2(rough("-0.5"), "\"roughness\" has a value of -0.5");
  expectErrorOnLine2(rough("1e300"), "\"value\" of texture \"rawconstant\" is out of range");
  const Scene scene = loadBody(rough("0.5"));
  EXPECT_EQ(std::get<Principled>(scene.materials.at(0).kind).roughness.value, 0.5);
}

TEST(Checkerboard, Defaults) {
  const Scene scene = loadBody(texturedSphere(R"(<texture name="reflectance" type="checkerboard"/>)"));
  const CheckerboardTexture& board = std::get<CheckerboardTexture>(scene.textures.at(0).kind);
  EXPECT_EQ(board.color0, (Rgb{0.4, 0.4, 0.4}));
  EXPECT_EQ(board.color1, (Rgb{0.2, 0.2, 0.2}));
}

// diff_trans reaches 2, and a texture does not know what it is for.
TEST(Checkerboard, NumbersMayBeAbove1AndColoursMayNot) {
  const Scene scene = loadBody(R"(<texture type="checkerboard" id="t"><float name="color1" value="1.4"/></texture>
      <shape type="sphere"><bsdf type="principledthin"><ref id="t" name="diff_trans"/></bsdf></shape>)");
  const uint32_t texture = std::get<Principled>(scene.materials.at(0).kind).diffTrans.texture;
  EXPECT_EQ(std::get<CheckerboardTexture>(scene.textures.at(texture).kind).color0[0], 1.4);
  expectErrorOnLine2(
      R"(<texture type="checkerboard" id="t"><rgb name="color1" value="1.4"/></texture><shape type="sphere">
      <bsdf type="principledthin"><ref id="t" name="diff_trans"/></bsdf></shape>)",
      "expected values from 0 to 1");
}

TEST(Checkerboard, OfReflectancesAbove1IsAWarning) {
  const Scene scene = loadBody(texturedSphere(
      R"(<texture name="reflectance" type="checkerboard"><float name="color1" value="1.4"/></texture>)"));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("up to 1.4"), std::string::npos) << scene.warnings[0];
}

// Mitsuba 3.9 exchanges the colours, though its documentation does not say so. In Mitsuba 0.6 a texture has the same
// values whether a colour or a number is read from it.
TEST(Checkerboard, SwapsItsColoursWhereANumberIsAskedForButInOldFiles) {
  const std::string body = R"(<texture type="checkerboard" id="t"/><shape type="sphere"><bsdf type="mask">
    <ref id="t" name="opacity"/><bsdf type="diffuse"><ref id="t" name="reflectance"/></bsdf></bsdf></shape>)";
  const auto firstColour = [](const Scene& scene, uint32_t texture) {
    return std::get<CheckerboardTexture>(scene.textures.at(texture).kind).color0[0];
  };
  for (const auto& [version, first] : {std::pair{"3.0.0", 0.2}, std::pair{"0.6.0", 0.4}}) {
    const Scene scene = load(sceneXml(body + std::string(kSensor), version));
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(firstColour(scene, std::get<Diffuse>(material.kind).reflectance.texture), 0.4) << version;
    EXPECT_EQ(firstColour(scene, material.opacity->texture), first) << version;
  }
}

TEST(Checkerboard, ColoursAreTheirMeansWhereANumberIsAskedFor) {
  const Scene scene = loadBody(R"(<shape type="sphere"><bsdf type="mask"><texture type="checkerboard" name="opacity">
      <rgb name="color0" value="0.3, 0.6, 0"/></texture><bsdf type="diffuse"/></bsdf></shape>)");
  const auto& board = std::get<CheckerboardTexture>(scene.textures.at(scene.materials.at(0).opacity->texture).kind);
  for (const double channel : board.color1) EXPECT_NEAR(channel, 0.3, 1e-15);
}

TEST(Texture, ToUvActsOnTextureCoordinates) {
  const Scene scene = loadBody(texturedSphere(
      R"(<texture name="reflectance" type="checkerboard"><transform name="to_uv"><translate x="0.1"/><scale x="2" y="3"/></transform></texture>)"));
  const Matrix4& m = scene.textures.at(0).toUv;
  EXPECT_EQ(m[0][0], 2);
  EXPECT_EQ(m[1][1], 3);
  EXPECT_EQ(m[0][3], 0.2);
}

TEST(Texture, IsReadOnceHoweverOftenItIsReferenced) {
  const Scene scene = loadBody(R"(<texture type="checkerboard" id="t"/>
    <shape type="sphere"><bsdf type="diffuse"><ref id="t" name="reflectance"/></bsdf></shape>
    <shape type="cube"><bsdf type="plastic"><ref id="t" name="diffuse_reflectance"/></bsdf></shape>)");
  EXPECT_EQ(scene.textures.size(), 1u);
}

}  // namespace
}  // namespace wavecrest
