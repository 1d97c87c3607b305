// What scenes of the repository do not have: placements, adapters and textures of every kind read back the same.
#include <fmt/core.h>

#include <random>

#include "engine/scene/scene_error.h"
#include "metrics/image/image_io.h"
#include "tests/load/mesh_text.h"
#include "tests/save/saved_scene.h"

namespace wavecrest {
namespace {

void expectSame(const Folder& folder, const std::string& body) {
  const Scene scene = loadBody(folder, body);
  EXPECT_EQ(savedAndLoaded(scene).hash, scene.hash) << body;
}
void expectSame(const std::string& body) { expectSame(Folder(), body); }

// Rotations, scales and offsets that no file has by design; every second one mirrors.
std::string transformOf(std::mt19937& random, bool uniform, bool mirror) {
  std::uniform_real_distribution<double> number(-5, 5), size(0.1, 4);
  const double x = size(random), y = uniform ? x : size(random), z = uniform ? x : size(random);
  return fmt::format(R"(<transform name="to_world"><scale value="{}, {}, {}"/><rotate value="{}, {}, {}" angle="{}"/>)"
                     R"(<translate value="{}, {}, {}"/></transform>)",
                     mirror ? -x : x, y, z, number(random), number(random), number(random), 40 * number(random),
                     number(random), number(random), number(random));
}

TEST(RoundTrip, RectanglesAndDisksAnywhere) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const char* flip = i % 3 == 0 ? R"(<boolean name="flip_normals" value="true"/>)" : "";
    for (const char* type : {"rectangle", "disk"}) {
      expectSame(fmt::format(R"(<shape type="{}">{}{}</shape>)", type, transformOf(random, false, i % 2 == 0), flip));
    }
  }
}

TEST(RoundTrip, Beams) {
  const std::string picture =
      R"(<texture type="checkerboard" name="{}"><rgb name="color0" value="0.1, 0.7, 0.9"/></texture>)";
  const std::string place =
      R"(<transform name="to_world"><lookat origin="1, 2, 3" target="0.3, 0.1, 0" up="0, 1, 0"/></transform>)";
  expectSame(R"(<emitter type="spot">)" + place + fmt::format(fmt::runtime(picture), "texture") + "</emitter>");
  expectSame(R"(<emitter type="projector">)" + place + fmt::format(fmt::runtime(picture), "irradiance") +
             R"(<float name="scale" value="0.3"/><string name="focal_length" value="35mm"/></emitter>)");
  expectSame(R"(<emitter type="projector"><rgb name="irradiance" value="0.1, 0.2, 0.3"/></emitter>)");
}

TEST(RoundTrip, SunAndSky) {
  std::mt19937 random(6);
  for (int i = 0; i < 20; ++i) {
    const char* time = i % 2 == 0 ? R"(<float name="hour" value="9.3"/><float name="latitude" value="51.7"/>)"
                                  : R"(<vector name="sun_direction" value="0.3, 0.7, 0.1"/>)";
    expectSame(fmt::format(R"(<emitter type="sunsky">{}{}<float name="turbidity" value="2.3"/>)"
                           R"(<float name="sun_scale" value="0.7"/><float name="sun_aperture" value="1.3"/>)"
                           R"(<rgb name="albedo" value="0.1, 0.2, 0.7"/></emitter>)",
                           transformOf(random, true, false), time));
  }
}

// Their zenith is turned from y to z, which makes no zeros of another sign.
TEST(RoundTrip, SunAndSkyOfVersion06) {
  for (const char* type : {"sun", "sky", "sunsky"}) {
    const Scene scene = load(
        sceneXml(fmt::format(R"(<emitter type="{}"/>)", type) + std::string(kSensor) + std::string(kSphere), "0.6.0"));
    EXPECT_EQ(savedAndLoaded(scene).hash, scene.hash) << type;
  }
}

TEST(RoundTrip, HiddenEmitters) {
  expectSame(R"(<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>)");
}

TEST(RoundTrip, SpheresAnywhere) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    expectSame(fmt::format(R"(<shape type="sphere">{}</shape>)", transformOf(random, true, i % 2 == 0)));
  }
  expectSame(R"(<shape type="sphere"><point name="center" value="0.1, 0.7, -3.3"/><float name="radius" value="0.3"/>
    <boolean name="flip_normals" value="true"/></shape>)");
}

TEST(RoundTrip, CylindersAnywhere) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-5, 5);
  for (int i = 0; i < 50; ++i) {
    const std::string ends = fmt::format(
        R"(<point name="p0" value="{}, {}, {}"/><point name="p1" value="{}, {}, {}"/><float name="radius" value="0.3"/>)",
        number(random), number(random), number(random), number(random), number(random), number(random));
    const char* flip = i % 3 == 0 ? R"(<boolean name="flip_normals" value="true"/>)" : "";
    expectSame(fmt::format(R"(<shape type="cylinder">{}{}</shape>)", ends, flip));
    expectSame(fmt::format(R"(<shape type="cylinder">{}{}</shape>)", transformOf(random, true, i % 2 == 0), flip));
  }
}

// A tent of four triangles with normals that are its faces' in part.
constexpr std::string_view kTentObj =
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0.1 0.8 0.2\nvn 0.1 0.9 -0.3\nvn 0 1 0\nvn -0.7 0.6 0\n"
    "vt 0 0\nvt 0.3 0.1\nvt 0.7 0.9\n"
    "f 1/1/1 5/2/2 2/3/3\nf 2/1/3 5/2/2 3/3/1\nf 3/1/1 5/2/2 4/3/2\nf 4/1/1 5/2/2 1/3/1\n";

TEST(RoundTrip, MeshesWithNormalsOfEveryOrigin) {
  const Folder folder;
  folder.write("tent.obj", kTentObj);
  folder.write("quad.ply", kQuadPly);
  std::mt19937 random(4);
  for (int i = 0; i < 32; ++i) {
    const std::string placement = i < 16 ? "" : transformOf(random, i % 8 < 4, i % 2 == 0);
    const char* flip = i % 2 == 0 ? R"(<boolean name="flip_normals" value="true"/>)" : "";
    const char* facets = i % 4 < 2 ? R"(<boolean name="face_normals" value="true"/>)" : "";
    const char* kind = i % 8 < 4 ? R"(type="obj"><string name="filename" value="tent.obj"/>)"
                                 : R"(type="ply"><string name="filename" value="quad.ply"/>)";
    expectSame(folder, fmt::format("<shape {}{}{}{}</shape>", kind, placement, flip, facets));
  }
}

// The fourth texel of the triangle's cell is below 0, which a bitmap of a reflectance may not be.
TEST(RoundTrip, AMeshAttributeWithTwoScales) {
  const Folder folder;
  folder.write("mesh.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "property float r\nproperty float g\nproperty float b\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n"
               "0 0 0 1 0.9 0.3\n1 0 0 0 0.1 0.2\n0 1 0 0 0.3 0.1\n3 0 1 2\n");
  const auto attribute = [](const std::string& name, const std::string& scale) {
    return R"(<texture type="mesh_attribute" name=")" + name + R"("><string name="name" value="vertex_color"/>)" +
           R"(<float name="scale" value=")" + scale + "\"/></texture>";
  };
  expectSame(folder, R"(<shape type="ply"><string name="filename" value="mesh.ply"/><bsdf type="diffuse">)" +
                         attribute("reflectance", "0.7") + R"(</bsdf><emitter type="area">)" +
                         attribute("radiance", "12.3") + "</emitter></shape>");
}

TEST(RoundTrip, AMeshHasNormalsInItsFileOnlyIfTheyAreItsOwn) {
  const Folder folder;
  folder.write("quad.ply", kQuadPly);
  const Scene scene = loadBody(folder, R"(<shape type="ply"><string name="filename" value="quad.ply"/></shape>)");
  const Mesh& mesh = std::get<Mesh>(scene.shapes[0].kind);
  ASSERT_FALSE(mesh.normals.empty());  // made by the loader
  const Folder saved;
  saveScene(planSave(scene, saved.path() / "saved.xml"));
  std::ifstream file(saved.path() / "saved-files" / "mesh-1.ply", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(text.find("property float nx"), std::string::npos);
  EXPECT_NE(text.find("element vertex 4"), std::string::npos);
}

constexpr std::string_view kBoard =
    R"(<texture type="checkerboard" id="board"><rgb name="color0" value="0.9, 0.2, 0.1"/><rgb name="color1" value="0.3"/>
    <transform name="to_uv"><scale x="3" y="5"/><rotate z="1" angle="17"/><translate x="0.2"/></transform></texture>)";

TEST(RoundTrip, AdaptersInEveryOrder) {
  const std::string board(kBoard), use = R"(<ref id="board"/>)", opacity = R"(<ref name="opacity" id="board"/>)";
  const std::string diffuse = R"(<bsdf type="diffuse"/>)", two = R"(<bsdf type="twosided">)", end = "</bsdf>";
  const std::string bump = R"(<bsdf type="bumpmap">)" + use + R"(<float name="scale" value="0.3"/>)";
  const std::string mask = R"(<bsdf type="mask">)" + opacity;
  for (const std::string& bsdf :
       {two + diffuse + end, bump + diffuse + end, two + bump + diffuse + end + end, bump + two + diffuse + end + end,
        mask + bump + diffuse + end + end, mask + two + bump + diffuse + end + end + end,
        bump + mask + two + diffuse + end + end + end}) {
    expectSame(board + R"(<shape type="sphere">)" + bsdf + "</shape>");
  }
  expectSame(R"(<shape type="sphere"><bsdf type="mask"><float name="opacity" value="0.37"/><bsdf type="phong">
    <float name="exponent" value="12.5"/></bsdf></bsdf></shape>)");
}

// Textures are numbered as they are read: those of the outer adapter first.
TEST(RoundTrip, MapsAndMasksOfDifferentTexturesKeepTheirOrder) {
  const std::string boards = std::string(kBoard) + R"(<texture type="checkerboard" id="other"/>)";
  const std::string mask = R"(<bsdf type="mask"><ref name="opacity" id="board"/>)";
  const std::string bump = R"(<bsdf type="bumpmap"><ref id="other"/>)", diffuse = R"(<bsdf type="diffuse"/>)";
  const std::string normal = R"(<bsdf type="normalmap"><ref name="normalmap" id="other"/>)";
  for (const std::string& map : {bump, normal}) {
    expectSame(boards + R"(<shape type="sphere">)" + mask + map + diffuse + "</bsdf></bsdf></shape>");
    expectSame(boards + R"(<shape type="sphere">)" + map + mask + diffuse + "</bsdf></bsdf></shape>");
  }
}

// A coat over a textured base is plastic, whose textures are read in the same order.
TEST(RoundTrip, CoatsOfDifferentTexturesKeepTheirOrder) {
  expectSame(std::string(kBoard) + R"(<texture type="checkerboard" id="other"/><shape type="sphere">
    <bsdf type="coating"><ref name="specular_reflectance" id="board"/>
    <bsdf type="diffuse"><ref name="reflectance" id="other"/></bsdf></bsdf></shape>)");
}

// The rest is a black part of the file, which is none once it is read.
TEST(RoundTrip, AMixtureOfLessThanOneHasAsManyPartsAsBefore) {
  const Folder folder;
  std::string parts;
  for (int i = 0; i < 8; ++i) parts += R"(<bsdf type="diffuse"/>)";
  const Scene scene = loadBody(folder, R"(<shape type="sphere"><bsdf type="mixturebsdf">
    <string name="weights" value="0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1"/>)" +
                                           parts + "</bsdf></shape>");
  saveScene(planSave(scene, folder.path() / "saved.xml"));
  const Scene again = loadScene(folder.path() / "saved.xml");
  const auto& blend = std::get<Blend>(again.materials.at(again.shapes.at(0).material).kind);
  ASSERT_EQ(blend.materials.size(), 8u);
  for (const double weight : blend.weights) EXPECT_NEAR(weight, 0.1, 1e-12);
}

TEST(RoundTrip, NumbersOfACheckerboardMayBeAbove1) {
  const Scene again =
      savedAndLoaded(loadBody(R"(<texture type="checkerboard" id="t"><float name="color0" value="1.4"/></texture>
      <shape type="sphere"><bsdf type="principledthin"><ref id="t" name="diff_trans"/></bsdf></shape>)"));
  const uint32_t texture = std::get<Principled>(again.materials[0].kind).diffTrans.texture;
  EXPECT_EQ(std::get<CheckerboardTexture>(again.textures[texture].kind).color1[0], 1.4);
}

TEST(RoundTrip, RadianceOfACheckerboardMayBeAbove1) {
  expectSame(R"(<shape type="rectangle"><emitter type="area"><texture type="scale" name="radiance">
    <float name="scale" value="10"/><texture type="checkerboard"><rgb name="color0" value="1, 0.8, 0.6"/></texture>
    </texture></emitter></shape>)");
}

// Read as numbers, the colours of a checkerboard change places: without the texture that this was done to, they must be
// written the other way round.
TEST(RoundTrip, ANumberWithoutItsColoursIsTheSameNumber) {
  Scene scene = loadBody(
      std::string(kBoard) +
      R"(<shape type="sphere"><bsdf type="mask"><ref name="opacity" id="board"/><bsdf type="diffuse"/></bsdf></shape>)");
  std::optional<TexturedFloat>& opacity = scene.materials[0].opacity;
  ASSERT_EQ(opacity->texture, 1u);
  scene.textures.erase(scene.textures.begin());
  opacity->texture = 0;
  const auto board = std::get<CheckerboardTexture>(scene.textures[0].kind);
  const Scene again = savedAndLoaded(scene);
  const auto read = std::get<CheckerboardTexture>(again.textures[again.materials[0].opacity->texture].kind);
  EXPECT_EQ(read.color0, board.color0);
  EXPECT_EQ(read.color1, board.color1);
}

// Files of 0.6 do not exchange the colours, but the file that is written is of version 3.
TEST(RoundTrip, NumbersOfACheckerboardOfAnOldFileAreTheSame) {
  const Scene scene = load(sceneXml(std::string(kBoard) + R"(<shape type="sphere"><bsdf type="mask">
    <ref name="opacity" id="board"/><bsdf type="diffuse"/></bsdf></shape>)" +
                                        std::string(kSensor),
                                    "0.6.0"));
  const auto boardOf = [](const Scene& s) {
    return std::get<CheckerboardTexture>(s.textures.at(s.materials.at(0).opacity->texture).kind);
  };
  const CheckerboardTexture board = boardOf(scene), again = boardOf(savedAndLoaded(scene));
  EXPECT_NEAR(board.color0[0], 0.4, 1e-15);
  EXPECT_EQ(again.color0, board.color0);
  EXPECT_EQ(again.color1, board.color1);
}

// As numbers, colours are their means in files of 0.6; in the file that is written, which is of version 3, they would
// be their luminances.
TEST(RoundTrip, NumbersOfAColourBitmapOfAnOldFileAreTheSame) {
  const Folder folder;
  Image image{2, 2, 3, {}};
  for (int i = 0; i < 12; ++i) image.pixels.push_back(static_cast<float>((i * 5) % 12) / 11.0f);
  writeExr((folder.path() / "colours.exr").string(), image);
  const Scene scene =
      load(folder, sceneXml(R"(<texture type="bitmap" id="t"><string name="filename" value="colours.exr"/>
    </texture><shape type="sphere"><bsdf type="mask"><ref name="opacity" id="t"/><bsdf type="diffuse">
    <ref name="reflectance" id="t"/></bsdf></bsdf></shape>)" +
                                std::string(kSensor),
                            "0.6.0"));
  const auto numbersOf = [](const Scene& s) {
    return std::get<BitmapTexture>(s.textures.at(s.materials.at(0).opacity->texture).kind).bitmap->pixels;
  };
  const std::vector<float> numbers = numbersOf(scene), again = numbersOf(savedAndLoaded(scene));
  EXPECT_FLOAT_EQ(numbers.at(0), 5 / 11.0f);  // of 0, 5 and 10
  ASSERT_EQ(again.size(), numbers.size());
  for (size_t i = 0; i < numbers.size(); ++i) EXPECT_FLOAT_EQ(again[i], numbers[i]);
}

// Colours and a grey one, in 8 bits and beyond them.
TEST(RoundTrip, BitmapsAsColoursNumbersAndNormals) {
  const Folder folder;
  Image image{4, 2, 3, {}};
  for (int i = 0; i < 24; ++i) image.pixels.push_back(static_cast<float>((i * 37) % 24) / 23.0f);
  writePng((folder.path() / "codes.png").string(), image);
  writeExr((folder.path() / "floats.exr").string(), image);
  for (const char* file : {"codes.png", "floats.exr"}) {
    for (const char* raw : {"true", "false"}) {
      const std::string texture = fmt::format(
          R"(<texture type="bitmap" id="t"><string name="filename" value="{}"/><boolean name="raw" value="{}"/>
          <string name="wrap_mode" value="mirror"/><string name="filter_type" value="nearest"/></texture>)",
          file, raw);
      const std::string color = R"(<bsdf type="diffuse"><ref name="reflectance" id="t"/></bsdf>)";
      const std::string number = R"(<bsdf type="roughconductor"><ref name="alpha" id="t"/></bsdf>)";
      const std::string normal =
          R"(<bsdf type="normalmap"><ref name="normalmap" id="t"/><bsdf type="diffuse"/>
          <boolean name="flip_invalid_normals" value="false"/><boolean name="use_shadowing_function" value="false"/></bsdf>)";
      const auto sphere = [](const std::string& bsdf) { return R"(<shape type="sphere">)" + bsdf + "</shape>"; };
      expectSame(folder, texture + sphere(color));
      expectSame(folder, texture + sphere(number));
      expectSame(folder, texture + sphere(normal));
      expectSame(folder, texture + sphere(normal) + sphere(number) + sphere(color));
    }
  }
}

// Values that are codes without a curve: a texture may say that it is raw, an environment map may not.
TEST(RoundTrip, EnvironmentMapsAreNeverRaw) {
  const Folder folder;
  writeExr((folder.path() / "sky.exr").string(), {2, 1, 3, std::vector<float>(6, 51 / 255.0f)});
  const std::string file = R"(<string name="filename" value="sky.exr"/>)";
  const std::string sky = R"(<emitter type="envmap">)" + file + "</emitter>";
  expectSame(folder, sky);
  expectSame(folder, R"(<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">)" + file +
                         "</texture></bsdf></shape>" + sky);
}

TEST(RoundTrip, ABitmapIsAPngIfEightBitsSayAllOfIt) {
  const Folder folder;
  Image image{2, 1, 3, {0.0f, 0.25f, 0.5f, 0.75f, 0.9f, 1.0f}};
  writePng((folder.path() / "codes.png").string(), image);
  writeExr((folder.path() / "floats.exr").string(), image);
  const auto nameOf = [&](const std::string& file) {
    const Scene scene = loadBody(
        folder,
        R"(<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value=")" +
            file + R"("/></texture></bsdf></shape>)");
    return planSave(scene, "saved.xml").files.front().path;
  };
  EXPECT_EQ(nameOf("codes.png"), "saved-files/bitmap-1.png");
  EXPECT_EQ(nameOf("floats.exr"), "saved-files/bitmap-1.exr");
}

TEST(RoundTrip, ValuesThatColoursMayNotHave) {
  expectSame(R"(<shape type="sphere"><bsdf type="diffuse"><texture type="rawconstant" name="reflectance">
    <vector name="value" value="1.5, 0.25, 0"/></texture></bsdf></shape>)");
  expectSame(R"(<shape type="sphere"><bsdf type="diffuse"><spectrum type="uniform" name="reflectance">
    <float name="value" value="1.1"/></spectrum></bsdf></shape>)");
  expectSame(R"(<shape type="sphere"><bsdf type="conductor"><string name="material" value="Au"/></bsdf></shape>
    <shape type="sphere"><bsdf type="conductor"><rgb name="eta" value="0"/><rgb name="k" value="3.1"/></bsdf></shape>)");
}

TEST(RoundTrip, EveryLightAndSensor) {
  expectSame(
      R"(<emitter type="spot"><transform name="to_world"><lookat origin="1, 2, 3" target="0, 0.1, 0"/></transform>
    <rgb name="intensity" value="7, 0.1, 1e-7"/><float name="cutoff_angle" value="33.3"/></emitter>
    <emitter type="directional"><vector name="direction" value="0.3, -1, 0.77"/></emitter>
    <emitter type="point"><point name="position" value="0.1, 0.2, 0.3"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.1, 0.2, 0.3"/></emitter>
    <shape type="rectangle"><emitter type="area"><spectrum name="radiance" value="3"/></emitter></shape>)");
  const std::string place =
      R"(<transform name="to_world"><lookat origin="1, 2, 3" target="0, 0.1, 0"/></transform><float name="near_clip" value="0.3"/>)";
  expectSame(
      R"(<sensor type="thinlens"><float name="aperture_radius" value="0.03"/><float name="focus_distance" value="4.1"/>)" +
      place + "</sensor>");
  expectSame(R"(<sensor type="orthographic">)" + place + "</sensor>");
  expectSame(
      R"(<sensor type="perspective"><float name="principal_point_offset_x" value="0.1"/><float name="fov" value="51.7"/>
    <string name="fov_axis" value="diagonal"/><film type="hdrfilm"><integer name="crop_offset_x" value="7"/>
    <integer name="crop_width" value="11"/>
    <rfilter type="tent"><float name="radius" value="1.7"/></rfilter></film></sensor>)");
}

// Groups are read at their first instance, between shapes of the world and each other.
TEST(RoundTrip, GroupsAndInstancesInTheirOrder) {
  const Scene scene = loadBody(R"(<shape type="cube"/>
    <shape type="shapegroup" id="a"><shape type="sphere"/><shape type="cube"/></shape>
    <shape type="shapegroup" id="b"><shape type="disk"/></shape>
    <shape type="instance"><ref id="b"/><transform name="to_world"><scale x="-2" y="3"/></transform></shape>
    <shape type="instance"><ref id="b"/><transform name="to_world"><translate x="0.3"/></transform></shape>
    <shape type="rectangle"><emitter type="area"/></shape>
    <shape type="instance"><ref id="a"/><transform name="to_world"><rotate x="1" y="2" angle="11"/></transform></shape>
    <shape type="instance"><ref id="b"/></shape>)");
  const Scene again = savedAndLoaded(scene);
  EXPECT_EQ(again.hash, scene.hash);
  ASSERT_EQ(again.groups.size(), 2u);
  EXPECT_EQ(again.groups[0].id, "b");
  ASSERT_EQ(again.instances.size(), 4u);
  EXPECT_EQ(again.instances[2].group, 1u);
}

// A number of the film's filter is on the fifth level.
TEST(RoundTrip, WhatTheLoaderWouldRefuseIsNotPlanned) {
  const Scene scene = loadBody("");
  EXPECT_NO_THROW(planSave(scene, "saved.xml", {.nesting = 5}));
  EXPECT_THROW(planSave(scene, "saved.xml", {.nesting = 4}), SceneError);
  EXPECT_THROW(planSave(scene, "saved.xml", {.elements = 9}), SceneError);
  EXPECT_THROW(planSave(scene, "saved.xml", {.bytes = 99}), SceneError);
}

TEST(RoundTrip, IdsAreKeptAndMadeUnique) {
  const Folder folder;
  const Scene scene = loadBody(
      folder, R"(<bsdf type="diffuse" id="red.paint"/><shape type="sphere" id="ball"><ref id="red.paint"/></shape>)");
  saveScene(planSave(scene, folder.path() / "saved.xml"));
  const Scene again = loadScene(folder.path() / "saved.xml");
  EXPECT_EQ(again.materials[0].id, "red-paint");
  EXPECT_EQ(again.shapes[0].id, "ball");
}

}  // namespace
}  // namespace wavecrest
