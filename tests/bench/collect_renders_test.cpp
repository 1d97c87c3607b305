// A results folder written here, with images whose errors are known in advance, read back as a report.
#include "bench/report/collect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/report/results_folder.h"
#include "bench/report/write_report.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr uint32_t kSide = 16;

// All pixels 0.5, every second one brighter and the others darker by the deviation: RMSE against 0.5 is the deviation.
Image speckled(float deviation, uint32_t side = kSide) {
  Image image{.width = side, .height = side, .channels = 3, .pixels = {}};
  for (uint32_t i = 0; i < side * side; ++i) {
    for (int c = 0; c < 3; ++c) image.pixels.push_back(0.5F + (i % 2 == 0 ? deviation : -deviation));
  }
  return image;
}

class CollectReport : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("wavecrest_collect_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    writeExr((folder / "box.reference.exr").string(), speckled(0));
  }
  void TearDown() override { fs::remove_all(folder); }

  // A run of two snapshots, of error 0.2 and 0.1, and no final image.
  json addRun(const std::string& stem, const json& changes = json::object()) {
    writeExr((folder / (stem + ".000.exr")).string(), speckled(0.2F));
    writeExr((folder / (stem + ".001.exr")).string(), speckled(0.1F));
    json stats = {
        {"scene", "some/where/box.xml"},
        {"method", "pt"},
        {"seed", 1},
        {"sampler", "independent"},
        {"precision", "float"},
        {"iterations", 40},
        {"render_seconds", 4.0},
        {"cpu_seconds", 8.0},
        {"paths_per_second", 100.0},
        {"isa", "avx2"},
        {"stages", {{{"name", "extend"}, {"items", 10}, {"seconds", 1.5}}}},
        {"snapshots",
         {{{"index", 0}, {"render_seconds", 1.0}, {"iterations", 10}, {"file", stem + ".000.exr"}},
          {{"index", 1}, {"render_seconds", 4.0}, {"iterations", 40}, {"file", "gone/" + stem + ".001.exr"}}}}};
    stats.update(changes);
    std::ofstream(folder / (stem + ".json")) << stats;
    return stats;
  }

  // The text of the error that collecting ends in.
  std::string error() const {
    try {
      collectReport(folder);
    } catch (const ResultsError& failure) {
      return failure.what();
    }
    return "none";
  }

  fs::path folder;
};

TEST_F(CollectReport, measuresEverySnapshot) {
  addRun("box.pt");
  const ConvergenceReport report = collectReport(folder);
  ASSERT_EQ(report.scenes.size(), 1U);
  EXPECT_EQ(report.scenes[0].name, "box");
  ASSERT_EQ(report.metrics[0].key, "rmse");
  const auto& points = report.scenes[0].series.at(0).runs.at(0).points;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].seconds, 1.0);
  EXPECT_EQ(points[1].iterations, 40U);
  EXPECT_NEAR(points[0].values[0], 0.2, 1e-6);  // 0.5 +- 0.2 in float
  EXPECT_NEAR(points[1].values[0], 0.1, 1e-6);
}

TEST_F(CollectReport, imageOfTheStatsNameIsTheLastPointIfItIsFurther) {
  addRun("box.pt", {{"iterations", 50}, {"render_seconds", 5.0}});
  writeExr((folder / "box.pt.exr").string(), speckled(0.05F));
  const auto points = collectReport(folder).scenes[0].series[0].runs[0].points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[2].iterations, 50U);
  EXPECT_NEAR(points[2].values[0], 0.05, 1e-6);
}

TEST_F(CollectReport, imageOfTheStatsNameIsNotCountedTwice) {
  addRun("box.pt");
  writeExr((folder / "box.pt.exr").string(), speckled(0.1F));
  EXPECT_EQ(collectReport(folder).scenes[0].series[0].runs[0].points.size(), 2U);
}

TEST_F(CollectReport, meanOfTwoHalvesIsTheReferenceAndHalfTheirDifferenceItsNoise) {
  fs::remove(folder / "box.reference.exr");
  writeExr((folder / "box.reference.1.exr").string(), speckled(0.01F));
  writeExr((folder / "box.reference.2.exr").string(), speckled(-0.03F));
  addRun("box.pt");
  const ReportScene scene = collectReport(folder).scenes[0];
  ASSERT_TRUE(scene.noiseFloors[0].has_value());
  EXPECT_NEAR(*scene.noiseFloors[0], 0.02, 1e-6);
  EXPECT_NEAR(scene.series[0].runs[0].points[0].values[0], 0.21, 1e-6);  // against 0.5 -+ 0.01
}

TEST_F(CollectReport, aSingleReferenceHasNoKnownNoise) {
  addRun("box.pt");
  for (const auto& floor : collectReport(folder).scenes[0].noiseFloors) EXPECT_FALSE(floor.has_value());
}

TEST_F(CollectReport, runsThatDifferByTheSeedAreOneSeries) {
  addRun("box.pt.1");
  addRun("box.pt.2", {{"seed", 2}});
  const ReportScene scene = collectReport(folder).scenes[0];
  ASSERT_EQ(scene.series.size(), 1U);
  ASSERT_EQ(scene.series[0].runs.size(), 2U);
  EXPECT_EQ(scene.series[0].runs[1].seed, 2U);
  EXPECT_EQ(scene.series[0].cpuSeconds, 16.0);
  EXPECT_EQ(scene.series[0].pathsPerSecond, 100.0);
  EXPECT_EQ(scene.series[0].stages.at(0).items, 20U);
}

TEST_F(CollectReport, seriesOfOneMethodAreNamedByWhatDiffers) {
  addRun("a");
  addRun("b", {{"sampler", "sobol"}});
  addRun("c", {{"method", "lt"}});
  const ReportScene scene = collectReport(folder).scenes[0];
  ASSERT_EQ(scene.series.size(), 3U);
  EXPECT_EQ(scene.series[0].label, "pt independent");
  EXPECT_EQ(scene.series[1].label, "pt sobol");
  EXPECT_EQ(scene.series[2].label, "lt");
}

TEST_F(CollectReport, statsOfAReferenceAreNoRun) {
  addRun("box.pt");
  std::ofstream(folder / "box.reference.json") << "{}";
  EXPECT_EQ(collectReport(folder).scenes[0].series.size(), 1U);
}

TEST_F(CollectReport, writesThePageIntoTheFolder) {
  addRun("box.pt");
  const fs::path page = writeReport(folder);
  EXPECT_EQ(page, folder / "report.html");
  EXPECT_GT(fs::file_size(page), 10000U);
}

TEST_F(CollectReport, errorsNameTheFileAndWhatWasExpected) {
  EXPECT_NE(error().find("holds no stats file; expected"), std::string::npos) << error();

  addRun("box.pt");
  fs::remove(folder / "box.reference.exr");
  EXPECT_NE(error().find("no reference for 'box'; expected box.reference.exr"), std::string::npos) << error();

  writeExr((folder / "box.reference.exr").string(), speckled(0, 12));
  EXPECT_NE(error().find("box.pt.000.exr: 16 x 16 pixels; expected 12 x 12"), std::string::npos) << error();

  fs::remove(folder / "box.pt.001.exr");
  EXPECT_NE(error().find("snapshot 'gone/box.pt.001.exr' does not exist; expected"), std::string::npos) << error();
}

TEST_F(CollectReport, malformedStatsAreRefusedWithTheirName) {
  std::ofstream(folder / "bad.json") << "{\"scene\": ";
  EXPECT_NE(error().find("bad.json: is not JSON"), std::string::npos) << error();
  std::ofstream(folder / "bad.json") << "[1, 2]";
  EXPECT_NE(error().find("bad.json: is not an object"), std::string::npos) << error();
  std::ofstream(folder / "bad.json") << "{\"scene\": 3}";
  EXPECT_NE(error().find("bad.json: 'scene' is 3; expected"), std::string::npos) << error();
  std::ofstream(folder / "bad.json") << "{\"scene\": \"box\"}";
  EXPECT_NE(error().find("bad.json: has no 'method'; expected"), std::string::npos) << error();
  addRun("bad", {{"snapshots", {1}}});
  EXPECT_NE(error().find("bad.json: a snapshot is 1; expected"), std::string::npos) << error();
  addRun("bad", {{"snapshots", json::array()}});
  EXPECT_NE(error().find("bad.json: has no snapshot and no final image"), std::string::npos) << error();
}

TEST_F(CollectReport, aFolderThatIsNotThereIsRefused) {
  fs::remove_all(folder);
  EXPECT_NE(error().find("is not a folder"), std::string::npos) << error();
}

}  // namespace
}  // namespace wavecrest
