// The scene's fingerprint: equal content, equal hash; any content that changes an image changes it.
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

const std::string kBase =
    R"(<sensor type="perspective"><film type="hdrfilm"><integer name="width" value="64"/></film></sensor>
  <bsdf type="diffuse" id="m"><rgb name="reflectance" value="0.5"/></bsdf>
  <shape type="sphere"><ref id="m"/></shape><emitter type="constant"/>)";

uint64_t hashOf(const std::string& body) { return load(sceneXml(body)).hash; }
uint64_t hashWith(const std::string& from, const std::string& to) {
  std::string body = kBase;
  const size_t at = body.find(from);
  EXPECT_NE(at, std::string::npos);
  return hashOf(body.replace(at, from.size(), to));
}

TEST(SceneHash, IsTheSameOnEveryMachine) { EXPECT_EQ(hashOf(kBase), 9481141338175410767u); }

TEST(SceneHash, IgnoresNamesPathsAndLayout) {
  EXPECT_EQ(hashOf("\n\n<!-- note -->" + kBase), hashOf(kBase));
  std::string renamed = kBase;
  renamed.replace(renamed.find("id=\"m\""), 6, "id=\"n\"");
  renamed.replace(renamed.find("ref id=\"m\""), 10, "ref id=\"n\"");
  EXPECT_EQ(hashOf(renamed), hashOf(kBase));
}

TEST(SceneHash, ChangesWithEveryKindOfContent) {
  const uint64_t base = hashOf(kBase);
  EXPECT_NE(hashWith("\"0.5\"", "\"0.5000001\""), base);
  EXPECT_NE(hashWith("\"64\"", "\"65\""), base);
  EXPECT_NE(hashWith("<emitter type=\"constant\"/>", ""), base);
  EXPECT_NE(hashWith("<emitter type=\"constant\"/>", "<emitter type=\"point\"/>"), base);
  EXPECT_NE(hashWith("<ref id=\"m\"/>", "<ref id=\"m\"/><float name=\"radius\" value=\"2\"/>"), base);
  EXPECT_NE(hashWith("<ref id=\"m\"/>", "<ref id=\"m\"/><boolean name=\"flip_normals\" value=\"true\"/>"), base);
  EXPECT_NE(hashWith("type=\"perspective\">", "type=\"perspective\"><float name=\"fov\" value=\"20\"/>"), base);
  EXPECT_NE(
      hashWith("<emitter", "<integrator type=\"path\"><integer name=\"max_depth\" value=\"3\"/></integrator><emitter"),
      base);
}

TEST(SceneHash, ChangesWithTheContentOfAMeshFile) {
  const Folder folder;
  const std::string xml =
      sceneXml(R"(<shape type="ply"><string name="filename" value="mesh.ply"/></shape>)" + std::string(kSensor));
  folder.write("mesh.ply", kQuadPly);
  const uint64_t first = load(folder, xml).hash;
  folder.write("mesh.ply", withLine(kQuadPly, kQuadPlyVertexLine, "0 0 0.5"));
  EXPECT_NE(load(folder, xml).hash, first);
  folder.write("mesh.ply", gzip(kQuadPly));
  EXPECT_EQ(load(folder, xml).hash, first);
}

}  // namespace
}  // namespace wavecrest
