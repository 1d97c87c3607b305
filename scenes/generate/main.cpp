// wavecrest_generate_scenes: writes the generated assets of the scenes (meshes, textures, environment map, dragons).
//
// Everything is a pure function of the numbers in this folder: the same bytes on every run. The build calls it with the
// names of what it needs (scenes/CMakeLists.txt); scenes/fetch-dragon calls it for the dragons.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/generate/assets.h"

int main(int argc, char** argv) {
  std::filesystem::path output;
  std::vector<std::string> names;
  bool list = false;
  CLI::App app{"Writes the generated assets of wavecrest's scenes."};
  app.add_option("-o,--output", output, "folder to write to, usually scenes/assets");
  app.add_option("names", names, "file names of the assets to write, for instance pool_water.ply");
  app.add_flag("--list", list, "print the names of all assets and exit");
  CLI11_PARSE(app, argc, argv);

  try {
    if (list) {
      for (const wavecrest::generate::Asset& asset : wavecrest::generate::assetList()) std::printf("%s\n", asset.file);
      return 0;
    }
    if (output.empty() || names.empty()) {
      std::fprintf(stderr, "wavecrest_generate_scenes: error: expected --output FOLDER and the names of assets\n");
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
