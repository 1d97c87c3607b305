// Mesh files of a scene are read side by side, which changes neither the scene nor its errors.
#include <oneapi/tbb/task_arena.h>

#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

std::string triangle(int number) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 " +
         std::to_string(number) + "\n1 0 0\n0 1 0\n3 0 1 2\n";
}
std::string shape(std::string_view type, const std::string& file, std::string_view options = "") {
  return "<shape type=\"" + std::string(type) + R"("><string name="filename" value=")" + file + "\"/>" +
         std::string(options) + "</shape>\n";
}

class MeshesAheadTest : public ::testing::Test {
 protected:
  // Files whose meshes all differ, in all formats and in places that a reader could mistake for one another.
  std::string manyShapes() const {
    std::string body(kSensor);
    for (int i = 0; i < 12; ++i) {
      const std::string number = std::to_string(i);
      folder.write(number + ".ply", triangle(i));
      body += shape("ply", number + ".ply");
    }
    folder.write("mesh.serialized", serializedQuad({}));
    body += shape("serialized", "mesh.serialized") +
            shape("serialized", "mesh.serialized", R"(<boolean name="flip_tex_coords" value="true"/>)");
    folder.write("mesh.obj", "v 0 0 5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return body + shape("obj", "mesh.obj") + shape("ply", "3.ply");
  }
  void expectFirstError(const std::string& body, int line, std::string_view text, std::string_view file) const {
    for (int threads = 1; threads <= 4; ++threads) {
      oneapi::tbb::task_arena(threads).execute([&] { expectError(folder, sceneXml(body), line, text, file); });
    }
  }

  Folder folder;
};

TEST_F(MeshesAheadTest, EveryShapeGetsItsOwnFile) {
  const Scene scene = load(folder, sceneXml(manyShapes()));
  ASSERT_EQ(scene.shapes.size(), 16u);
  const auto mesh = [&](size_t i) { return std::get<Mesh>(scene.shapes[i].kind); };
  for (size_t i = 0; i < 12; ++i) EXPECT_EQ(mesh(i).positions.at(0)[2], static_cast<float>(i));
  EXPECT_EQ(mesh(12).uvs.at(2)[1], 1);
  EXPECT_EQ(mesh(13).uvs.at(2)[1], 0);
  EXPECT_EQ(mesh(14).positions.at(0)[2], 5);
  EXPECT_EQ(mesh(15).positions.at(0)[2], 3);
  EXPECT_EQ(scene.files.size(), 17u) << "the scene's own and one for each shape";
}

TEST_F(MeshesAheadTest, TheFirstErrorInTheOrderOfShapesIsReported) {
  folder.write("good.ply", triangle(0));
  folder.write("bad.ply", triangle(0).replace(0, 3, "pli"));
  const std::string good = shape("ply", "good.ply"), bad = shape("ply", "bad.ply"), none = shape("ply", "none.ply");
  const std::string sensor = std::string(kSensor) + "\n";
  expectFirstError(sensor + good + bad + none, 1, "ply", "bad.ply");
  expectFirstError(sensor + good + none + bad, 3, "none.ply", "scene.xml");
  const std::string wrong = R"(<shape type="sphere"><float name="radios" value="1"/></shape>)";
  expectFirstError(sensor + wrong + "\n" + bad + bad, 2, "radios", "scene.xml");
  expectFirstError(sensor + bad + wrong + bad, 1, "ply", "bad.ply");
  const std::string lost = shape("serialized", "lost.serialized");
  expectFirstError(sensor + good + lost + lost, 3, "lost.serialized", "scene.xml");
}

}  // namespace
}  // namespace wavecrest
