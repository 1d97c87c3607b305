// Variables of scene files: their defaults, definitions from outside, and where their names are replaced.
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

TEST(Variables, DefaultReplacesDollarName) {
  const Scene scene =
      loadBody(R"(<default name="r" value="2.5"/><shape type="sphere"><float name="radius" value="$r"/></shape>)");
  EXPECT_EQ(onlySphere(scene).radius, 2.5);
}

TEST(Variables, DefinitionFromOutsideWinsOverDefault) {
  const Scene scene =
      loadBody(R"(<default name="r" value="2.5"/><shape type="sphere"><float name="radius" value="$r"/></shape>)",
               {.defines = {{"r", "7"}}});
  EXPECT_EQ(onlySphere(scene).radius, 7);
}

TEST(Variables, FirstDefaultWins) {
  const Scene scene = loadBody(R"(<default name="r" value="2"/><default name="r" value="3"/>
    <shape type="sphere"><float name="radius" value="$r"/></shape>)");
  EXPECT_EQ(onlySphere(scene).radius, 2);
}

TEST(Variables, LongestNameMatches) {
  const Scene scene = loadBody(R"(<default name="r" value="2"/><default name="rr" value="3"/>
    <shape type="sphere"><float name="radius" value="$rr"/></shape>)");
  EXPECT_EQ(onlySphere(scene).radius, 3);
}

TEST(Variables, ReplacedInsideLongerText) {
  const Scene scene = loadBody(R"(<default name="d" value="4"/>
    <shape type="sphere"><float name="radius" value="1$d.5"/></shape>)");
  EXPECT_EQ(onlySphere(scene).radius, 14.5);
}

TEST(Variables, EscapedDollarIsLiteral) {
  const Scene scene = loadBody(R"(<bsdf type="diffuse" id="a\$b"/><shape type="sphere"><ref id="a\$b"/></shape>)");
  EXPECT_EQ(scene.materials.at(0).id, "a$b");
}

TEST(Variables, UndefinedNamesItsLine) {
  expectErrorOnLine2(R"(<float name="x" value="$nope"/>)", "undefined variable $nope");
}

TEST(Variables, DefinitionThatNothingUsesIsAnError) {
  expectError(Folder(), sceneXml(std::string(kSensor) + std::string(kSphere)), 0, "does not use -D size", "scene.xml",
              {.defines = {{"size", "7"}}});
}

TEST(Variables, DefinitionThatNothingUsesIsAWarningWithLenient) {
  const Scene scene = loadBody("", {.defines = {{"size", "7"}}, .lenient = true});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("-D size"), std::string::npos);
}

TEST(Variables, DefinitionThatNothingUsesGoesToTheCallerWhoAsksForIt) {
  std::vector<std::string> names;
  const Scene scene = loadBody(R"(<shape type="sphere"><float name="radius" value="$r"/></shape>)",
                               {.defines = {{"a", "1"}, {"r", "2"}, {"size", "7"}},
                                .unusedDefine = [&](const std::string& name) { names.push_back(name); }});
  EXPECT_EQ(onlySphere(scene).radius, 2);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "size"}));
}

TEST(Variables, DoublingChainIsStopped) {
  std::string body = R"(<default name="v0" value="xxxxxxxxxxxxxxxx"/>)";
  for (int i = 1; i < 40; ++i) {
    body += "<default name=\"v" + std::to_string(i) + "\" value=\"$v" + std::to_string(i - 1) + "$v" +
            std::to_string(i - 1) + "\"/>";
  }
  expectErrorOnLine2(body, "more than 16 MiB of text");
}

}  // namespace
}  // namespace wavecrest
