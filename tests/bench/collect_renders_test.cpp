// Reports of folders of renders: which files are read, what is measured and shown, and what is refused.
#include "bench/report/collect_renders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/results_folder.h"
#include "bench/report/series_values.h"
#include "bench/report/shown_metrics.h"
#include "bench/report/write_report.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"
#include "tests/bench/renders_folder.h"

namespace wavecrest {
namespace {

using test::CollectRenders;
using test::kRenderSide;
using test::speckled;
using test::writeWhole;
namespace fs = std::filesystem;
using nlohmann::json;

TEST_F(CollectRenders, measuresEverySnapshot) {
  addRun("box.pt");
  const ConvergenceReport report = collectRenders(folder);
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

TEST_F(CollectRenders, imageOfTheStatsNameIsTheLastPointIfItIsFurther) {
  addRun("box.pt", {{"iterations", 50}, {"render_seconds", 5.0}});
  writeExr((folder / "box.pt.exr").string(), speckled(0.05F));
  const auto points = collectRenders(folder).scenes[0].series[0].runs[0].points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[2].iterations, 50U);
  EXPECT_NEAR(points[2].values[0], 0.05, 1e-6);
}

TEST_F(CollectRenders, imageOfTheStatsNameIsNotCountedTwice) {
  addRun("box.pt");
  writeExr((folder / "box.pt.exr").string(), speckled(0.1F));
  EXPECT_EQ(collectRenders(folder).scenes[0].series[0].runs[0].points.size(), 2U);
}

// The metrics are those of the list that `compare` measures by default, each by its main score's name.
TEST_F(CollectRenders, measuresTheMetricsOfTheList) {
  addRun("box.pt");
  const ConvergenceReport report = collectRenders(folder);
  std::vector<std::string> expected, found;
  for (const Metric& metric : metricList())
    if (metric.byDefault) expected.push_back(scoreName(metric, metric.score));
  for (const ReportMetric& metric : report.metrics) found.push_back(metric.key);
  EXPECT_EQ(found, expected);
  const ReportPoint& point = report.scenes[0].series[0].runs[0].points[0];
  const PreparedReference reference("reference", readImage((folder / "box.reference.exr").string()));
  const ComparedImage test = reference.prepareTest("test", readImage((folder / "box.pt.000.exr").string()));
  for (size_t m = 0; m < found.size(); ++m) {
    const Metric& metric = *reportedMetrics()[m];
    if (kRenderSide < metric.smallestSide) {
      EXPECT_TRUE(std::isnan(point.values[m])) << found[m];
    } else {
      EXPECT_EQ(point.values[m], mainScore(metric, metric.measure(reference, test, false))) << found[m];
    }
  }
  EXPECT_EQ(point.further.at(0).name, "relmse_trimmed");
}

TEST_F(CollectRenders, showsTheLastImageAndItsErrorMapOnTheScenesScale) {
  addRun("a");
  addRun("b", {{"method", "lt"}});
  writeExr((folder / "b.001.exr").string(), speckled(0));
  const ReportScene scene = collectRenders(folder).scenes[0];
  const ReportSeries &noisy = scene.series[0], &perfect = scene.series[1];
  EXPECT_EQ(noisy.finalImage.width, kRenderSide);
  EXPECT_EQ(noisy.finalImage.rgb[0], srgbCode(0.6F));
  EXPECT_EQ(perfect.finalImage.rgb, scene.reference.rgb);
  // Black where nothing differs; the worst series reaches the scale's end.
  EXPECT_EQ(perfect.errorMap.rgb[0], 0);
  EXPECT_GT(*std::max_element(noisy.errorMap.rgb.begin(), noisy.errorMap.rgb.end()), 240);
  EXPECT_NE(scene.errorMapScale.find("FLIP"), std::string::npos);
}

TEST_F(CollectRenders, pixelsThatAreNotFiniteAreShownAndRemarked) {
  addRun("box.pt");
  Image image = speckled(0.1F);
  std::fill_n(image.pixels.begin(), 6, std::numeric_limits<float>::quiet_NaN());  // two pixels
  for (const char* snapshot : {"box.pt.000.exr", "box.pt.001.exr"}) writeExr((folder / snapshot).string(), image);
  const ConvergenceReport report = collectRenders(folder);
  EXPECT_EQ(report.remarks,
            std::vector<std::string>{"box: 4 pixels of images of pt are not finite; scores leave them out."});
  const ReportSeries& series = report.scenes.at(0).series.at(0);
  for (const ReportImage& shown : {series.finalImage, series.earlierImages.at(0)}) {
    ASSERT_GT(shown.rgb.size(), 6U);
    EXPECT_EQ(shown.rgb[0], 0) << "and not the reference's";
    EXPECT_EQ(shown.rgb[6], srgbCode(0.6F));
  }
}

TEST_F(CollectRenders, pixelsOfTheReferenceThatAreNotFiniteAreNoFaultOfTheRuns) {
  addRun("box.pt");
  Image mean = speckled(0);
  mean.pixels[0] = mean.pixels[3] = std::numeric_limits<float>::infinity();
  writeWhole(folder / "box.reference.exr", mean);
  const ConvergenceReport report = collectRenders(folder);
  EXPECT_EQ(report.remarks,
            std::vector<std::string>{"box: 2 pixels of the reference are not finite; scores leave them out."});
  EXPECT_EQ(report.scenes.at(0).reference.rgb.at(0), 255);
}

TEST_F(CollectRenders, meanOfTwoHalvesIsTheReferenceAndHalfTheirDifferenceItsNoise) {
  fs::remove(folder / "box.reference.exr");
  writeExr((folder / "box.reference.1.exr").string(), speckled(0.01F));
  writeExr((folder / "box.reference.2.exr").string(), speckled(-0.03F));
  addRun("box.pt");
  const ReportScene scene = collectRenders(folder).scenes[0];
  ASSERT_TRUE(scene.noiseFloors[0].has_value());
  EXPECT_NEAR(*scene.noiseFloors[0], 0.02, 1e-6);
  EXPECT_NEAR(scene.series[0].runs[0].points[0].values[0], 0.21, 1e-6);  // against 0.5 -+ 0.01
}

TEST_F(CollectRenders, aWholeReferenceBringsTheNoiseFloorsThatItStores) {
  addRun("box.pt");
  const ReportScene scene = collectRenders(folder).scenes[0];
  EXPECT_EQ(scene.noiseFloors.at(0), 0.125) << "of rmse";
  for (size_t m = 1; m < scene.noiseFloors.size(); ++m) EXPECT_FALSE(scene.noiseFloors[m].has_value());
}

TEST_F(CollectRenders, aPlainRenderIsNoReference) {
  addRun("box.pt");
  writeExr((folder / "box.reference.exr").string(), speckled(0), {{"wavecrest:scene_hash", "00ff"}});
  EXPECT_NE(error().find("box.reference.exr: is a plain image, without the two halves"), std::string::npos) << error();
}

TEST_F(CollectRenders, anotherScenesReferenceIsRefused) {
  addRun("box.pt", {{"scene_hash", "1234"}});
  EXPECT_NE(error().find("box.reference.exr: is of scene_hash 00ff; expected 1234"), std::string::npos) << error();
  fs::remove(folder / "box.reference.exr");
  writeExr((folder / "box.reference.1.exr").string(), speckled(0.01F), {{"wavecrest:scene_hash", "1234"}});
  writeExr((folder / "box.reference.2.exr").string(), speckled(-0.03F), {{"wavecrest:scene_hash", "00ff"}});
  EXPECT_NE(error().find("box.reference.2.exr: is of scene_hash 00ff; expected 1234"), std::string::npos) << error();
}

TEST_F(CollectRenders, runsOfTwoScenesOfOneNameAreRefused) {
  addRun("a");
  addRun("b", {{"seed", 2}, {"scene_hash", "00ff"}});
  addRun("c", {{"seed", 3}, {"scene_hash", "1234"}});
  EXPECT_NE(error().find("c.json: is of scene_hash 1234; expected 00ff"), std::string::npos) << error();
}

TEST_F(CollectRenders, halvesOfOneSeedAreNotIndependent) {
  addRun("box.pt");
  fs::remove(folder / "box.reference.exr");
  for (const char* name : {"box.reference.1.exr", "box.reference.2.exr"}) {
    writeExr((folder / name).string(), speckled(0), {{"wavecrest:seed", "7"}});
  }
  EXPECT_NE(error().find("box.reference.2.exr: has the seed 7 of the other half"), std::string::npos) << error();
}

TEST_F(CollectRenders, onlyTheFolderItselfIsLookedInto) {
  // The stats name an image by the absolute path where it was rendered; by now another render's lies there.
  const fs::path elsewhere = folder / "elsewhere";
  fs::create_directories(elsewhere);
  addRun("box.pt", {{"snapshots",
                     {{{"index", 0},
                       {"render_seconds", 1.0},
                       {"iterations", 10},
                       {"file", (elsewhere / "box.pt.000.exr").string()}}}}});
  writeExr((elsewhere / "box.pt.000.exr").string(), speckled(0.4F));
  const ReportScene scene = collectRenders(folder).scenes[0];
  EXPECT_NEAR(scene.series[0].runs[0].points[0].values[0], 0.2, 1e-6);
}

TEST_F(CollectRenders, errorsOfFewChainsAreRemarked) {
  addRun("a", {{"method", "mlt"}});
  addRun("b");
  const std::vector<std::string> remarks = collectRenders(folder).remarks;
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_TRUE(remarks[0].starts_with("Of mlt: errors of mlt from few renders are too small")) << remarks[0];
}

TEST_F(CollectRenders, aListOfTheCurrentFolderNeedsNoFolder) {
  writeExr((folder / "a.exr").string(), speckled(0.1F));
  std::ofstream(folder / "list.csv") << "a.exr,1\n";
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  EXPECT_NO_THROW(EXPECT_EQ(collectRenders("list.csv").scenes.at(0).name, "box"));
  fs::current_path(before);
}

TEST_F(CollectRenders, statsOfAReferenceAreNoRun) {
  addRun("box.pt");
  std::ofstream(folder / "box.reference.json") << "{}";
  EXPECT_EQ(collectRenders(folder).scenes[0].series.size(), 1U);
}

TEST_F(CollectRenders, writesThePageIntoTheFolder) {
  addRun("box.pt");
  const std::vector<fs::path> folders{folder};
  EXPECT_EQ(writeReport(folders).files, (std::vector<fs::path>{folder / "report.html"}));
  EXPECT_GT(fs::file_size(folder / "report.html"), 10000U);
  const std::vector<fs::path> files = writeReport(folders, {.csv = true, .plots = true}).files;
  ASSERT_EQ(files.size(), 5 + collectRenders(folder).metrics.size());
  EXPECT_EQ(files[1], folder / "measurements.csv");
  EXPECT_EQ(files[2], folder / "summary.csv");
  EXPECT_EQ(files[3], folder / "times.csv");
  EXPECT_EQ(files[4], folder / "claims.csv");
  EXPECT_EQ(files[5], folder / "plots" / "box.rmse.svg");
  for (const fs::path& file : files) EXPECT_TRUE(fs::is_regular_file(file)) << file;
}

TEST_F(CollectRenders, errorsNameTheFileAndWhatWasExpected) {
  EXPECT_NE(error().find("holds nothing to report; expected"), std::string::npos) << error();

  addRun("box.pt");
  fs::remove(folder / "box.reference.exr");
  EXPECT_NE(error().find("no reference for 'box'; expected box.reference.exr"), std::string::npos) << error();

  writeWhole(folder / "box.reference.exr", speckled(0, 12));
  EXPECT_NE(error().find("box.pt.000.exr: image of 16x16 pixels; expected 12x12 as in"), std::string::npos) << error();

  fs::remove(folder / "box.pt.001.exr");
  EXPECT_NE(error().find("snapshot 'gone/box.pt.001.exr' does not exist; expected"), std::string::npos) << error();
}

TEST_F(CollectRenders, malformedStatsAreRefusedWithTheirName) {
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

TEST_F(CollectRenders, aFolderThatIsNotThereIsRefused) {
  fs::remove_all(folder);
  EXPECT_NE(error().find("is not a folder"), std::string::npos) << error();
}

}  // namespace
}  // namespace wavecrest
