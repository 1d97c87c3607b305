#include "scenes/generate/assets.h"

#include <stdexcept>
#include <string>

#include "scenes/generate/dragon.h"
#include "scenes/generate/ply_writer.h"
#include "scenes/generate/water.h"

namespace wavecrest::generate {
namespace {

// The models that scenes/fetch-dragon unpacks lie in a folder beside the prepared ones.
void writeDragon(const std::filesystem::path& file, const char* model) {
  const std::filesystem::path scan = file.parent_path() / "stanford-dragon" / model;
  if (!std::filesystem::exists(scan)) {
    throw std::runtime_error(scan.string() + " is missing; scenes/fetch-dragon gets the Stanford dragon");
  }
  writePly(prepareDragon(readScan(scan)), "Stanford dragon, Stanford Computer Graphics Laboratory", file);
}

void writeWater(const std::filesystem::path& file) {
  // The basin is 8 x 5; the surface reaches 0.02 into its walls.
  writePly(makeWater({.halfX = 4.02, .halfZ = 2.52, .cellsX = 640, .cellsZ = 400}), "water surface", file);
}

constexpr Asset kAssets[] = {
    {"dragon_full.ply", [](const std::filesystem::path& file) { writeDragon(file, "dragon_vrip.ply.gz"); }},
    {"dragon_res2.ply", [](const std::filesystem::path& file) { writeDragon(file, "dragon_vrip_res2.ply.gz"); }},
    {"dragon_res3.ply", [](const std::filesystem::path& file) { writeDragon(file, "dragon_vrip_res3.ply.gz"); }},
    {"dragon_res4.ply", [](const std::filesystem::path& file) { writeDragon(file, "dragon_vrip_res4.ply.gz"); }},
    {"pool_water.ply", writeWater},
};

}  // namespace

std::span<const Asset> assetList() { return kAssets; }

const Asset& findAsset(std::string_view file) {
  for (const Asset& asset : kAssets)
    if (file == asset.file) return asset;
  throw std::runtime_error("no generated asset is called '" + std::string(file) + "'; --list prints them");
}

}  // namespace wavecrest::generate
