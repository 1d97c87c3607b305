// wavecrest_generate_scenes: writes the generated assets of the scenes (meshes, textures, environment map, dragons).
//
// Everything is a pure function of the numbers in this folder: the same bytes on every run. The build calls it with the
// names of what it needs (scenes/CMakeLists.txt); scenes/fetch-dragon calls it for the dragons.
//
//   wavecrest_generate_scenes --list | --output FOLDER NAME...
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/generate/assets.h"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  std::filesystem::path output;
  std::vector<std::string> names;
  bool list = false;
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--list") {
      list = true;
    } else if (arguments[i] == "--output" && i + 1 < arguments.size()) {
      output = arguments[++i];
    } else {
      names.push_back(arguments[i]);
    }
  }

  try {
    if (list) {
      for (const wavecrest::generate::Asset& asset : wavecrest::generate::assetList()) std::printf("%s\n", asset.file);
      return 0;
    }
    if (output.empty() || names.empty()) {
      std::fprintf(stderr,
                   "wavecrest_generate_scenes: error: expected --list, or --output FOLDER and the names of assets\n");
      return 2;
    }
    std::filesystem::create_directories(output);
    for (const std::string& name : names) wavecrest::generate::findAsset(name).write(output / name);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wavecrest_generate_scenes: error: %s\n", error.what());
    return 1;
  }
  return 0;
}
