// Mitsuba's serialized meshes.
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

std::string serializedShape(std::string_view options = "", std::string_view version = "3.0.0") {
  return sceneXml(R"(<shape type="serialized"><string name="filename" value="mesh.serialized"/>)" +
                      std::string(options) + "</shape>" + std::string(kSensor),
                  version);
}
std::string shapeIndex(int index) { return R"(<integer name="shape_index" value=")" + std::to_string(index) + "\"/>"; }
Mesh serializedMesh(const std::string& content, std::string_view options = "", std::string_view version = "3.0.0") {
  const Folder folder;
  folder.write("mesh.serialized", content);
  return std::get<Mesh>(load(folder, serializedShape(options, version)).shapes.at(0).kind);
}
void expectSerializedError(const std::string& content, std::string_view text, std::string_view options = "") {
  const Folder folder;
  folder.write("mesh.serialized", content);
  expectError(folder, serializedShape(options), 0, text, "mesh.serialized");
}

void expectSerializedQuad(const Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Float3>(4, {0, 0, 1})));
  EXPECT_EQ(mesh.uvs, (std::vector<Float2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Serialized, BothVersionsAndPrecisions) {
  for (const uint16_t version : {uint16_t{3}, uint16_t{4}}) {
    for (const bool isDouble : {false, true}) {
      SCOPED_TRACE(std::to_string(version) + (isDouble ? " double" : " float"));
      expectSerializedQuad(serializedMesh(serializedQuad({.version = version, .isDouble = isDouble})));
    }
  }
}

TEST(Serialized, ColorsAreSkipped) { expectSerializedQuad(serializedMesh(serializedQuad({.colors = true}))); }

TEST(Serialized, NormalsThatAreMissingAreMade) {
  expectSerializedQuad(serializedMesh(serializedQuad({.normals = false})));
}

// Mitsuba 0.6 reads the flag of the file too, and overwrites it with the parameter.
TEST(Serialized, FacetsByParameterAndNotByFlag) {
  const std::string facets = R"(<boolean name="face_normals" value="true"/>)";
  const Folder folder;
  folder.write("mesh.serialized", serializedQuad({.faceNormals = true}));
  for (const char* version : {"3.0.0", "0.6.0"}) {
    EXPECT_TRUE(serializedMesh(serializedQuad(), facets, version).normals.empty()) << version;
    const Scene scene = load(folder, serializedShape("", version));
    EXPECT_FALSE(std::get<Mesh>(scene.shapes.at(0).kind).normals.empty()) << version;
    ASSERT_EQ(scene.notes.size(), 1u) << version;
    EXPECT_EQ(scene.notes[0].what, "face normals that a serialized mesh asks for");
  }
}

// Mitsuba 0.6 turns triangles back that to_world mirrors. Normals of the file decide in every version.
TEST(Serialized, FacesKeepTheirFrontInAMirrorInOldFiles) {
  const std::string mirror = R"(<transform name="to_world"><scale x="-1"/></transform>)";
  const auto normalIn = [&](bool ofFile, std::string_view version) {
    return serializedMesh(serializedQuad({.normals = ofFile}), mirror, version).normals.at(0)[2];
  };
  EXPECT_EQ(normalIn(false, "0.6.0"), 1);
  EXPECT_EQ(normalIn(false, "3.0.0"), -1);
  EXPECT_EQ(normalIn(true, "0.6.0"), 1);
  EXPECT_EQ(normalIn(true, "3.0.0"), 1);
}

TEST(Serialized, ShapeIndexPicksTheMesh) {
  for (const uint16_t version : {uint16_t{3}, uint16_t{4}}) {
    std::vector<std::string> meshes;
    for (const float size : {1.0f, 2.0f, 3.0f}) meshes.push_back(serializedQuad({.version = version, .size = size}));
    const std::string file = serializedFile(meshes, version);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(serializedMesh(file, shapeIndex(i)).positions[1][0], static_cast<float>(i + 1));
    }
    expectSerializedError(file, "no mesh 3 in the file; expected a shape_index below 3", shapeIndex(3));
  }
}

TEST(Serialized, DamageIsFound) {
  const std::string file = serializedFile({serializedQuad()});
  expectSerializedError("ply\n", "no mesh at byte 0");
  expectSerializedError(file.substr(0, 40), "damaged or truncated mesh data");
  std::string other = file;
  other[2] = 5;
  expectSerializedError(other, "serialized mesh of version 5");
  other = file;
  other[20] = static_cast<char>(~other[20]);
  expectSerializedError(other, "damaged or truncated mesh data");
}

TEST(Serialized, MoreThanTheBytesCanHoldIsRefused) {
  std::string body;
  appendValue<uint32_t>(body, 0x1000, false);
  body += '\0';
  appendValue<uint64_t>(body, uint64_t{1} << 40, false);
  appendValue<uint64_t>(body, 1, false);
  expectSerializedError(serializedMeshOf(body), "mesh announces 1099511627776");
}

TEST(Serialized, UnpacksToAHundredTimesItsSizeAtMost) {
  std::string body;
  appendValue<uint32_t>(body, 0x1000, false);
  body += '\0';
  const uint64_t count = 1'000'000;  // zeros, which shrink a thousandfold
  appendValue<uint64_t>(body, count, false);
  appendValue<uint64_t>(body, count, false);
  body += std::string(count * 24, '\0');
  expectSerializedError(serializedMeshOf(body), "mesh announces 1000000 vertices and 1000000 triangles");
}

TEST(Serialized, NamesWithoutEndAreRefused) {
  std::string body;
  appendValue<uint32_t>(body, 0x1000, false);
  body += std::string(size_t{1} << 20, 'a');
  expectSerializedError(serializedMeshOf(body), "name of a mesh has no end");
}

}  // namespace
}  // namespace wavecrest
