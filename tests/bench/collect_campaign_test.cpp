// A results file written by the campaign's own store, read back as a report.
#include "bench/report/collect_campaign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/claims/explanations.h"
#include "bench/report/collect.h"
#include "bench/report/results_folder.h"
#include "bench/report/series_values.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "metrics/image/image_io.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kSide = 20;

Image grey(float value) {
  return {.width = kSide, .height = kSide, .channels = 3, .pixels = std::vector<float>(3 * kSide * kSide, value)};
}

class CollectCampaign : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder / "images");
    writeExr((folder / "images/box.exr").string(), grey(0.5F),
             {{"wavecrest:method", "bpt"}, {"wavecrest:relative_error", "0.0123"}});
    writeExr((folder / "images/last.exr").string(), grey(0.6F));
  }

  // Two snapshots; the second has the image.
  static RunRecord run(const std::string& method, uint64_t seed, double last) {
    RunRecord record{.scene = "box", .method = method, .seed = seed};
    record.stats = R"({"paths_per_second": 1e6, "cpu_seconds": 8, "sampler": "independent", "seed": )" +
                   std::to_string(seed) + "}";
    record.stages = {{.name = "extend", .items = 100, .seconds = 2}};
    record.snapshots = {{.number = 0,
                         .renderSeconds = 1,
                         .iterations = 10,
                         .file = "images/none.exr",
                         .values = {{"rmse", 2 * last}, {"ssim", 0.5}, {"ssim_r", 0.4}}},
                        {.number = 1,
                         .renderSeconds = 4.0 + 0.1 * static_cast<double>(seed),
                         .iterations = 40,
                         .file = "images/last.exr",
                         .values = {{"rmse", last}, {"ssim", 0.9}, {"ssim_r", 0.8}}}};
    return record;
  }

  void writeStore(const std::string& name, const std::vector<RunRecord>& runs) const {
    ResultsStore store(folder / name);
    store.putCampaign({{"profile", "quick"}, {"cpu", "a processor"}, {"seeds", "2"}});
    store.putScene({.name = "box",
                    .hash = "1234",
                    .referenceFile = "images/box.exr",
                    .width = kSide,
                    .height = kSide,
                    .noiseFloors = {{"rmse", 0.01}},
                    .pathClasses = {{"LDE", "pt", "sampled"},
                                    {"LDE", "lt", "sampled"},
                                    {"LSDE", "pt", "impossible"},
                                    {"LSDE", "lt", "sampled"}}});
    for (const RunRecord& record : runs) store.putRun(record);
    store.putBiases({{.scene = "box",
                      .method = "pt",
                      .number = 1,
                      .seeds = 2,
                      .meanSquareError = 0.04,
                      .variance = 0.03,
                      .biasSquared = 0.01}});
    store.putClaims({{.id = "a", .scene = "box", .statement = "pt is best", .verdict = "holds", .evidence = "0.1"}});
  }

  ConvergenceReport collect() const { return collectReport(std::vector<fs::path>{folder}); }

  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.folder();
};

TEST_F(CollectCampaign, gathersSeedsIntoSeriesByMethod) {
  writeStore("results.sqlite", {run("pt", 1, 0.2), run("lt", 1, 0.4), run("pt", 2, 0.3)});
  const ConvergenceReport report = collect();
  EXPECT_EQ(report.title, "Convergence of box, profile quick");
  ASSERT_EQ(report.scenes.size(), 1U);
  const ReportScene& scene = report.scenes[0];
  ASSERT_EQ(scene.series.size(), 2U);
  const ReportSeries& pt = scene.series[0];
  EXPECT_EQ(pt.label, "pt");
  ASSERT_EQ(pt.runs.size(), 2U);
  EXPECT_EQ(pt.runs[1].seed, 2U);
  EXPECT_EQ(pt.runs[1].points[1].iterations, 40U);
  EXPECT_DOUBLE_EQ(pt.runs[1].points[1].seconds, 4.2);
  EXPECT_DOUBLE_EQ(pt.pathsPerSecond, 1e6);
  EXPECT_DOUBLE_EQ(pt.cpuSeconds, 16);
  EXPECT_EQ(pt.stages.at(0).items, 200U);
}

// Results files may come from others.
TEST_F(CollectCampaign, namesOfMethodsAddNoRulesToTheStyleSheet) {
  const std::string name = "x{}*{background:url(https://h/)}";
  writeStore("results.sqlite", {run(name, 1, 0.2)});
  const ConvergenceReport report = collect();
  EXPECT_EQ(report.scenes.at(0).series.at(0).label, name);
  EXPECT_EQ(coloursOfOthers(report), ".m-x----background-url-https---h--- { color: var(--x0); }\n");
}

TEST_F(CollectCampaign, leavesOutSnapshotsBeforeTheFirstWholeImage) {
  RunRecord record = run("pt", 1, 0.2);
  record.snapshots[0].iterations = 0;
  writeStore("results.sqlite", {record});
  const ConvergenceReport report = collect();
  const ReportRun& shown = report.scenes.at(0).series.at(0).runs.at(0);
  ASSERT_EQ(shown.points.size(), 1U);
  EXPECT_EQ(shown.points[0].number, 1U);
}

TEST_F(CollectCampaign, showsMainScoresInTheOrderOfTheMetricListAndKeepsTheOthers) {
  writeStore("results.sqlite", {run("pt", 1, 0.2)});
  const ConvergenceReport report = collect();
  ASSERT_EQ(report.metrics.size(), 2U) << "only what was measured";
  EXPECT_EQ(report.metrics[0].key, "rmse");
  EXPECT_EQ(report.metrics[1].key, "ssim");
  EXPECT_EQ(report.metrics[1].target, 0.95);
  const ReportPoint& point = report.scenes[0].series[0].runs[0].points[1];
  EXPECT_EQ(point.values, (std::vector<double>{0.2, 0.9}));
  ASSERT_EQ(point.further.size(), 1U);
  EXPECT_EQ(point.further[0].name, "ssim_r");
  EXPECT_EQ(report.scenes[0].noiseFloors[0], 0.01);
  EXPECT_FALSE(report.scenes[0].noiseFloors[1].has_value());
}

TEST_F(CollectCampaign, readsTheLastImagesAndTheReferencesOrigin) {
  writeStore("results.sqlite", {run("pt", 1, 0.2)});
  const ReportScene scene = collect().scenes[0];
  EXPECT_EQ(scene.referenceOrigin, "box.exr, two halves by bpt, off by about 1.2 % of a sample's value");
  EXPECT_EQ(scene.reference.rgb.size(), 3U * kSide * kSide);
  EXPECT_EQ(scene.series[0].finalImage.label, "pt, 4.1 s");
  EXPECT_FALSE(scene.series[0].errorMap.rgb.empty());
}

TEST_F(CollectCampaign, resultsWithoutTheirImagesAreReportedWithARemark) {
  writeStore("results.sqlite", {run("pt", 1, 0.2)});
  fs::remove(folder / "images/last.exr");
  ConvergenceReport report = collect();
  EXPECT_TRUE(report.scenes[0].series[0].finalImage.rgb.empty());
  ASSERT_EQ(report.remarks.size(), 1U);
  fs::remove(folder / "images/box.exr");
  report = collect();
  EXPECT_TRUE(report.scenes[0].reference.rgb.empty());
  EXPECT_NE(report.remarks.at(0).find("no pictures"), std::string::npos);
}

TEST_F(CollectCampaign, runsOfUnequalTimeAreRemarked) {
  RunRecord brief = run("pt", 1, 0.2), longer = run("lt", 1, 0.3);
  brief.stats = R"({"asked_seconds": 12})";
  longer.stats = R"({"asked_seconds": 24})";
  writeStore("results.sqlite", {brief, longer});
  const ConvergenceReport report = collect();
  const auto speaksOf = [](const std::string& remark) { return remark.find("12 s and of 24 s") != std::string::npos; };
  EXPECT_EQ(std::count_if(report.remarks.begin(), report.remarks.end(), speaksOf), 1);
}

TEST_F(CollectCampaign, errorsOfFewChainsAreRemarkedOnce) {
  const auto remarks = [&](const std::string& name, uint64_t seeds) {
    std::vector<RunRecord> runs;
    for (uint64_t seed = 1; seed <= seeds; ++seed) {
      runs.push_back(run("mlt-pathspace", seed, 0.2));
      runs.push_back(run("mlt", seed, 0.2));
    }
    writeStore(name, runs);
    const ConvergenceReport report = collectReport(std::vector<fs::path>{folder / name});
    return std::ranges::count_if(report.remarks, [](const std::string& remark) {
      return remark.starts_with("Of mlt: errors of mlt from few renders are too small");
    });
  };
  EXPECT_EQ(remarks("one.sqlite", 1), 1);
  EXPECT_EQ(remarks("few.sqlite", 15), 1);
  EXPECT_EQ(remarks("enough.sqlite", 16), 0);
}

TEST_F(CollectCampaign, carriesBiasPathClassesClaimsAndRefusals) {
  RunRecord refused{.scene = "box", .method = "ppm", .seed = 1, .state = RunState::refused, .reason = "no lights"};
  writeStore("results.sqlite", {run("pt", 1, 0.2), run("pt", 2, 0.2), refused});
  const ConvergenceReport report = collect();
  const ReportScene& scene = report.scenes[0];
  ASSERT_EQ(scene.series.size(), 1U);
  ASSERT_EQ(scene.series[0].bias.size(), 1U);
  EXPECT_NEAR(scene.series[0].bias[0].seconds, 4.15, 1e-12) << "mean time of the snapshot over seeds";
  EXPECT_EQ(scene.series[0].bias[0].bias2, 0.01);
  ASSERT_EQ(scene.pathClasses.size(), 2U);
  EXPECT_EQ(scene.pathClasses[1].name, "LSDE");
  EXPECT_EQ(scene.pathClasses[1].verdicts.at(0).value, "impossible");
  ASSERT_EQ(scene.refusals.size(), 1U);
  EXPECT_EQ(scene.refusals[0].value, "no lights");
  EXPECT_EQ(report.claims.at(0).verdict, "holds");
  EXPECT_TRUE(std::any_of(report.environment.begin(), report.environment.end(),
                          [](const NamedValue& entry) { return entry.name == "cpu" && entry.value == "a processor"; }));
}

TEST_F(CollectCampaign, severalFilesAreThePartsOfOneCampaign) {
  writeStore("a.sqlite", {run("pt", 1, 0.2)});
  writeStore("b.sqlite", {run("pt", 2, 0.3), run("lt", 1, 0.3)});
  const std::vector<fs::path> parts{folder / "a.sqlite", folder / "b.sqlite"};
  const ReportScene scene = collectReport(parts).scenes.at(0);
  ASSERT_EQ(scene.series.size(), 2U);
  EXPECT_EQ(scene.series[0].runs.size(), 2U);
}

// No shard could judge the study's findings; the report over all of them does.
TEST_F(CollectCampaign, findingsAreJudgedOverAllParts) {
  const std::vector<fs::path> parts{folder / "a.sqlite", folder / "b.sqlite"};
  for (size_t part = 0; part < parts.size(); ++part) {
    ResultsStore store(parts[part]);
    store.putCampaign({{"time", "4"}});
    store.putScene({.name = "cornell-diffuse", .hash = "1", .referenceFile = "", .width = kSide, .height = kSide});
    RunRecord record = run("pt", 1 + part, 0.2);
    record.scene = "cornell-diffuse";
    store.putRun(record);
  }
  const ConvergenceReport report = collectReport(parts);
  EXPECT_GT(report.claims.size(), 1U);
  for (const ReportClaim& claim : report.claims) {
    EXPECT_TRUE(claim.scene == "cornell-diffuse" || claim.scene == "general") << claim.scene;
    EXPECT_FALSE(claim.source.empty()) << "the study's words come with it";
  }
}

TEST_F(CollectCampaign, explanationsOfTheStandardCampaignSayThatElsewhere) {
  const Explanation* const own = findExplanation("cornell-mirror.pt-loses-lead", "does not hold", "standard");
  ASSERT_NE(own, nullptr);
  const auto explanation = [&](const std::string& profile, const std::string& verdict, const std::string& commit) {
    const fs::path file = folder / (profile + verdict + commit + ".sqlite");
    ResultsStore store(file);
    store.putCampaign({{"profile", profile}, {"commit", commit}});
    store.putScene({.name = "box", .hash = "1", .referenceFile = "", .width = kSide, .height = kSide});
    store.putRun(run("pt", 1, 0.2));
    store.putClaims({{"cornell-mirror.pt-loses-lead", "box", "a", verdict, "0.1", "0.1"}});
    return collectReport(std::vector<fs::path>{file}).claims.at(0).explanation;
  };
  EXPECT_EQ(explanation("standard", "does not hold", own->commit), own->text);
  const std::string elsewhere = "In the standard campaign of commit " + own->commit + ": " + own->text;
  EXPECT_EQ(explanation("quick", "does not hold", own->commit), elsewhere);
  EXPECT_EQ(explanation("standard", "does not hold", "0"), elsewhere) << "another program";
  EXPECT_EQ(explanation("standard", "not reached in this time", own->commit), "") << "it explains another verdict";
  EXPECT_EQ(explanation("quick", "holds", own->commit), "");
  EXPECT_EQ(explanation("quick", "not judged", own->commit), "");
}

TEST_F(CollectCampaign, refusesResultsWithoutAMeasurement) {
  writeStore("results.sqlite", {});
  EXPECT_THROW(collect(), ResultsError);
}

}  // namespace
}  // namespace wavecrest
