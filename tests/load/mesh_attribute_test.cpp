// Colours of vertices and faces, baked into a bitmap.
#include <array>
#include <cmath>

#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// Two triangles; the first has no area, so that what faces have must follow those that stay.
constexpr std::string_view kColoredPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float color_0\nproperty float color_1\nproperty float color_2\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty float weight_0\nend_header\n"
    "0 0 0 0.1 0 0\n1 0 0 0.2 0 0\n0 1 0 0.4 1 0\n2 0 0 0.8 0 0\n3 0 1 3 0.25\n3 0 1 2 0.75\n";

std::string plyWith(std::string_view attribute, std::string_view more = "") {
  return R"(<shape type="ply"><string name="filename" value="mesh.ply"/><bsdf type="diffuse">
      <texture type="mesh_attribute" name="reflectance"><string name="name" value=")" +
         std::string(attribute) + "\"/></texture></bsdf>" + std::string(more) + "</shape>";
}
Scene loadColored(std::string_view body) {
  const Folder folder;
  folder.write("mesh.ply", kColoredPly);
  return loadBody(folder, body);
}

// Bilinear interpolation between texel centres, as kernels do it.
double lookUp(const Bitmap& bitmap, double u, double v, size_t channel) {
  const double x = u * bitmap.width - 0.5, y = v * bitmap.height - 0.5;
  const auto left = static_cast<size_t>(std::floor(x)), top = static_cast<size_t>(std::floor(y));
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const auto texel = [&](size_t i, size_t j) {
    const size_t row = std::min<size_t>(j, bitmap.height - 1), column = std::min<size_t>(i, bitmap.width - 1);
    return static_cast<double>(bitmap.pixels[(row * bitmap.width + column) * bitmap.channels + channel]);
  };
  return (1 - fy) * ((1 - fx) * texel(left, top) + fx * texel(left + 1, top)) +
         fy * ((1 - fx) * texel(left, top + 1) + fx * texel(left + 1, top + 1));
}

TEST(MeshAttribute, OfVerticesIsLinearInATriangle) {
  const Scene scene = loadColored(plyWith("vertex_color"));
  const Mesh& mesh = std::get<Mesh>(scene.shapes.at(0).kind);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  const Bitmap& bitmap = *std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap;
  const auto& uv = mesh.uvs;
  const double weights[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.3, 0.5}};
  for (const auto& w : weights) {
    const double u = w[0] * uv[0][0] + w[1] * uv[1][0] + w[2] * uv[2][0];
    const double v = w[0] * uv[0][1] + w[1] * uv[1][1] + w[2] * uv[2][1];
    EXPECT_NEAR(lookUp(bitmap, u, v, 0), w[0] * 0.1 + w[1] * 0.2 + w[2] * 0.4, 1e-6);
    EXPECT_NEAR(lookUp(bitmap, u, v, 1), w[2], 1e-6);
  }
}

TEST(MeshAttribute, OfFacesFollowsTheFacesThatStay) {
  const Scene scene = loadColored(plyWith("face_weight"));
  const Bitmap& bitmap = *std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap;
  EXPECT_EQ(bitmap.pixels, std::vector<float>(4, 0.75f));
}

TEST(MeshAttribute, MaterialOfTwoMeshesIsReadForEach) {
  const Scene scene = loadColored(R"(<bsdf type="diffuse" id="m"><texture type="mesh_attribute" name="reflectance">
      <string name="name" value="vertex_color"/></texture></bsdf>
      <shape type="ply"><string name="filename" value="mesh.ply"/><ref id="m"/></shape>
      <shape type="ply"><string name="filename" value="mesh.ply"/><ref id="m"/></shape>)");
  EXPECT_NE(scene.shapes.at(0).material, scene.shapes.at(1).material);
}

// A triangle whose vertices have three more properties of a type, with these values of vertex 0. The others have 0.75.
std::string plyOf(const std::string& type, const std::array<const char*, 3>& names, const std::string& values) {
  std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* name : names) header += "property " + type + " " + name + "\n";
  return header +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 " +
         values + "\n1 0 0 .75 .75 .75\n0 1 0 .75 .75 .75\n3 0 1 2\n";
}

TEST(MeshAttribute, ChannelsHaveMitsubasNames) {
  const struct {
    std::array<const char*, 3> properties;
    const char* attribute;
  } cases[] = {{{"heat_0", "heat_1", "heat_2"}, "vertex_heat"},
               {{"heat_1", "heat_2", "heat_3"}, "vertex_heat"},
               {{"heat_x", "heat_y", "heat_z"}, "vertex_heat"},
               {{"heat_r", "heat_g", "heat_b"}, "vertex_heat_color"},
               {{"r", "g", "b"}, "vertex_color"},
               {{"red", "green", "blue"}, "vertex_color"}};
  for (const auto& [properties, attribute] : cases) {
    const Folder folder;
    folder.write("mesh.ply", plyOf("float", properties, ".25 .5 .75"));
    const Scene scene = loadBody(folder, plyWith(attribute));
    const Bitmap& bitmap = *std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap;
    ASSERT_EQ(bitmap.channels, 3u) << properties[0];
    EXPECT_EQ(std::vector<float>(bitmap.pixels.begin(), bitmap.pixels.begin() + 3),
              (std::vector<float>{0.25f, 0.5f, 0.75f}))
        << properties[0];
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(MeshAttribute, WholeNumbersAreTakenAsTheyAreWithAWarning) {
  const Folder folder;
  folder.write("mesh.ply", plyOf("uchar", {"red", "green", "blue"}, "0 0 1"));
  const Scene scene = loadBody(folder, plyWith("vertex_color"));
  EXPECT_EQ(std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap->pixels.at(2), 1.0f);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("whole numbers"), std::string::npos);
}

// As of other textures. Texels that are extrapolated (1.5 for a vertex 0 of 0, and -3.5 for one of 5) do not count.
TEST(MeshAttribute, ReflectanceBelowZeroIsRefusedAndAboveOneIsSaid) {
  const auto warningsOf = [](const std::string& values) {
    const Folder folder;
    folder.write("mesh.ply", plyOf("float", {"color_0", "color_1", "color_2"}, values));
    return loadBody(folder, plyWith("vertex_color")).warnings;
  };
  EXPECT_TRUE(warningsOf("1 1 1").empty());
  EXPECT_TRUE(warningsOf("0 0 0").empty());
  const std::vector<std::string> warnings = warningsOf("0 5 0");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("reflectance texture has values up to 5"), std::string::npos) << warnings[0];
  const Folder folder;
  folder.write("mesh.ply", plyOf("float", {"color_0", "color_1", "color_2"}, "-5 0 0"));
  expectError(folder, sceneXml(plyWith("vertex_color") + std::string(kSensor)), 2,
              "reflectance texture has a value of -5");
}

TEST(MeshAttribute, WhatCannotBeIsRefused) {
  const Folder folder;
  folder.write("mesh.ply", kColoredPly);
  const auto expectRefusal = [&](const std::string& shape, std::string_view text) {
    expectError(folder, sceneXml(std::string(kSensor) + "\n" + shape), 2, text);
  };
  const std::string checkerboard = R"(<emitter type="area"><texture type="checkerboard" name="radiance"/></emitter>)";
  const std::string sphere =
      R"(<shape type="sphere"><bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf></shape>)";
  expectRefusal(sphere, "shape \"sphere\" has no attribute \"vertex_color\"");
  expectRefusal(
      R"(<shape type="ply"><string name="filename" value="mesh.ply"/><bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_heat"/></texture></bsdf></shape>)",
      "no attribute \"vertex_heat\"");
  expectRefusal(
      R"(<shape type="ply"><string name="filename" value="mesh.ply"/>)" + checkerboard +
          R"(<bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf></shape>)",
      "beside a mesh_attribute");
}

}  // namespace
}  // namespace wavecrest
