// PLY files: every encoding gives the same mesh; every damage gives an error with its line.
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

const std::string kShape =
    "<shape type=\"ply\"><string name=\"filename\" value=\"mesh.ply\"/></shape>" + std::string(kSensor);

Scene loadPly(std::string_view content, const std::string& shape = kShape) {
  const Folder folder;
  folder.write("mesh.ply", content);
  return load(folder, sceneXml(shape));
}
Mesh meshOfPly(std::string_view content, const std::string& shape = kShape) {
  return std::get<Mesh>(loadPly(content, shape).shapes.at(0).kind);
}
void expectPlyError(std::string_view content, int line, std::string_view text) {
  const Folder folder;
  folder.write("mesh.ply", content);
  expectError(folder, sceneXml(kShape), line, text, "mesh.ply");
}

void expectQuad(const Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
}

std::string vertexLine(int index, std::string_view line) {
  return withLine(kQuadPly, kQuadPlyVertexLine + index, line);
}

TEST(Ply, Ascii) { expectQuad(meshOfPly(kQuadPly)); }

TEST(Ply, AsciiWithWindowsLineEnds) {
  std::string text(kQuadPly);
  for (size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.replace(i, 1, "\r\n");
  expectQuad(meshOfPly(text));
}

TEST(Ply, AsciiWithoutFinalNewline) { expectQuad(meshOfPly(kQuadPly.substr(0, kQuadPly.size() - 1))); }

TEST(Ply, BinaryLittleEndian) { expectQuad(meshOfPly(binaryQuadPly(false))); }

TEST(Ply, BinaryBigEndian) { expectQuad(meshOfPly(binaryQuadPly(true))); }

// A zigzag of triangles in binary, more than a thread reads at once. corner(face, k): the k-th index of a face.
constexpr uint32_t kStripFaces = 40000;
template <class Corner>
std::string binaryStrip(uint32_t polygonAt, const Corner& corner) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kStripFaces + 2) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(kStripFaces) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (uint32_t i = 0; i < kStripFaces + 2; ++i) {
    for (const float x : {static_cast<float>(i), static_cast<float>(i % 2), 0.0f}) appendValue<float>(bytes, x, false);
  }
  for (uint32_t face = 0; face < kStripFaces; ++face) {
    const uint32_t count = face == polygonAt ? 4 : 3;
    appendValue<uint8_t>(bytes, static_cast<uint8_t>(count), false);
    for (uint32_t k = 0; k < count; ++k) appendValue<int32_t>(bytes, static_cast<int32_t>(corner(face, k)), false);
  }
  return bytes;
}
constexpr uint32_t kNoPolygon = kStripFaces;
uint32_t cornerOfStrip(uint32_t face, uint32_t k) { return face + k; }

TEST(Ply, ManyTriangles) {
  const Mesh mesh = meshOfPly(binaryStrip(kNoPolygon, cornerOfStrip));
  ASSERT_EQ(mesh.triangles.size(), kStripFaces);
  for (uint32_t i = 0; i < kStripFaces; ++i) {
    ASSERT_EQ(mesh.triangles[i], (std::array<uint32_t, 3>{i, i + 1, i + 2}));
  }
}

TEST(Ply, APolygonAmongManyTriangles) {
  // The last face but one is a polygon of four, which makes two triangles.
  const Mesh mesh = meshOfPly(binaryStrip(kStripFaces - 2, cornerOfStrip));
  ASSERT_EQ(mesh.triangles.size(), kStripFaces + 1);
  EXPECT_EQ(mesh.triangles[kStripFaces - 2], (std::array<uint32_t, 3>{kStripFaces - 2, kStripFaces - 1, kStripFaces}));
  EXPECT_EQ(mesh.triangles[kStripFaces - 1], (std::array<uint32_t, 3>{kStripFaces - 2, kStripFaces, kStripFaces + 1}));
  EXPECT_EQ(mesh.triangles.back(), (std::array<uint32_t, 3>{kStripFaces - 1, kStripFaces, kStripFaces + 1}));
}

TEST(Ply, AMissingVertexAmongManyTriangles) {
  constexpr int kBodyLine = 10;
  const auto missing = [](uint32_t face, uint32_t k) {
    return face == 30000 && k == 1 ? kStripFaces + 2 : cornerOfStrip(face, k);
  };
  expectPlyError(binaryStrip(kNoPolygon, missing), kBodyLine, "face refers to vertex 40002; expected 0 to 40001");
  const auto negative = [](uint32_t face, uint32_t k) {
    return face == 39999 && k == 2 ? ~0u : cornerOfStrip(face, k);
  };
  expectPlyError(binaryStrip(kNoPolygon, negative), kBodyLine, "face refers to vertex -1; expected 0 to 40001");
  const std::string whole = binaryStrip(kNoPolygon, cornerOfStrip);
  expectPlyError(whole.substr(0, whole.size() - 1), kBodyLine, "list has 3 items but the file ends");
}

TEST(Ply, GzippedByContentWhateverTheName) { expectQuad(meshOfPly(gzip(kQuadPly))); }

TEST(Ply, GzipOfSeveralMembers) { expectQuad(meshOfPly(gzip(kQuadPly.substr(0, 100)) + gzip(kQuadPly.substr(100)))); }

TEST(Ply, PolygonBecomesAFan) {
  const std::string text = withLine(withLine(kQuadPly, 8, "element face 1"), kQuadPlyVertexLine + 4, "4 0 1 3 2");
  EXPECT_EQ(meshOfPly(text.substr(0, text.rfind("3 1 3 2"))).triangles,
            (std::vector<std::array<uint32_t, 3>>{{0, 1, 3}, {0, 3, 2}}));
}

TEST(Ply, TextureCoordinatesAndNormalsAreRead) {
  const Mesh mesh = meshOfPly(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 1\nproperty list "
      "uchar int vertex_index\nend_header\n0 0 0 0 0 2 .25 .5\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n");
  EXPECT_EQ(mesh.normals[0], (Float3{0, 0, 1}));
  EXPECT_EQ(mesh.uvs[0], (Float2{0.25f, 0.5f}));
}

// A triangle whose vertices have more properties, with their values for vertex 0.
Mesh meshWithProperties(const std::vector<std::string>& names, const std::string& values) {
  std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  std::string zeros;
  for (const std::string& name : names) {
    header += "property float " + name + "\n";
    zeros += " 0";
  }
  return meshOfPly(header + "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0 " + values +
                   "\n1 0 0" + zeros + "\n0 1 0" + zeros + "\n3 0 1 2\n");
}

TEST(Ply, TextureCoordinatesAreTheFirstPairThatIsComplete) {
  const Float2 first{0.125f, 0.25f}, second{0.5f, 0.75f};
  EXPECT_EQ(meshWithProperties({"u", "v", "s", "t"}, ".125 .25 .5 .75").uvs.at(0), first);
  EXPECT_EQ(meshWithProperties({"s", "u", "t", "v"}, ".5 .125 .75 .25").uvs.at(0), first);
  EXPECT_EQ(meshWithProperties({"s", "t", "texture_u", "texture_v"}, ".5 .75 .125 .25").uvs.at(0), first);
  EXPECT_EQ(meshWithProperties({"s", "t", "u"}, ".5 .75 .125").uvs.at(0), second);
  EXPECT_EQ(meshWithProperties({"texture_s", "texture_t"}, ".5 .75").uvs.at(0), second);
  EXPECT_TRUE(meshWithProperties({"u", "t"}, ".5 .75").uvs.empty());
}

TEST(Ply, PropertiesThatNothingNeedsMayBeAnything) {
  const Mesh mesh = meshWithProperties({"quality", "confidence", "u"}, "nan 1e99 -inf");
  EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, FlipTexCoords) {
  const Mesh mesh = meshOfPly(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "u\nproperty float v\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0 .25 .25\n1 0 0 0 "
      "0\n0 1 0 0 0\n3 0 1 2\n",
      R"(<shape type="ply"><string name="filename" value="mesh.ply"/><boolean name="flip_tex_coords" value="true"/></shape>)" +
          std::string(kSensor));
  EXPECT_EQ(mesh.uvs[0], (Float2{0.25f, 0.75f}));
}

TEST(Ply, OtherElementsAndPropertiesAreSkipped) {
  expectQuad(meshOfPly(
      "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar float pose\nproperty float f\nelement vertex 4\n"
      "property float confidence\nproperty float x\nproperty float y\nproperty list uchar int near\nproperty float z\n"
      "element face 2\nproperty uchar flag\nproperty list uchar int vertex_indices\nproperty list uchar float w\n"
      "end_header\n2 .5 .5 1\n9 0 0 0 0\n9 1 0 1 5 0\n9 0 1 2 5 5 0\n9 1 1 0 0\n1 3 0 1 2 0\n1 3 1 3 2 2 .5 .5\n"));
}

TEST(Ply, MissingFileIsReportedWhereItIsNamed) {
  expectErrorOnLine2(R"(<shape type="ply"><string name="filename" value="none.ply"/></shape>)", "none.ply\" not found");
  expectErrorOnLine2(R"(<shape type="ply"/>)", "has no \"filename\"");
}

TEST(Ply, HeaderErrorsNameTheirLine) {
  expectPlyError("obj\n", 1, "not a PLY file");
  expectPlyError("", 1, "not a PLY file");
  expectPlyError(withLine(kQuadPly, 2, "format ascii 2.0"), 2, "unknown PLY format");
  expectPlyError(withLine(kQuadPly, 2, "comment"), 10, "has no format");
  expectPlyError(withLine(kQuadPly, 4, "element vertex four"), 4, "bad integer");
  expectPlyError(withLine(kQuadPly, 4, "element vertex -1"), 4, "out of range");
  expectPlyError(withLine(kQuadPly, 4, "element vertex 4294967295"), 4, "out of range");
  expectPlyError(withLine(kQuadPly, 4, "element vertex 4000000000"), 4, "too short for 4000000000 rows");
  expectPlyError(withLine(kQuadPly, 5, "property half x"), 5, "unknown PLY type \"half\"");
  expectPlyError(withLine(kQuadPly, 5, "property float q"), 4, "lack a coordinate");
  expectPlyError(withLine(kQuadPly, 9, "property list float int vertex_indices"), 9, "counted by a float");
  expectPlyError(withLine(kQuadPly, 9, "property list uchar int corners"), 8, "have no vertices");
  expectPlyError(withLine(kQuadPly, 3, "hello"), 3, "unknown PLY header line");
  expectPlyError(kQuadPly.substr(0, kQuadPly.find("end_header")), 11, "header does not end");
}

// Elements without properties have rows of no bytes, so a file can announce any number of them.
TEST(Ply, ElementsThatAreMissingOrGivenTwiceAreErrors) {
  const auto quadWith = [](const std::string& element) {
    return std::string(kQuadPly).insert(kQuadPly.find("element face"), element);
  };
  expectPlyError(withLine(quadWith("element vertex 1000000\n"), kQuadPlyVertexLine + 5, "4 0 1 2 999999"), 1,
                 "2 elements \"vertex\" and 1 \"face\"; expected one of each");
  expectPlyError(quadWith("element face 0\n"), 1, "1 elements \"vertex\" and 2 \"face\"");
  expectPlyError(withLine(kQuadPly, 8, "element edge 2"), 1, "1 elements \"vertex\" and 0 \"face\"");
}

TEST(Ply, FileThatIsTooShortIsNamedWithItsSize) {
  const std::string text = withLine(kQuadPly, 4, "element vertex 4000000");
  expectPlyError(text, 4, "file of " + std::to_string(text.size()) + " bytes is too short for 4000000 rows");
}

TEST(Ply, FacesBeforeTheirVerticesAreAnError) {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto plyOf = [](const std::string& elements, const std::string& rows) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + rows;
  };
  const auto vertices = [](int count) {
    return "element vertex " + std::to_string(count) + "\nproperty float x\nproperty float y\nproperty float z\n";
  };
  expectPlyError(plyOf(face + vertices(3), "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"), 3,
                 "no vertices before its faces; expected the vertices first");
  expectPlyError(plyOf(vertices(0) + face, "3 0 1 2\n"), 7, "no vertices before its faces");
}

TEST(Ply, BodyErrorsNameTheirLine) {
  expectPlyError(vertexLine(1, "1 zero 0"), 12, "bad number \"zero\"");
  expectPlyError(vertexLine(2, "0 nan 0"), 13, "not a finite float");
  expectPlyError(vertexLine(2, "0 1e39 0"), 13, "not a finite float");
  expectPlyError(vertexLine(4, "3 0 1 4"), 15, "refers to vertex 4; expected 0 to 3");
  expectPlyError(vertexLine(4, "3 0 1 -1"), 15, "refers to vertex -1");
  expectPlyError(vertexLine(4, "2 0 1"), 15, "face has 2 corners");
  expectPlyError(vertexLine(5, "200 0 1 2"), 16, "list has 200 items but the file ends");
  expectPlyError(vertexLine(5, "3 1 3"), 16, "file ends");
  expectPlyError(std::string(kQuadPly) + "1\n", 17, "goes on after its last element");
}

TEST(Ply, BinaryErrorsNameTheFirstLineOfTheBody) {
  const std::string good = binaryQuadPly(false);
  const int bodyLine = 11;
  expectPlyError(good.substr(0, good.size() - 1), bodyLine, "file ends");
  expectPlyError(good + "x", bodyLine, "goes on after its last element");
  std::string nan = good;
  const float bad = std::numeric_limits<float>::quiet_NaN();
  const size_t body = good.find("end_header\n") + 11;
  std::memcpy(nan.data() + body + 8, &bad, 4);  // y of vertex 0, after x as a double
  expectPlyError(nan, bodyLine, "vertex 0 is not finite");
  std::string outside = good;
  outside[outside.size() - 4] = 9;  // last index, lowest byte
  expectPlyError(outside, bodyLine, "refers to vertex 9");
}

TEST(Ply, DamagedGzipIsAnError) {
  const std::string packed = gzip(kQuadPly);
  expectPlyError(packed.substr(0, packed.size() / 2), 0, "truncated gzip data");
  std::string damaged = packed;
  damaged[packed.size() / 2] = static_cast<char>(~damaged[packed.size() / 2]);
  expectPlyError(damaged, 0, "damaged gzip data");
}

TEST(Ply, CompressionBombIsStopped) {
  expectPlyError(gzip(std::string(size_t{64} << 20, ' ')), 0, "inflates to more than");
}

TEST(Ply, NothingButTrianglesWithoutAreaIsLeftOut) {
  const Scene scene =
      loadPly(vertexLine(2, "2 0 0").replace(kQuadPly.find("1 1 0"), 5, "3 0 0"), kShape + std::string(kSphere));
  EXPECT_EQ(scene.shapes.size(), 1u);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "shape \"ply\" without area");
}

// ---- texture coordinates of corners ---------------------------------------------------------------------------------

// Two triangles of a bent square, whose properties stand as in a file of MeshLab.
std::string cornerUvPly(std::string_view rows, std::string_view properties = "") {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
         std::string(properties) +
         "element face 2\nproperty list uchar int vertex_indices\nproperty uchar flags\nproperty list uchar float "
         "texcoord\nproperty int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 1\n0 1 0\n" +
         std::string(rows);
}
const char* const kCornerUvRows = "3 0 1 2 0 6 0 0 1 0 1 1 0\n3 0 2 3 0 6 0.5 0 1 1 0 1 0\n";

TEST(Ply, CornersThatDifferInTextureCoordinatesAreSplit) {
  const Mesh mesh = meshOfPly(cornerUvPly(kCornerUvRows));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {4, 2, 3}}));
  EXPECT_EQ(mesh.positions[4], mesh.positions[0]);
  EXPECT_EQ(mesh.uvs, (std::vector<Float2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 0}}));
}

TEST(Ply, SplitCornersKeepTheNormalOfTheirVertex) {
  const Mesh mesh = meshOfPly(cornerUvPly(kCornerUvRows));
  EXPECT_EQ(mesh.normals[4], mesh.normals[0]);
  EXPECT_LT(mesh.normals[0][0], 0);  // of both triangles, and not of one alone
  EXPECT_LT(mesh.normals[0][1], 0);
}

TEST(Ply, FacesWithoutTextureCoordinatesHaveZeros) {
  const Mesh mesh = meshOfPly(cornerUvPly("3 0 1 2 0 6 1 0 1 0 1 1 0\n3 0 2 3 0 0 0\n"));
  EXPECT_EQ(mesh.uvs[mesh.triangles[1][1]], (Float2{0, 0}));
}

TEST(Ply, TextureCoordinatesOfCornersAreChecked) {
  expectPlyError(cornerUvPly("3 0 1 2 0 4 0 0 1 0 0\n3 0 2 3 0 6 0 0 1 1 0 1 0\n"), 17,
                 "face of 3 corners has 4 texture coordinates; expected u and v for each corner");
}

TEST(Ply, ConcavePolygonIsCutIntoEars) {
  const Mesh mesh = meshOfPly(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face "
      "1\nproperty list uchar int vertex_indices\nend_header\n-1 -1 0\n0 0 0\n1 -1 0\n0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{3, 0, 1}, {3, 1, 2}}));
}

}  // namespace
}  // namespace wavecrest
