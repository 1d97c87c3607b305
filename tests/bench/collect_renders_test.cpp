// A folder of renders written here, with images whose errors are known in advance, read back as a report.
#include "bench/report/collect_renders.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr uint32_t kRenderSide = 16;

// All pixels 0.5, every second one brighter and the others darker by the deviation: RMSE against 0.5 is the deviation.
Image speckled(float deviation, uint32_t side = kRenderSide) {
  Image image{.width = side, .height = side, .channels = 3, .pixels = {}};
  for (uint32_t i = 0; i < side * side; ++i) {
    for (int c = 0; c < 3; ++c) image.pixels.push_back(0.5F + (i % 2 == 0 ? deviation : -deviation));
  }
  return image;
}

// A whole reference, as `wavecrest reference` writes it.
void writeWhole(const fs::path& file, const Image& mean) {
  const Metadata says{
      {"wavecrest:scene_hash", "00ff"}, {"wavecrest:relative_error", "0.25"}, {"wavecrest:noise_floor.rmse", "0.125"}};
  const std::array<ExrLayer, 1> layers{ExrLayer{"difference", speckled(0.1F, mean.width)}};
  writeExr(file.string(), mean, says, layers);
}

class CollectRenders : public testing::Test {
 protected:
  void SetUp() override { writeWhole(folder / "box.reference.exr", speckled(0)); }

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

  // A run without snapshots.
  void addFinal(const std::string& stem, uint64_t seed, double seconds, uint64_t iterations) {
    addRun(stem,
           {{"seed", seed}, {"render_seconds", seconds}, {"iterations", iterations}, {"snapshots", json::array()}});
    for (const char* snapshot : {".000.exr", ".001.exr"}) fs::remove(folder / (stem + snapshot));
    writeExr((folder / (stem + ".exr")).string(), speckled(0.1F));
  }

  // The text of the error that collecting ends in.
  std::string error() const {
    try {
      collectRenders(folder);
    } catch (const ResultsError& failure) {
      return failure.what();
    } catch (const ImageError& failure) {
      return failure.what();
    }
    return "none";
  }

  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.folder();
};

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

TEST_F(CollectRenders, runsThatDifferByTheSeedAreOneSeries) {
  addRun("box.pt.1");
  addRun("box.pt.2", {{"seed", 2}});
  const ReportScene scene = collectRenders(folder).scenes[0];
  ASSERT_EQ(scene.series.size(), 1U);
  ASSERT_EQ(scene.series[0].runs.size(), 2U);
  EXPECT_EQ(scene.series[0].runs[1].seed, 2U);
  EXPECT_EQ(scene.series[0].cpuSeconds, 16.0);
  EXPECT_EQ(scene.series[0].pathsPerSecond, 100.0);
  EXPECT_EQ(scene.series[0].stages.at(0).items, 20U);
}

TEST_F(CollectRenders, oneSeedTwiceIsRefused) {
  addRun("box.pt.1");
  addRun("box.pt.2");
  EXPECT_NE(error().find("box.pt.2.json: has the seed 1 and the settings of "), std::string::npos) << error();
  addRun("box.pt.2", {{"max_depth", 4}});
  EXPECT_EQ(error(), "none");
}

TEST_F(CollectRenders, runsOfOtherPathsAreNotSeedsOfOneSeries) {
  addRun("a", {{"max_depth", 64}, {"rr_depth", 5}});
  addRun("b", {{"seed", 2}, {"max_depth", 4}, {"rr_depth", 5}});
  addRun("c", {{"seed", 3}, {"max_depth", 64}, {"rr_depth", 2}});
  addRun("d", {{"method", "ppm"}, {"light_paths_per_iteration", 1024}});
  addRun("e", {{"method", "ppm"}, {"seed", 2}, {"light_paths_per_iteration", 2048}});
  const ReportScene scene = collectRenders(folder).scenes[0];
  ASSERT_EQ(scene.series.size(), 5U);
  EXPECT_EQ(scene.series[1].label, "pt max depth 4 rr depth 5");
  EXPECT_EQ(scene.series[4].label, "ppm light paths per iteration 2048");
}

TEST_F(CollectRenders, runsOfOtherSettingsOfAMethodAreNotSeedsOfOneSeries) {
  addRun("a", {{"method", "vcm"}, {"merge_vertices", "all"}});
  addRun("b", {{"method", "vcm"}, {"merge_vertices", "first"}, {"seed", 2}});
  addRun("c", {{"method", "gpt"}, {"guide", {{"target", "radiance"}, {"cells", 7}}}});
  addRun("d", {{"method", "gpt"}, {"guide", {{"target", "variance"}, {"cells", 7}}}, {"seed", 2}});
  addRun("e", {{"method", "gpt"}, {"guide", {{"target", "variance"}, {"cells", 9}}}, {"seed", 3}});
  addRun("f", {{"method", "mlt"}, {"bootstrap", 4096}, {"restart", 0}, {"direct_pass", true}});
  addRun("g", {{"method", "mlt"}, {"bootstrap", 4096}, {"restart", 9}, {"direct_pass", true}, {"seed", 2}});
  addRun("h", {{"method", "mlt"}, {"bootstrap", 8192}, {"restart", 0}, {"direct_pass", false}, {"seed", 3}});
  const ReportScene scene = collectRenders(folder).scenes[0];
  std::vector<std::string> labels;
  for (const ReportSeries& series : scene.series) labels.push_back(series.label);
  const std::vector<std::string> expected{"vcm all",
                                          "vcm first",
                                          "gpt radiance",
                                          "gpt variance",
                                          "mlt bootstrap 4096 restart 0 direct pass",
                                          "mlt bootstrap 4096 restart 9 direct pass",
                                          "mlt bootstrap 8192 restart 0 no direct pass"};
  EXPECT_EQ(labels, expected);
  EXPECT_EQ(scene.series.at(3).runs.size(), 2U);
}

TEST_F(CollectRenders, seriesOfOneMethodAreNamedByWhatDiffers) {
  addRun("a");
  addRun("b", {{"sampler", "sobol"}});
  addRun("c", {{"method", "lt"}});
  const ReportScene scene = collectRenders(folder).scenes[0];
  ASSERT_EQ(scene.series.size(), 3U);
  EXPECT_EQ(scene.series[0].label, "pt independent");
  EXPECT_EQ(scene.series[1].label, "pt sobol");
  EXPECT_EQ(scene.series[2].label, "lt");
}

// Numbers that stand for no limit of depth, in stats of earlier versions and of this one.
TEST_F(CollectRenders, runsOfUnlimitedDepthAreOneSeries) {
  addRun("a", {{"max_depth", 4095}});
  addRun("b", {{"max_depth", 1 << 24}, {"seed", 2}});
  addRun("c", {{"method", "mlt"}, {"max_depth", 4095}});
  addRun("d", {{"method", "mlt"}, {"max_depth", 64}, {"seed", 2}});
  const ConvergenceReport report = collectRenders(folder);
  const auto& series = report.scenes.at(0).series;
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[0].label, "pt");
  EXPECT_EQ(series[1].label, "mlt");
}

TEST_F(CollectRenders, runsOfOtherRadiiAndPassesAreSeriesOfTheirOwn) {
  addRun("a", {{"method", "ppm"}, {"radius", 0.001}, {"direct_pass", false}});
  addRun("b", {{"method", "ppm"}, {"radius", 0.004}, {"direct_pass", false}});
  addRun("c", {{"method", "ppm"}, {"radius", 0.004}, {"direct_pass", true}});
  addRun("d", {{"method", "ppm"}, {"radius", 0.001}, {"direct_pass", false}, {"seed", 2}});
  const ConvergenceReport report = collectRenders(folder);
  const auto& series = report.scenes.at(0).series;
  ASSERT_EQ(series.size(), 3u);
  EXPECT_EQ(series[0].label, "ppm no direct pass radius 0.001");
  EXPECT_EQ(series[0].runs.size(), 2u);
  EXPECT_EQ(series[1].label, "ppm no direct pass radius 0.004");
  EXPECT_EQ(series[2].label, "ppm direct pass radius 0.004");
}

TEST_F(CollectRenders, listedSeedsMeetAtEqualTimes) {
  for (const char* name : {"a.exr", "b.exr", "c.exr", "d.exr", "e.exr"}) {
    writeExr((folder / name).string(), speckled(0.1F));
  }
  std::ofstream(folder / "images.csv")
      << "image,seconds,method,seed\na.exr,1,x,1\nb.exr,2,x,1\nc.exr,4,x,1\nd.exr,1.02,x,2\ne.exr,3.9,x,2\n";
  const ReportSeries series = collectRenders(folder).scenes[0].series.at(0);
  ASSERT_EQ(series.runs.size(), 2U);
  const auto numbers = [](const ReportRun& run) {
    std::vector<unsigned> found;
    for (const ReportPoint& point : run.points) found.push_back(point.number);
    return found;
  };
  EXPECT_EQ(numbers(series.runs[0]), (std::vector<unsigned>{0, 1, 2}));
  EXPECT_EQ(numbers(series.runs[1]), (std::vector<unsigned>{0, 2}));
}

// As `render` without --stats leaves them: the attributes are all that tells two settings apart.
TEST_F(CollectRenders, imagesOfOtherSettingsAreNotOneRun) {
  const auto add = [&](const std::string& name, const char* seconds, Metadata says) {
    says.merge(Metadata{{"wavecrest:method", "gpt"},
                        {"wavecrest:scene", "box"},
                        {"wavecrest:scene_hash", "00ff"},
                        {"wavecrest:seed", "1"},
                        {"wavecrest:render_seconds", seconds}});
    writeExr((folder / name).string(), speckled(0.1F), says);
  };
  add("a.0001.exr", "1", {{"wavecrest:sampler", "sobol"}, {"wavecrest:guide.target", "off"}});
  add("a.exr", "2", {{"wavecrest:sampler", "sobol"}, {"wavecrest:guide.target", "off"}});
  add("b.exr", "2.5", {{"wavecrest:sampler", "independent"}, {"wavecrest:guide.target", "off"}});
  add("c.exr", "3", {{"wavecrest:sampler", "sobol"}, {"wavecrest:guide.target", "radiance"}});
  const auto labels = [](const ReportScene& scene) {
    std::vector<std::string> found;
    for (const ReportSeries& series : scene.series) {
      found.push_back(series.label + fmt::format(" {}", series.runs.at(0).points.size()));
    }
    return found;
  };
  EXPECT_EQ(labels(collectRenders(folder).scenes.at(0)),
            (std::vector<std::string>{"gpt sobol off 2", "gpt independent off 1", "gpt sobol radiance 1"}));
  // In a list that calls them alike, too.
  std::ofstream(folder / "list.csv") << "image,seconds,method\na.exr,2,x\nb.exr,2.5,x\n";
  EXPECT_EQ(labels(collectRenders(folder / "list.csv").scenes.at(0)),
            (std::vector<std::string>{"x sobol 1", "x independent 1"}));
}

TEST_F(CollectRenders, imagesOfOtherScenesAreNotOneRun) {
  for (const char* hash : {"00ff", "1234"}) {
    writeExr((folder / fmt::format("{}.exr", hash)).string(), speckled(0.1F),
             {{"wavecrest:method", "pt"},
              {"wavecrest:scene", "box"},
              {"wavecrest:scene_hash", hash},
              {"wavecrest:seed", "1"},
              {"wavecrest:render_seconds", "1"}});
  }
  EXPECT_NE(error().find("1234.exr: is of scene_hash 1234; expected 00ff"), std::string::npos) << error();
}

TEST_F(CollectRenders, listedImagesOfOneNameInSeveralFoldersAreSeveralSeries) {
  for (const char* name : {"one/path_1.exr", "one/path_2.exr", "two/path_1.exr", "light_1.exr"}) {
    fs::create_directories((folder / name).parent_path());
    writeExr((folder / name).string(), speckled(0.1F));
  }
  const auto labels = [&](const std::string& list) {
    std::ofstream(folder / "images.csv") << list;
    std::vector<std::string> found;
    for (const ReportSeries& series : collectRenders(folder).scenes.at(0).series) found.push_back(series.label);
    return found;
  };
  EXPECT_EQ(labels("one/path_1.exr,1\none/path_2.exr,2\ntwo/path_1.exr,1.3\nlight_1.exr,1\n"),
            (std::vector<std::string>{"one/path", "two/path", "light"}));
  EXPECT_EQ(labels("one/path_1.exr,1\none/path_2.exr,2\nlight_1.exr,1\n"), (std::vector<std::string>{"path", "light"}));
  EXPECT_EQ(labels("image,seconds,method\none/path_1.exr,1,a\ntwo/path_1.exr,2,a\n"), std::vector<std::string>{"a"})
      << "the list says so";
  EXPECT_EQ(labels("image,seconds,seed\none/path_1.exr,1,1\ntwo/path_1.exr,1,2\n"), std::vector<std::string>{"path"})
      << "by the seed they are two renders of one series";
}

TEST_F(CollectRenders, seedsOfOtherLengthsDoNotMeet) {
  addFinal("a", 1, 10, 100);
  addFinal("b", 2, 60, 600);
  const ConvergenceReport report = collectRenders(folder);
  const std::vector<CurvePoint> curve = meanCurve(report.scenes[0].series.at(0), 0);
  ASSERT_EQ(curve.size(), 2U);
  EXPECT_EQ(curve[0].seconds, 10);
  EXPECT_EQ(curve[1].seconds, 60);
  EXPECT_EQ(report.remarks,
            std::vector<std::string>{
                "box: runs of pt end after 10 s to 60 s; scores at the end are means over all of them."});
}

TEST_F(CollectRenders, seedsOfEqualIterationsMeetWhateverTheirTimes) {
  addFinal("a", 1, 4, 64);
  addFinal("b", 2, 5, 64);
  const ConvergenceReport report = collectRenders(folder);
  EXPECT_EQ(meanCurve(report.scenes[0].series.at(0), 0).size(), 1U);
  EXPECT_TRUE(report.remarks.empty());
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
