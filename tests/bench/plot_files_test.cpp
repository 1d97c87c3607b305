#include "bench/report/plot_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

TEST(PlotFiles, areOneSvgForEachSceneAndMetricInsideTheFolder) {
  const fs::path folder = fs::path(testing::TempDir()) / "wavecrest_plot_files";
  fs::remove_all(folder);
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
  fs::remove_all(folder);
}

}  // namespace
}  // namespace wavecrest
