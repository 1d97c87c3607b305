#include "scenes/generate/assets.h"

#include <stdexcept>
#include <string>

#include "scenes/generate/dragon.h"
#include "scenes/generate/environment.h"
#include "scenes/generate/lathe.h"
#include "scenes/generate/pictures.h"
#include "scenes/generate/ply_writer.h"
#include "scenes/generate/teapot.h"
#include "scenes/generate/water.h"

namespace wavecrest::generate {
namespace {

using Path = std::filesystem::path;

// The models that scenes/fetch-dragon unpacks lie in a folder beside the prepared ones.
void writeDragon(const Path& file, const char* model) {
  const Path scan = file.parent_path() / "stanford-dragon" / model;
  if (!std::filesystem::exists(scan)) {
    throw std::runtime_error(scan.string() + " is missing; scenes/fetch-dragon gets the Stanford dragon");
  }
  writePly(prepareDragon(readScan(scan)), "Stanford dragon, Stanford Computer Graphics Laboratory", file);
}

void writeWater(const Path& file) {
  // The basin is 8 x 5; the surface reaches 0.02 into its walls.
  writePly(makeWater({.halfX = 4.02, .halfZ = 2.52, .cellsX = 640, .cellsZ = 400}), "water surface", file);
}

constexpr uint32_t kShadeSegments = 40;

constexpr Asset kAssets[] = {
    {"dragon_full.ply", [](const Path& file) { writeDragon(file, "dragon_vrip.ply.gz"); }},
    {"dragon_res2.ply", [](const Path& file) { writeDragon(file, "dragon_vrip_res2.ply.gz"); }},
    {"dragon_res3.ply", [](const Path& file) { writeDragon(file, "dragon_vrip_res3.ply.gz"); }},
    {"dragon_res4.ply", [](const Path& file) { writeDragon(file, "dragon_vrip_res4.ply.gz"); }},
    {"desk_lamp_shade.ply",
     [](const Path& file) { writePly(makeCone(0.035, 0.12, 0.19, kShadeSegments), "desk lamp shade", file); }},
    {"uplighter_bowl.ply",
     [](const Path& file) { writePly(makeCone(0.06, 0.24, 0.22, kShadeSegments), "uplighter bowl", file); }},
    {"teapot.ply", [](const Path& file) { writePly(makeOpaqueTeapot(), "teapot for opaque materials", file); }},
    {"teapot_glass.ply", [](const Path& file) { writePly(makeGlassTeapot(), "teapot with a wall of glass", file); }},
    {"pool_water.ply", writeWater},
    {"sky.exr", [](const Path& file) { writeExr(makeSky(), file); }},
    {"small_sun.exr", [](const Path& file) { writeExr(makeSky(kSmallSun), file); }},
    {"tiles.png", [](const Path& file) { writePng(makeTiles(), file); }},
    {"wood.png", [](const Path& file) { writePng(makeWood(), file); }},
    {"landscape.png", [](const Path& file) { writePng(makeLandscape(), file); }},
    {"bumps.png", [](const Path& file) { writePng(makeBumps(), file, PngEncoding::raw); }},
    {"normals.png", [](const Path& file) { writePng(makeNormals(), file, PngEncoding::raw); }},
    {"patches.exr", [](const Path& file) { writeExr(makePatches(), file); }},
};

}  // namespace

std::span<const Asset> assetList() { return kAssets; }

const Asset& findAsset(std::string_view file) {
  for (const Asset& asset : kAssets)
    if (file == asset.file) return asset;
  throw std::runtime_error("no generated asset is called '" + std::string(file) + "'; --list prints them");
}

}  // namespace wavecrest::generate
