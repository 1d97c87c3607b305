// Sums of BSDFs: blends, mixtures, and coats over diffuse.
#include "tests/load/bsdf_scene.h"

namespace wavecrest {
namespace {

const Blend& blendOf(const Scene& scene) {
  return std::get<Blend>(scene.materials.at(scene.shapes.at(0).material).kind);
}

TEST(Bsdf, BlendsWithinEachOtherBecomeOne) {
  const Scene scene = sceneWith(R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>
      <bsdf type="diffuse"/>
      <bsdf type="mixturebsdf"><string name="weights" value="0.5, 0.25"/><bsdf type="plastic"/>
        <bsdf type="conductor"/></bsdf></bsdf>)");
  const Blend& blend = blendOf(scene);
  ASSERT_EQ(blend.weights, (std::vector<double>{0.75, 0.125, 0.0625}));
  EXPECT_TRUE(std::holds_alternative<Diffuse>(scene.materials.at(blend.materials[0]).kind));
  EXPECT_TRUE(std::holds_alternative<Plastic>(scene.materials.at(blend.materials[1]).kind));
  EXPECT_TRUE(std::holds_alternative<Conductor>(scene.materials.at(blend.materials[2]).kind));
}

TEST(Bsdf, BlendsThatNameOneBsdfTwiceOnEveryLevelAreRefused) {
  std::string body = R"(<bsdf type="diffuse" id="b0"/>)";
  for (int level = 1; level <= 40; ++level) {
    const std::string part = "<ref id=\"b" + std::to_string(level - 1) + "\"/>";
    body += "<bsdf type=\"blendbsdf\" id=\"b" + std::to_string(level) + "\">" + part + part + "</bsdf>";
  }
  expectErrorOnLine2(body + R"(<shape type="sphere"><ref id="b40"/></shape>)", "BSDFs; expected at most");
}

TEST(Bsdf, MixtureOfMoreThanOneIsScaled) {
  const Scene scene = sceneWith(R"(<bsdf type="mixturebsdf"><string name="weights" value="1.5 0.5"/>
      <bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>)");
  EXPECT_EQ(blendOf(scene).weights, (std::vector<double>{0.75, 0.25}));
  EXPECT_EQ(scene.notes.size(), 1u);
}

TEST(Bsdf, MistakesInBlendsAreErrors) {
  const std::string board = R"(<texture type="checkerboard" name="weight"/>)",
                    two = R"(<bsdf type="diffuse"/><bsdf type="plastic"/>)";
  const std::string textured = "<bsdf type=\"blendbsdf\">" + board + two + "</bsdf>";
  expectBsdfError(R"(<bsdf type="blendbsdf"><bsdf type="diffuse"/></bsdf>)", "contains 1 objects <bsdf>");
  expectBsdfError("<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/>" + textured + "</bsdf>", "a blend within another");
  expectBsdfError("<bsdf type=\"blendbsdf\">" + board + "<bsdf type=\"diffuse\"/><bsdf type=\"blendbsdf\">" + two +
                      "</bsdf></bsdf>",
                  "a blend within another");
  expectBsdfError(R"(<bsdf type="blendbsdf"><bsdf type="diffuse"/><bsdf type="bumpmap"><texture type="checkerboard"/>
                     <bsdf type="diffuse"/></bsdf></bsdf>)",
                  "within a blend");
  expectBsdfError("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1\"/>" + two + "</bsdf>",
                  "as many of both");
  expectBsdfError("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1, -1\"/>" + two + "</bsdf>",
                  "expected numbers from 0 on");
  expectBsdfError(
      "<bsdf type=\"twosided\"><bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/><bsdf "
      "type=\"dielectric\"/></bsdf></bsdf>",
      "BSDF that transmits");
}

TEST(Bsdf, CoatsOverDiffuseArePlastic) {
  const Scene scene = sceneWith(R"(<bsdf type="roughcoating"><float name="alpha" value="0.2"/>
      <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)");
  const Material& material = scene.materials.at(scene.shapes.at(0).material);
  EXPECT_EQ(std::get<Plastic>(material.kind).alpha.value, 0.2);
  EXPECT_TRUE(material.twoSided);
  EXPECT_EQ(scene.notes.size(), 1u);
  const std::string other = R"(<bsdf type="coating" id="coat"><bsdf type="conductor"/></bsdf>)";
  expectBsdfError(other, "another BSDF than diffuse");
  // Without its coat, under the coating's name and place.
  const Scene bare = loadBody("<shape type=\"sphere\">" + other + "</shape>", {.lenient = true});
  EXPECT_TRUE(std::holds_alternative<Conductor>(bare.materials.at(0).kind));
  EXPECT_EQ(bare.materials.at(0).id, "coat");
  EXPECT_EQ(bare.materials.at(0).source.line, 1);
}

}  // namespace
}  // namespace wavecrest
