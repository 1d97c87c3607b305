// Structure of scene files: includes, references, versions, unknown things. Variables: variables_test.cpp.
#include <ctime>

#include "tests/effort.h"
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

TEST(Include, ChildrenOfAnIncludedSceneTakeItsPlace) {
  const Folder folder;
  folder.write("part.xml", sceneXml(R"(<shape type="sphere"><float name="radius" value="3"/></shape>)"));
  EXPECT_EQ(onlySphere(load(folder, sceneXml(std::string(kSensor) + R"(<include filename="part.xml"/>)"))).radius, 3);
}

TEST(Include, AnyOtherRootTakesItsPlaceItself) {
  const Folder folder;
  folder.write("part.xml", R"(<shape version="3.0.0" type="sphere"><float name="radius" value="3"/></shape>)");
  EXPECT_EQ(onlySphere(load(folder, sceneXml(std::string(kSensor) + R"(<include filename="part.xml"/>)"))).radius, 3);
}

TEST(Include, SeesVariablesOfTheIncludingFile) {
  const Folder folder;
  folder.write("part.xml", sceneXml(R"(<shape type="sphere"><float name="radius" value="$r"/></shape>)"));
  const Scene scene =
      load(folder, sceneXml(std::string(kSensor) + R"(<default name="r" value="6"/><include filename="part.xml"/>)"));
  EXPECT_EQ(onlySphere(scene).radius, 6);
}

TEST(Include, PathIsRelativeToTheIncludingFile) {
  const Folder folder;
  folder.write("sub/part.xml", sceneXml(R"(<include filename="deep.xml"/>)"));
  folder.write("sub/deep.xml", sceneXml(kSphere));
  EXPECT_EQ(onlySphere(load(folder, sceneXml(std::string(kSensor) + R"(<include filename="sub/part.xml"/>)"))).radius,
            1);
}

TEST(Include, IsFoundBesideItsFileThenInTheLastPathThenBesideTheScene) {
  const Folder folder;
  const auto sphereOf = [](const char* radius) {
    return sceneXml(R"(<shape type="sphere"><float name="radius" value=")" + std::string(radius) + "\"/></shape>");
  };
  folder.write("a/part.xml", sphereOf("2"));
  folder.write("b/part.xml", sphereOf("3"));
  folder.write("sub/nested.xml", sceneXml(R"(<include filename="part.xml"/>)"));
  const auto radiusWith = [&](const std::string& paths, const std::string& file) {
    return onlySphere(load(folder, sceneXml(std::string(kSensor) + paths + R"(<include filename=")" + file + "\"/>")))
        .radius;
  };
  const std::string both = R"(<path value="a"/><path value="b"/>)";
  EXPECT_EQ(radiusWith(R"(<path value="a"/>)", "part.xml"), 2);
  EXPECT_EQ(radiusWith(both, "part.xml"), 3);
  folder.write("part.xml", sphereOf("4"));
  EXPECT_EQ(radiusWith("", "sub/nested.xml"), 4) << "beside the scene";
  EXPECT_EQ(radiusWith(both, "sub/nested.xml"), 3) << "a path is before the scene's folder";
  folder.write("sub/part.xml", sphereOf("5"));
  EXPECT_EQ(radiusWith(both, "sub/nested.xml"), 5);
}

TEST(Include, PathMustBeAFolder) {
  expectErrorOnLine2("<path/>", "<path> has no value");
  expectErrorOnLine2(R"(<path value=""/>)", "<path> has no value");
  expectErrorOnLine2(R"(<path value="typo"/>)", "typo\" not found; expected an existing folder");
}

TEST(Include, PathOfAnIncludedFileMayBeBesideTheScene) {
  const Folder folder;
  folder.write("a/part.xml", sceneXml(kSphere));
  folder.write("sub/nested.xml", sceneXml(R"(<path value="a"/><include filename="part.xml"/>)"));
  EXPECT_EQ(onlySphere(load(folder, sceneXml(std::string(kSensor) + R"(<include filename="sub/nested.xml"/>)"))).radius,
            1);
}

TEST(Include, ErrorsNameTheIncludedFile) {
  const Folder folder;
  folder.write("part.xml", sceneXml("\n\n<shape type=\"sphere\"><float name=\"radius\" value=\"x\"/></shape>"));
  expectError(folder, sceneXml(std::string(kSensor) + R"(<include filename="part.xml"/>)"), 3, "bad number \"x\"",
              "part.xml");
}

TEST(Include, CycleIsAnError) {
  const Folder folder;
  folder.write("a.xml", sceneXml("\n<include filename=\"b.xml\"/>"));
  folder.write("b.xml", sceneXml("\n\n<include filename=\"./a.xml\"/>"));
  expectError(folder, sceneXml(R"(<include filename="a.xml"/>)"), 3, "includes itself", "b.xml");
}

TEST(Include, DepthIsLimited) {
  const Folder folder;
  for (int i = 0; i < 20; ++i) {
    folder.write("f" + std::to_string(i) + ".xml",
                 sceneXml("<include filename=\"f" + std::to_string(i + 1) + ".xml\"/>"));
  }
  expectError(folder, sceneXml(R"(<include filename="f0.xml"/>)"), 1, "includes nest deeper than 15", "f13.xml");
}

TEST(Include, MissingFileIsReportedWhereItIsIncluded) {
  expectErrorOnLine2(R"(<include filename="nowhere.xml"/>)", "not found");
}

TEST(Reference, MaterialIsReadOnceHoweverOftenItIsReferenced) {
  const Scene scene = loadBody(R"(<bsdf type="diffuse" id="m"/><shape type="sphere"><ref id="m"/></shape>
    <shape type="cube"><ref id="m"/></shape>)");
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
}

TEST(Reference, MayPrecedeTheDefinition) {
  const Scene scene = loadBody(R"(<shape type="sphere"><ref id="m"/></shape><bsdf type="conductor" id="m"/>)");
  EXPECT_TRUE(std::holds_alternative<Conductor>(scene.materials.at(0).kind));
}

TEST(Reference, NestedIdCanBeReferenced) {
  const Scene scene = loadBody(R"(<bsdf type="twosided"><bsdf type="conductor" id="inner"/></bsdf>
    <shape type="sphere"><ref id="inner"/></shape>)");
  EXPECT_TRUE(std::holds_alternative<Conductor>(scene.materials.at(0).kind));
  EXPECT_FALSE(scene.materials.at(0).twoSided);
}

TEST(Reference, AliasIsASecondId) {
  const Scene scene = loadBody(R"(<bsdf type="conductor" id="m"/><alias id="m" as="n"/>
    <shape type="sphere"><ref id="n"/></shape>)");
  EXPECT_TRUE(std::holds_alternative<Conductor>(scene.materials.at(0).kind));
}

TEST(Reference, UnknownIdIsAnError) {
  expectErrorOnLine2(R"(<shape type="sphere"><ref id="m"/></shape>)", "no object has the id \"m\"");
}

TEST(Reference, DuplicateIdIsAnError) {
  expectErrorOnLine2(R"(<bsdf type="diffuse" id="m"/><bsdf type="diffuse" id="m"/>)", "already used at");
}

TEST(Reference, CycleIsAnError) {
  expectErrorOnLine2(R"(<bsdf type="twosided" id="m"><bsdf type="twosided"><ref id="m"/></bsdf></bsdf>)",
                     "contains itself");
}

TEST(Structure, UnusedDefinitionIsCheckedButLeavesNothingBehind) {
  EXPECT_EQ(loadBody(R"(<bsdf type="conductor" id="m"/>)").materials.size(), 1u);  // that of the sphere
  expectErrorOnLine2(R"(<bsdf type="diffuse" id="m"><float name="albedo" value="1"/></bsdf>)",
                     "unknown parameter \"albedo\" of bsdf \"diffuse\"; expected reflectance");
}

// The second definition's textures get the indices of the first one's. A scalar version of the first one's bitmap would
// stand where the second has a checkerboard, in which bumps are flat.
TEST(Structure, UnusedDefinitionsDoNotShareScalarTextures) {
  std::string picture = "PF\n2 1\n-1.0\n";
  for (const float value : {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}) appendValue<float>(picture, value, false);
  const Folder folder;
  folder.write("bumps.pfm", picture);
  const std::string bitmap =
      R"(<string name="filename" value="bumps.pfm"/><boolean name="raw" value="true"/></texture>)";
  const Scene scene = loadBody(folder, R"(<bsdf type="bumpmap" id="first"><texture type="bitmap">)" + bitmap +
                                           R"(<bsdf type="diffuse"/></bsdf>
    <bsdf type="mask" id="second"><texture type="bitmap" name="opacity" id="bumps">)" +
                                           bitmap + R"(<bsdf type="coating">
      <texture type="checkerboard" name="specular_reflectance"/>
      <bsdf type="bumpmap"><ref id="bumps"/><bsdf type="diffuse"/></bsdf></bsdf></bsdf>)");
  EXPECT_TRUE(scene.textures.empty());
  for (const Note& note : scene.notes) EXPECT_EQ(note.what.find("bumpmap of a checkerboard"), std::string::npos);
}

TEST(Structure, MalformedXmlNamesItsLine) {
  expectError("<scene version=\"3.0.0\">\n\n<shape type=\"sphere\"</scene>", 3, "malformed XML");
}

TEST(Structure, EmptyFileIsAnError) { expectError("", 1, "malformed XML"); }

TEST(Structure, MissingSceneFileIsAnError) {
  const Folder folder;
  EXPECT_THROW(loadScene(folder.path() / "none.xml"), LoadError);
}

TEST(Structure, DirectoryInsteadOfFileIsAnError) {
  const Folder folder;
  EXPECT_THROW(loadScene(folder.path()), LoadError);
}

TEST(Structure, RootMustBeAScene) {
  expectError("\n<shape version=\"3.0.0\" type=\"sphere\"/>", 2, "root element is <shape>");
}

TEST(Structure, VersionIsRequired) { expectError("<scene></scene>", 1, "has no version"); }

TEST(Structure, VersionMustBeKnown) {
  for (const char* version : {"4.0.0", "0.3.0", "0.3", "0.1.2", "0"}) {
    expectError(sceneXml("", version), 1,
                "version \"" + std::string(version) + "\" is not supported; expected 0.4.0 to 3.x");
  }
  for (const char* version : {"0.4.0", "0.10.0", "2.0.0", "3"}) {
    EXPECT_EQ(load(sceneXml(std::string(kSensor) + std::string(kSphere), version)).shapes.size(), 1u) << version;
  }
}

TEST(Structure, SceneWithoutSensorIsAnError) { expectError("\n" + sceneXml(kSphere), 2, "no sensor"); }

TEST(Structure, EmptySceneIsAnError) { expectError(sceneXml(kSensor), 1, "scene is empty"); }

TEST(Structure, UnknownElementIsAnError) { expectErrorOnLine2("<bdsf type=\"diffuse\"/>", "unknown element <bdsf>"); }

TEST(Structure, ElementsOfMitsuba06ThatAreNotSupportedSayWhatTheyAre) {
  expectErrorOnLine2(
      R"(<shape type="sphere"><subsurface type="dipole"/></shape>)",
      "<subsurface> in shape \"sphere\": subsurface scattering is not supported; expected surfaces only");
  expectErrorOnLine2(R"(<shape type="sphere"><animation name="toWorld"/></shape>)",
                     "<animation> in shape \"sphere\": motion is not supported; expected a <transform>");
}

TEST(Structure, UnknownElementIsAWarningWithLenient) {
  const Scene scene = loadBody("\n<bdsf type=\"diffuse\"/>", {.lenient = true});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("scene.xml:2: unknown element <bdsf>"), std::string::npos);
}

TEST(Structure, UnknownElementOfAMeshIsOneWarningWithLenient) {
  const Folder folder;
  folder.write("mesh.ply", kQuadPly);
  const Scene scene =
      load(folder,
           sceneXml(R"(<shape type="ply"><string name="filename" value="mesh.ply"/><bdsf type="diffuse"/></shape>)"
                    R"(<shape type="ply"><string name="filename" value="mesh.ply"/></shape>)" +
                    std::string(kSensor)),
           {.lenient = true});
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(Structure, WarningsOfManyLinesAreAllListedInTheirOrder) {
  constexpr int kShapes = 100'000;
  std::string body;
  for (int i = 0; i < kShapes; ++i) body += "\n<shape type=\"x\"/>";
  const Scene scene = loadBody(body + "\n" + std::string(kSphere), {.lenient = true});
  ASSERT_EQ(scene.warnings.size(), size_t{kShapes});
  EXPECT_NE(scene.warnings.front().find("scene.xml:2: "), std::string::npos);
  EXPECT_NE(scene.warnings.back().find("scene.xml:" + std::to_string(kShapes + 1) + ": "), std::string::npos);
}

TEST(Structure, UnknownPluginIsAnErrorThatListsTheKnownOnes) {
  expectErrorOnLine2(R"(<shape type="heightfield"/>)",
                     "shape \"heightfield\" is not supported; expected one of rectangle, cube, sphere");
}

TEST(Structure, UnknownShapeIsLeftOutWithLenient) {
  const Scene scene = loadBody(R"(<shape type="heightfield"/><shape type="sphere"/>)", {.lenient = true});
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(Structure, UnknownBsdfBecomesDiffuseWithLenient) {
  const Scene scene = loadBody(R"(<shape type="sphere"><bsdf type="hk"/></shape>)", {.lenient = true});
  EXPECT_TRUE(std::holds_alternative<Diffuse>(scene.materials.at(0).kind));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(Structure, UnknownAttributeIsAnError) {
  expectErrorOnLine2(R"(<shape type="sphere" colour="red"/>)", "unexpected attribute \"colour\"");
}

TEST(Structure, ParameterGivenTwiceIsAnError) {
  expectErrorOnLine2(R"(<shape type="sphere"><float name="radius" value="1"/><float name="radius" value="2"/></shape>)",
                     "given twice");
}

TEST(Structure, ParameterOfTheWrongTypeIsAnError) {
  expectErrorOnLine2(R"(<shape type="sphere"><string name="radius" value="1"/></shape>)",
                     "\"radius\" is a <string>; expected <float>");
}

TEST(Structure, DeepNestingIsAnError) {
  std::string open, close;
  for (int i = 0; i < 100; ++i) {
    open += "<bsdf type=\"twosided\">";
    close += "</bsdf>";
  }
  expectErrorOnLine2(open + close, "elements nest deeper than 64");
}

TEST(Structure, LongChainOfReferencesIsAnError) {
  std::string body = "<bsdf type=\"diffuse\" id=\"m0\"/>";
  constexpr size_t kLinks = effort(100'000, 30'000);  // more than a stack of 8 MiB has room for
  for (size_t i = 1; i < kLinks; ++i) {
    body += "<bsdf type=\"mask\" id=\"m" + std::to_string(i) + "\"><ref id=\"m" + std::to_string(i - 1) + "\"/></bsdf>";
  }
  expectErrorOnLine2(body + "<shape type=\"sphere\"><ref id=\"m" + std::to_string(kLinks - 1) + "\"/></shape>",
                     "references nest deeper than 64");
}

TEST(Structure, TooManyAttributesAreAnError) {
  std::string attributes;
  for (int i = 0; i < 100; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  expectErrorOnLine2("<shape" + attributes + "/>", "more than 16 attributes");
}

TEST(Structure, ManyChildrenAreReadInLinearTime) {
  std::string body(kSensor);
  for (size_t i = 0; i < effort(200'000, 20'000); ++i) body += "<texture type=\"checkerboard\"/>\n";
  const std::clock_t start = std::clock();  // of this process: a busy machine is nobody's quadratic step
  load(sceneXml(body + std::string(kSphere)));
  // About half a second; a quadratic step anywhere would take minutes.
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kFullSpeed ? 20 : 5);
}

TEST(Structure, LineNumbersCountEveryKindOfLine) {
  expectError(
      "<?xml version=\"1.0\"?>\r\n<!-- a\ncomment -->\r\n<scene\nversion=\"3.0.0\"><sensor "
      "type=\"perspective\"/>\n<shape\n "
      "type=\"nope\"/></scene>",
      6, "shape \"nope\"");
}

// Letters of these files have more bytes in UTF-8, in which pugixml counts, or fewer.
TEST(Structure, LineNumbersOfFilesThatAreNotInUtf8) {
  std::u16string wide = u"\ufeff<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n";
  for (int line = 2; line < 9; ++line) wide += u"<!-- \u00e4\u20ac\U0001d11e -->\n";
  wide += u"<shape type=\"sphere\"><float name=\"wobble\" value=\"1\"/></shape></scene>";
  for (const bool bigEndian : {false, true}) {
    std::string bytes;
    for (const char16_t unit : wide) appendValue<uint16_t>(bytes, unit, bigEndian);
    expectError(bytes, 9, "unknown parameter \"wobble\"");
  }
  std::string latin = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<scene version=\"3.0.0\">\n";
  for (int line = 3; line < 9; ++line) latin += "<!-- " + std::string(40, '\xe4') + " -->\n";
  latin += "<shape type=\"sphere\"><float name=\"wobble\" value=\"1\"/>" + std::string(300, '\n') + "</shape>" +
           std::string(kSensor) + "</scene>";
  expectError(latin, 9, "unknown parameter \"wobble\"");
}

TEST(Numbers, PlusSignAndSpacesAreAccepted) {
  const Scene scene = loadBody(R"(<shape type="sphere"><float name="radius" value=" +2.5e0 "/></shape>)");
  EXPECT_EQ(onlySphere(scene).radius, 2.5);
}

TEST(Numbers, BadOnesAreErrors) {
  for (const char* text : {"", "abc", "1.5x", "1,5", "--1", "0x10"}) {
    expectErrorOnLine2("<shape type=\"sphere\"><float name=\"radius\" value=\"" + std::string(text) + "\"/></shape>",
                       "bad number");
  }
}

TEST(Numbers, HugeAndNonFiniteOnesAreErrors) {
  const auto sphere = [](const char* text) {
    return "<shape type=\"sphere\"><float name=\"radius\" value=\"" + std::string(text) + "\"/></shape>";
  };
  expectErrorOnLine2(sphere("1e999"), "out of range");
  expectErrorOnLine2(sphere("inf"), "not finite");
  expectErrorOnLine2(sphere("nan"), "not finite");
}

TEST(Upgrade, CamelCaseNamesBecomeSnakeCase) {
  const Scene scene = load(sceneXml(R"(<sensor type="perspective"><float name="nearClip" value="0.5"/></sensor>
    <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.7"/></bsdf></shape>)",
                                    "0.6.0"));
  EXPECT_EQ(scene.sensor.nearClip, 0.5);
  EXPECT_EQ(std::get<Dielectric>(scene.materials.at(0).kind).intIor, 1.7);
}

TEST(Upgrade, DoesNotTouchCurrentFiles) {
  expectErrorOnLine2(
      R"(<shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.7"/></bsdf></shape>)",
      "unknown parameter \"intIOR\"");
}

TEST(Upgrade, ReflectancesOfMattSurfacesHaveTheirLongName) {
  for (const std::string type : {"diffuse", "roughdiffuse"}) {
    const Scene scene =
        load(sceneXml("<shape type=\"sphere\"><bsdf type=\"" + type +
                          R"("><float name="alpha" value="0"/><rgb name="diffuseReflectance" value="0.2"/>
                                          </bsdf></shape>)" +
                          std::string(kSensor),
                      "0.6.0"));
    EXPECT_EQ(std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value, (Rgb{0.2, 0.2, 0.2})) << type;
  }
}

TEST(Upgrade, LookAtAndTextureScalesAreUnderstood) {
  const Scene scene = load(sceneXml(R"(
    <sensor type="perspective"><transform name="toWorld"><lookAt origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></sensor>
    <shape type="sphere"><bsdf type="diffuse"><texture name="reflectance" type="checkerboard">
      <float name="uscale" value="2"/><float name="uoffset" value="0.5"/><float name="uvscale" value="3"/>
      <float name="voffset" value="0.25"/></texture></bsdf></shape>)",
                                    "0.6.0"));
  EXPECT_EQ(scene.sensor.toWorld[2][3], 5);
  const Matrix4& toUv = scene.textures.at(0).toUv;
  EXPECT_EQ(toUv[0][0], 2);
  EXPECT_EQ(toUv[0][3], 0.5) << "the offset is not scaled";
  EXPECT_EQ(toUv[1][1], 3) << "the scale of both axes, unless one has its own";
  EXPECT_EQ(toUv[1][3], 0.25);
}

}  // namespace
}  // namespace wavecrest
