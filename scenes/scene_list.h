// The built-in scenes: their names, a line about each, and where their files are.
//
// The nine scenes of the study come first, in its order, then those that exist for benchmarks. Tools and tests that
// treat each of the nine differently name them too (CONTRIBUTING.md, "How to add a scene").
#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace wavecrest {

struct SceneEntry {
  std::string_view name;          // as on the command line; its file is NAME.xml
  std::string_view description;   // one line
  std::string_view fetched = {};  // a file, relative to sceneFolder(), that users have to get themselves
};

std::span<const SceneEntry> builtInScenes();    // the nine
std::span<const SceneEntry> benchmarkScenes();  // known by name too, not part of the study

// There is no folder of built-in scenes. The text is complete.
struct SceneFolderError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The folder of the built-in scenes: $WAVECREST_SCENES if set, else the first that exists of those installed with this
// program, library or Python module, the source folder that it was built from, the folder that it was to be installed
// in, and ../../scenes beside the running executable.
// Throws SceneFolderError when the folder that $WAVECREST_SCENES names does not exist, or none of the others does.
std::filesystem::path sceneFolder();

// The file of a built-in or benchmark scene, or the argument itself taken as a path. Throws as sceneFolder does.
std::filesystem::path findScene(const std::string& nameOrPath);

// How to get an asset of the scenes that does not exist, for the end of an error message: scenes/fetch-dragon for the
// dragon, the build for what it generates. Empty for any other file.
std::string missingAssetHint(const std::filesystem::path& file);

}  // namespace wavecrest
