// The list of scenes against the files: every scene is there, and so is every file that a scene names.
#include "scenes/scene_list.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <vector>

#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Sets an environment variable for the duration of a test.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~ScopedVariable() { unsetenv(name_); }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
};

// The files that a scene or one of its includes names, defaults substituted, relative to the scene's own folder.
std::set<fs::path> namedFiles(const fs::path& scene, const fs::path& folder) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file(scene.c_str())) << scene;
  std::set<fs::path> files;
  for (const auto& match : document.select_nodes("//string[@name='filename']")) {
    std::string value = match.node().attribute("value").value();
    if (const size_t at = value.find('$'); at != std::string::npos) {
      const std::string name = value.substr(at + 1, value.find_first_of("./", at) - at - 1);
      const std::string query = "//default[@name='" + name + "']";
      value.replace(at, 1 + name.size(), document.select_node(query.c_str()).node().attribute("value").value());
    }
    files.insert(folder / value);
  }
  for (const auto& match : document.select_nodes("//include")) {
    const fs::path included = folder / match.node().attribute("filename").value();
    files.insert(included);
    files.merge(namedFiles(included, folder));
  }
  return files;
}

TEST(SceneList, HasTheNineOfTheStudyInOrder) {
  const std::vector<std::string_view> expected{"cornell-diffuse", "cornell-mirror",  "cornell-glossy",
                                               "cornell-spheres", "dragon-caustics", "dragon-caustics-glossy",
                                               "lafortune-room",  "pool-interior",   "veach-door"};
  std::vector<std::string_view> names;
  for (const SceneEntry& scene : builtInScenes()) names.push_back(scene.name);
  EXPECT_EQ(names, expected);
}

TEST(SceneList, EveryFileThatASceneNamesExists) {
  int checked = 0;
  for (const auto& entry : fs::recursive_directory_iterator(sceneFolder())) {
    const fs::path& scene = entry.path();
    if (scene.extension() != ".xml" || scene.parent_path().filename() == "parts") continue;
    for (const fs::path& file : namedFiles(scene, scene.parent_path())) {
      if (file.filename().string().starts_with("dragon_")) continue;  // fetched on request
      EXPECT_TRUE(fs::exists(file)) << scene << " names " << file;
      ++checked;
    }
  }
  EXPECT_GT(checked, 30);
}

TEST(SceneList, FindsEveryScene) {
  for (std::span<const SceneEntry> list : {builtInScenes(), benchmarkScenes()}) {
    for (const SceneEntry& scene : list) {
      EXPECT_TRUE(fs::exists(findScene(std::string(scene.name)))) << scene.name;
      EXPECT_FALSE(scene.description.empty()) << scene.name;
    }
  }
}

TEST(SceneList, TakesAnythingElseAsAPath) { EXPECT_EQ(findScene("some/where.xml"), fs::path("some/where.xml")); }

TEST(SceneList, TheEnvironmentChoosesTheFolder) {
  const test::TemporaryFolder files;
  const ScopedVariable variable("WAVECREST_SCENES", files.folder().string());
  EXPECT_EQ(findScene("veach-door"), files.folder() / "veach-door.xml");
}

TEST(SceneList, AFolderThatDoesNotExistIsAnError) {
  const ScopedVariable variable("WAVECREST_SCENES", "/nowhere/scenes");
  EXPECT_THROW(sceneFolder(), SceneFolderError);
}

TEST(SceneList, HintsAtHowToGetMissingAssets) {
  EXPECT_NE(missingAssetHint("scenes/assets/dragon_res2.ply").find("scenes/fetch-dragon"), std::string::npos);
  EXPECT_NE(missingAssetHint("scenes/assets/sky.exr").find("wavecrest_scene_assets"), std::string::npos);
  EXPECT_EQ(missingAssetHint("my/own/sky.exr"), "");
}

}  // namespace
}  // namespace wavecrest
