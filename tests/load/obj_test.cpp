// OBJ files.
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

constexpr std::string_view kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Mesh meshOfObj(std::string_view content, std::string_view options = "") {
  const Folder folder;
  folder.write("mesh.obj", content);
  const Scene scene = load(folder, sceneXml(R"(<shape type="obj"><string name="filename" value="mesh.obj"/>)" +
                                            std::string(options) + "</shape>" + std::string(kSensor)));
  return std::get<Mesh>(scene.shapes.at(0).kind);
}
void expectObjError(std::string_view content, int line, std::string_view text) {
  const Folder folder;
  folder.write("mesh.obj", content);
  expectError(
      folder,
      sceneXml(R"(<shape type="obj"><string name="filename" value="mesh.obj"/></shape>)" + std::string(kSensor)), line,
      text, "mesh.obj");
}

TEST(Obj, QuadIsCutAsMitsubaCutsIt) {
  EXPECT_EQ(meshOfObj(std::string(kQuad) + "f 1 2 3 4\n").triangles,
            (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Obj, Gzipped) { EXPECT_EQ(meshOfObj(gzip(std::string(kQuad) + "f 1 2 3\n")).triangles.size(), 1u); }

TEST(Obj, NegativeIndicesCountBackwards) {
  const Mesh mesh = meshOfObj(std::string(kQuad) + "f -4 -3 -1\n");
  EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Obj, CornersThatDifferInTextureCoordinatesAreSplit) {
  const Mesh mesh = meshOfObj(std::string(kQuad) + "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n");
  EXPECT_EQ(mesh.positions.size(), 5u);  // vertex 1 twice, vertex 3 shared
  EXPECT_EQ(mesh.uvs.size(), 5u);
}

TEST(Obj, TextureCoordinatesAreFlippedByDefault) {
  const std::string text = std::string(kQuad) + "vt 0.25 0.25\nf 1/1 2/1 3/1\n";
  EXPECT_EQ(meshOfObj(text).uvs[0], (Float2{0.25f, 0.75f}));
  EXPECT_EQ(meshOfObj(text, R"(<boolean name="flip_tex_coords" value="false"/>)").uvs[0], (Float2{0.25f, 0.25f}));
}

TEST(Obj, NormalsOfTheFileAreUsed) {
  const Mesh mesh = meshOfObj(std::string(kQuad) + "vn 0 0.6 0.8\nf 1//1 2//1 3//1\n");
  EXPECT_FLOAT_EQ(mesh.normals[0][1], 0.6f);
}

TEST(Obj, CornerWithoutNormalAmongOthersGetsTheSmoothOne) {
  const Mesh mesh = meshOfObj(std::string(kQuad) + "vn 0 0.6 0.8\nf 1//1 2//1 3\n");
  EXPECT_EQ(mesh.normals[2], (Float3{0, 0, 1}));
}

TEST(Obj, OtherLinesAreSkipped) {
  EXPECT_EQ(
      meshOfObj("# a comment\nmtllib x.mtl\no thing\ng part\ns off\n" + std::string(kQuad) + "usemtl red\n\nf 1 2 3\n")
          .triangles.size(),
      1u);
}

Scene sceneOfObj(std::string_view content, std::string_view version, std::string_view options) {
  const Folder folder;
  folder.write("mesh.obj", content);
  return load(folder, sceneXml(R"(<shape type="obj"><string name="filename" value="mesh.obj"/>)" +
                                   std::string(options) + "</shape>" + std::string(kSensor),
                               version));
}

TEST(Obj, MaterialsOfALibraryAreNotedInOldFiles) {
  const std::string faces = std::string(kQuad) + "usemtl red\nf 1 2 3\n", text = "mtllib x.mtl\n" + faces;
  const auto effectOf = [&](std::string_view options) {
    const Scene scene = sceneOfObj(text, "0.6.0", options);
    return scene.notes.size() == 1 ? scene.notes[0].effect : std::to_string(scene.notes.size()) + " notes";
  };
  EXPECT_EQ(effectOf(""), "left out: a shape without a bsdf is diffuse of reflectance 0.5");
  EXPECT_EQ(effectOf(R"(<emitter type="area"/>)"), "left out: a light without a bsdf is black");
  EXPECT_EQ(effectOf(R"(<bsdf type="diffuse"/>)"), "0 notes");
  EXPECT_EQ(effectOf(R"(<boolean name="loadMaterials" value="false"/>)"), "0 notes");
  EXPECT_TRUE(sceneOfObj(faces, "0.6.0", "").notes.empty()) << "no library";
  EXPECT_TRUE(sceneOfObj(text, "3.0.0", "").notes.empty()) << "as in Mitsuba 3";
}

// Mitsuba 0.6 makes a mesh of each of them, so that this cube has flat faces.
TEST(Obj, GroupsAndMaterialsOfOldFilesShareNoVertices) {
  const auto meshOf = [](const std::string& divider, std::string_view version, std::string_view options = "") {
    std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    for (const char* face : {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"}) {
      text += divider + "\nf " + face + "\n";
    }
    return std::get<Mesh>(sceneOfObj(text, version, options).shapes.at(0).kind);
  };
  for (const char* divider : {"g side", "g", "usemtl red"}) {
    const Mesh old = meshOf(divider, "0.6.0");
    ASSERT_EQ(old.positions.size(), 24u) << divider;
    EXPECT_FLOAT_EQ(old.normals[0][2], -1) << divider;
    EXPECT_EQ(meshOf(divider, "0.6.0", R"(<boolean name="collapse" value="true"/>)").positions.size(), 8u) << divider;
    EXPECT_EQ(meshOf(divider, "3.0.0").positions.size(), 8u) << divider;
  }
  EXPECT_EQ(meshOf("s 1", "0.6.0").positions.size(), 8u);
}

TEST(Obj, OneMeshOfAnOldFileIsRefused) {
  const std::string text = std::string(kQuad) + "f 1 2 3\n";
  const auto index = [](const char* value) {
    return R"(<integer name="shapeIndex" value=")" + std::string(value) + "\"/>";
  };
  const Folder folder;
  folder.write("mesh.obj", text);
  expectError(folder,
              sceneXml("\n<shape type=\"obj\"><string name=\"filename\" value=\"mesh.obj\"/>" + index("1") +
                           "</shape>" + std::string(kSensor),
                       "0.6.0"),
              2, "one mesh of an OBJ file is not supported; expected a file of this mesh alone");
  EXPECT_TRUE(sceneOfObj(text, "0.6.0", index("-1")).notes.empty()) << "all meshes";
}

TEST(Obj, IndexThatIsMissingAfterASlashIsAbsent) {
  const std::string text = std::string(kQuad) + "vt 0.25 0.5\nvn 0 0.6 0.8\n";
  for (const char* face : {"f 1/1/ 2/1/ 3/1/\n", "f 1/1 2/1 3/1/ \n"}) {
    const Mesh mesh = meshOfObj(text + face);
    EXPECT_EQ(mesh.uvs, (std::vector<Float2>(3, {0.25f, 0.5f}))) << face;
    EXPECT_EQ(mesh.normals, (std::vector<Float3>(3, {0, 0, 1}))) << face;
  }
  EXPECT_TRUE(meshOfObj(text + "f 1/ 2/ 3/\n").uvs.empty());
}

TEST(Obj, FaceEndsAtAComment) { EXPECT_EQ(meshOfObj(std::string(kQuad) + "f 1 2 3 # 4 tail\n").triangles.size(), 1u); }

TEST(Obj, FacesOfFewerThanThreeCornersAreDroppedAndCounted) {
  const Folder folder;
  folder.write("mesh.obj", std::string(kQuad) + "f 4 2\nf 1 2 3\nf\n");
  const Scene scene = load(folder, sceneXml(R"(<shape type="obj"><string name="filename" value="mesh.obj"/></shape>)" +
                                            std::string(kSensor)));
  EXPECT_EQ(std::get<Mesh>(scene.shapes.at(0).kind).positions.size(), 3u);
  EXPECT_EQ(scene.droppedTriangles, 2u);
}

TEST(Obj, ErrorsNameTheirLine) {
  expectObjError("v 0 0\n", 1, "too few numbers; expected 3");
  expectObjError("v 0 0 zero\n", 1, "bad number \"zero\"");
  expectObjError("v 0 0 inf\n", 1, "not a finite float");
  expectObjError(std::string(kQuad) + "f 1 2 5\n", 5, "refers to vertex 5; expected 1 to 4");
  expectObjError(std::string(kQuad) + "f 0 1 2\n", 5, "refers to vertex 0");
  expectObjError(std::string(kQuad) + "f 1 2 -5\n", 5, "refers to vertex -5");
  expectObjError(std::string(kQuad) + "f 1/1 2/1 3/1\n", 5, "texture coordinate 1");
  expectObjError(std::string(kQuad) + "f 1//1 2 3\n", 5, "normal 1");
  expectObjError(std::string(kQuad) + "f 1 2 3x\n", 5, "face corner is malformed");
  expectObjError(std::string(kQuad) + "f 1 2 99999999999999999999\n", 5, "bad integer");
}

TEST(Obj, WithoutFacesIsLeftOut) {
  const Folder folder;
  folder.write("mesh.obj", kQuad);
  const Scene scene = load(folder, sceneXml(R"(<shape type="obj"><string name="filename" value="mesh.obj"/></shape>)" +
                                            std::string(kSensor) + std::string(kSphere)));
  EXPECT_EQ(scene.shapes.size(), 1u);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "shape \"obj\" without area");
}

}  // namespace
}  // namespace wavecrest
