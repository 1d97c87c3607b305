#include "bench/report/plot_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/bench/sample_report.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

TEST(PlotFiles, areOneSvgForEachSceneAndMetricInsideTheFolder) {
  const test::TemporaryFolder files;
  const fs::path& folder = files.folder();
  ConvergenceReport report = sampleReport();
  report.scenes[1].name = "../out of/here";
  const std::vector<fs::path> paths = writePlotFiles(report, folder);
  ASSERT_EQ(paths.size(), 2U * 4U);  // three metrics and the bias
  EXPECT_EQ(paths[0], folder / "cornell-spheres.rmse.svg");
  EXPECT_EQ(paths[3], folder / "cornell-spheres.bias.svg");
  EXPECT_EQ(paths[4], folder / ".._out_of_here.rmse.svg");
  for (const fs::path& path : paths) {
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(text.find("<svg "), 0U) << path;
    EXPECT_NE(text.find("class=\"line\""), std::string::npos) << path;
  }
}

TEST(PlotFiles, ofScenesOfOneNameLieApart) {
  const test::TemporaryFolder files;
  const fs::path& folder = files.folder();
  ConvergenceReport report = sampleReport();
  report.scenes.assign(4, sampleReport().scenes[0]);
  report.scenes[0].name = "a room";
  report.scenes[1].name = "a/room";
  report.scenes[2].name = "A room";
  report.scenes[3].name = "a_room.2";
  const std::vector<fs::path> paths = writePlotFiles(report, folder);
  ASSERT_EQ(paths.size(), 4U * 4U);
  EXPECT_EQ(paths[0], folder / "a_room.rmse.svg");
  EXPECT_EQ(paths[4], folder / "a_room.2.rmse.svg");
  EXPECT_EQ(paths[8], folder / "A_room.3.rmse.svg");
  EXPECT_EQ(paths[12], folder / "a_room.2.2.rmse.svg");
}

}  // namespace
}  // namespace wavecrest
