// Which renders of a folder are runs of one series, how series are named, and where their runs meet.
#include "bench/report/run_series.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/collect_renders.h"
#include "bench/report/series_values.h"
#include "metrics/image/image_io.h"
#include "tests/bench/renders_folder.h"

namespace wavecrest {
namespace {

using test::CollectRenders;
using test::speckled;
namespace fs = std::filesystem;

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

}  // namespace
}  // namespace wavecrest
