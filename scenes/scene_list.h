// The built-in scenes by name, and where their files are.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace wavecrest {

struct SceneEntry {
  std::string_view name;         // as on the command line; its file is NAME.xml
  std::string_view description;  // one line
};

std::span<const SceneEntry> builtInScenes();

// The folder of the built-in scenes: $WAVECREST_SCENES if set, else the source tree this binary was built from.
std::filesystem::path sceneFolder();

// A built-in scene's file, or the argument itself taken as a path.
std::filesystem::path findScene(const std::string& nameOrPath);

}  // namespace wavecrest
