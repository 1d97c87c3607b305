// Reading and preparing the dragon's scan, on small files of the same form.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scenes/generate/assets.h"
#include "scenes/generate/dragon.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest::generate {
namespace {

class DragonScan : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return files_.write("scan", text); }

  void expectRefused(const std::string& text, const std::string& reason) {
    try {
      readScan(write(text));
      FAIL() << "expected an exception for " << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(files_.path("scan")), std::string::npos) << error.what();
    }
  }

 private:
  const test::TemporaryFolder files_;
};

const std::string kHeader =
    "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(DragonScan, IsReadAsWritten) {
  const Mesh scan = readScan(write(kHeader + "0 1 2 \n-0.5 1e-2 3 \n7 8 9\n4 5 6\n3 3 1 0 \n"));
  ASSERT_EQ(scan.positions.size(), 4u);
  EXPECT_EQ(scan.positions[1], (Vec3{-0.5, 0.01, 3}));
  ASSERT_EQ(scan.triangles.size(), 1u);
  EXPECT_EQ(scan.triangles[0], (std::array<uint32_t, 3>{3, 1, 0}));
}

TEST_F(DragonScan, DamagedFilesAreRefused) {
  expectRefused("", "end_header");
  expectRefused("solid\n", "'ply'");
  expectRefused(kHeader + "0 1 2\n", "a number");
  expectRefused(kHeader + "0 1 2\n3 4 5\n6 7 8\n1 1 x\n3 0 1 2\n", "a number");
  expectRefused(kHeader + "0 1 2\n3 4 5\n6 7 8\n1 1 1\n4 0 1 2 3\n", "triangles");
  expectRefused(kHeader + "0 1 2\n3 4 5\n6 7 8\n1 1 1\n3 0 1 4\n", "below 4");
  expectRefused("ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n", "as many elements");
}

TEST_F(DragonScan, PreparingDropsUnusedVerticesMovesAndScales) {
  Mesh scan;
  scan.positions = {{5, 5, 5}, {-0.0059, 0.0527, -0.0046}, {-0.0059, 0.0527, 0.0954}, {0.0941, 0.0527, -0.0046}};
  scan.triangles = {{1, 2, 3}};
  const Mesh dragon = prepareDragon(scan);
  ASSERT_EQ(dragon.positions.size(), 3u);
  const Vec3 expected[] = {{0, 0.002, 0}, {0, 0.002, 1}, {1, 0.002, 0}};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(length(dragon.positions[i] - expected[i]), 1e-12);
    EXPECT_LT(length(dragon.normals[i] - Vec3{0, 1, 0}), 1e-12);
  }
}

TEST_F(DragonScan, LargerTrianglesWeighMoreInANormal) {
  Mesh scan;  // two triangles at a right angle that share an edge along x; the one facing z is three times as large
  scan.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0, -0.1}, {0, 0.3, 0}};
  scan.triangles = {{0, 1, 2}, {0, 1, 3}};
  const Vec3 normal = prepareDragon(scan).normals[0];
  EXPECT_NEAR(normal[2] / normal[1], 3, 1e-9);
}

TEST(Dragon, AbsentScanSaysHowToGetIt) {
  const test::TemporaryFolder files;
  try {
    findAsset("dragon_res2.ply").write(files.path("dragon_res2.ply"));
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("scenes/fetch-dragon"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wavecrest::generate
