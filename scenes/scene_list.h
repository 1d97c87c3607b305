// The built-in scenes: their names, a line about each, and where their files are.
//
// The nine scenes of the study come first, in its order, then those that exist for benchmarks. This list is the one
// place that names them.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace wavecrest {

struct SceneEntry {
  std::string_view name;
  std::string_view description;
};

std::span<const SceneEntry> sceneList();

// The folder with the scenes' XML files: $WAVECREST_SCENES if set, else the first that exists of the source folder this
// build was made from, the installed folder, and ../../scenes beside the running executable.
// Throws std::runtime_error when the folder that $WAVECREST_SCENES names does not exist, or none of the others does.
std::filesystem::path scenesFolder();

// The XML file of a built-in scene; nothing when `name` is not in the list. Throws as scenesFolder does, and when the
// folder lacks the file.
std::optional<std::filesystem::path> builtinScenePath(std::string_view name);

// How to get an asset that a scene names but that does not exist, for the end of an error message: "scenes/fetch-dragon
// gets ..." for the dragon, the build target for what the build generates. Empty for any other file.
std::string missingAssetHint(const std::filesystem::path& file);

}  // namespace wavecrest
