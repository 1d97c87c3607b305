// Sky, textures and picture files.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numbers>

#include "scenes/generate/assets.h"
#include "scenes/generate/environment.h"
#include "scenes/generate/pictures.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest::generate {
namespace {

TEST(Sky, SunStandsWhereTheScenesWantIt) {
  const Image sky = makeSky();
  size_t brightest = 0;
  for (size_t i = 0; i < sky.pixels.size(); ++i)
    if (sky.pixels[i][0] > sky.pixels[brightest][0]) brightest = i;
  const size_t x = brightest % sky.width, y = brightest / sky.width;
  const double theta = std::numbers::pi * (static_cast<double>(y) + 0.5) / sky.height;
  const double phi = 2 * std::numbers::pi * (static_cast<double>(x) + 0.5) / sky.width;
  const Vec3 direction{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
  EXPECT_GT(dot(direction, Vec3{-0.4716, 0.6428, -0.6037}), std::cos(0.01));  // a pixel is 0.0123 wide
}

class SkyTest : public testing::TestWithParam<SunWidth> {};
INSTANTIATE_TEST_SUITE_P(Scenes, SkyTest, testing::Values(kWideSun, kSmallSun));

TEST_P(SkyTest, SunGivesTheIrradianceOfTheWideOne) {
  const Image sky = makeSky(GetParam());
  double irradiance = 0;
  for (uint32_t j = 0; j < sky.height; ++j) {
    const double theta = std::numbers::pi * (j + 0.5) / sky.height;
    for (uint32_t i = 0; i < sky.width; ++i) {
      const double above = sky.at(i, j)[0] - 0.5;  // without the sky, which is darker than 0.5
      if (above > 0)
        irradiance += above * std::sin(theta) * (std::numbers::pi / sky.height) * (2 * std::numbers::pi / sky.width);
    }
  }
  const double sigma = 4 * std::numbers::pi / 180;
  EXPECT_NEAR(irradiance, 2 * std::numbers::pi * 120 * sigma * sigma, 0.03 * 3.7);
}

TEST(Tiles, ThereAreEightByEightWithJoints) {
  const Image tiles = makeTiles();
  for (uint32_t k = 0; k < 8; ++k) {
    EXPECT_EQ(tiles.at(32 * k, 100), tiles.at(0, 0)) << "joint " << k;
    EXPECT_EQ(tiles.at(32 * k + 2, 100), tiles.at(32 * k + 31, 100)) << "tile " << k;
  }
  EXPECT_NE(tiles.at(10, 10), tiles.at(42, 10));
}

TEST(Pictures, ReflectancesStayBelowOne) {
  for (const Image& image : {makeTiles(), makeWood(), makeLandscape()}) {
    for (const Vec3& pixel : image.pixels) {
      ASSERT_GE(*std::min_element(pixel.begin(), pixel.end()), 0);
      ASSERT_LE(*std::max_element(pixel.begin(), pixel.end()), 1);
    }
  }
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Assets, AreTheSameBytesOnEveryRun) {
  const test::TemporaryFolder files;
  const std::filesystem::path& folder = files.folder();
  for (const char* name : {"sky.exr", "wood.png", "normals.png", "teapot_glass.ply"}) {
    const Asset& asset = findAsset(name);
    asset.write(folder / "first");
    asset.write(folder / "second");
    ASSERT_GT(bytesOf(folder / "first").size(), 1000u) << name;
    EXPECT_EQ(bytesOf(folder / "first"), bytesOf(folder / "second")) << name;
  }
}

TEST(Assets, AFailedWriteNamesTheFileAndLeavesNothing) {
  const test::TemporaryFolder files;
  const std::filesystem::path folder = files.folder() / "absent";
  try {
    findAsset("teapot.ply").write(folder / "teapot.ply");
    FAIL() << "expected an exception";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("teapot.ply"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Assets, UnknownNamesAreRefused) { EXPECT_THROW(findAsset("bunny.ply"), std::runtime_error); }

}  // namespace
}  // namespace wavecrest::generate
