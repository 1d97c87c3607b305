// The list of generated assets: a file name and the function that writes it. Adding an asset means one line in
// assets.cpp and its name in scenes/CMakeLists.txt.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace wavecrest::generate {

struct Asset {
  const char* file;
  void (*write)(const std::filesystem::path& file);
};

std::span<const Asset> assetList();

// Throws std::runtime_error when no asset has this file name.
const Asset& findAsset(std::string_view file);

}  // namespace wavecrest::generate
