#include "bench/report/csv.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "bench/report/series_values.h"
#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

TEST(Csv, hasALineForEachScoreOfEachSnapshot) {
  const std::string csv = measurementsAsCsv(sampleReport());
  // Four series of two runs of nine snapshots, each with three metrics and one further score; and the header.
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4 * 2 * 9 * 4 + 1);
  EXPECT_EQ(csv.find("scene,method,series,seed,snapshot,seconds,iterations,metric,value\n"), 0U);
}

TEST(Csv, keepsAllDigitsAndLeavesOutWhatIsNoNumber) {
  ConvergenceReport report = sampleReport();
  ReportPoint& point = report.scenes[0].series[1].runs[1].points[0];
  point.seconds = 0.1;
  point.values = {0.1 + 0.2, std::numeric_limits<double>::quiet_NaN(), 1};
  const std::string csv = measurementsAsCsv(report);
  EXPECT_NE(csv.find("cornell-spheres,bpt,bpt,2,0,0.1,3,rmse,0.30000000000000004\n"), std::string::npos);
  EXPECT_NE(csv.find("cornell-spheres,bpt,bpt,2,0,0.1,3,relmse,\n"), std::string::npos);
  EXPECT_NE(csv.find("cornell-spheres,bpt,bpt,2,0,0.1,3,ssim_r,0.5\n"), std::string::npos);
}

TEST(Csv, quotesNamesThatWouldBeMisread) {
  ConvergenceReport report = sampleReport();
  report.scenes[0].name = "a \"box\", big";
  EXPECT_NE(measurementsAsCsv(report).find("\n\"a \"\"box\"\", big\",pt,"), std::string::npos);
}

TEST(Csv, holdsNoFormulas) {
  for (const std::string name : {"=cmd|' /C calc'!A0", "+1", "-1", "@SUM(1)", "\t=1"}) {
    ConvergenceReport report = sampleReport();
    report.scenes[0].name = name;
    EXPECT_NE(measurementsAsCsv(report).find("\n'" + name + ",pt,"), std::string::npos) << name;
    report.scenes[0].name = name + ",";
    EXPECT_NE(measurementsAsCsv(report).find("\n\"'" + name + ",\",pt,"), std::string::npos) << name;
  }
}

TEST(Csv, summaryHasEachSeriesAtItsEnd) {
  ConvergenceReport report = sampleReport();
  ReportScene& scene = report.scenes[0];
  scene.noiseFloors = {0.01, std::nullopt, std::nullopt};
  for (size_t i = 0; i < 2; ++i) scene.series[1].runs[i].points.back().values[0] = 0.25 + 0.5 * static_cast<double>(i);
  const std::string csv = summaryAsCsv(report);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4 * 3 + 1);
  EXPECT_NE(csv.find("cornell-spheres,bpt,bpt,2,rmse,0.5,0.25,0.75,0.01,,,,,\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("ssim,"), std::string::npos);
}

TEST(Csv, findingsComeWithTheirExplanations) {
  ConvergenceReport report = sampleReport();
  report.claims.resize(1);
  report.claims[0] = {.scene = "box",
                      .statement = "a, b",
                      .verdict = "undecided",
                      .figure = "f",
                      .evidence = "c",
                      .explanation = "d",
                      .id = "e"};
  EXPECT_EQ(claimsAsCsv(report).substr(claimsAsCsv(report).find('\n')), "\ne,box,\"a, b\",,undecided,f,d,c\n");
  report.claims[0].explainedHere = false;
  EXPECT_EQ(claimsAsCsv(report).substr(claimsAsCsv(report).find('\n')), "\ne,box,\"a, b\",,undecided,f,,c\n");
}

TEST(Csv, summaryHasTheTimeToATarget) {
  ConvergenceReport report = sampleReport();
  report.metrics[0].target = 1e9;  // of a metric where less is better: reached by the first snapshot
  const double first = meanCurve(report.scenes[0].series[0], 0).front().seconds;
  EXPECT_NE(summaryAsCsv(report).find(fmt::format(",1000000000,{},yes,\n", first)), std::string::npos)
      << summaryAsCsv(report);
  report.metrics[0].target = -1;
  EXPECT_NE(summaryAsCsv(report).find(",-1,,,\n"), std::string::npos) << "never";
}

// The cells of the first line of a table that begins like this; none where no line does.
std::vector<std::string> cells(const std::string& csv, const std::string& start) {
  const size_t at = csv.find("\n" + start);
  std::vector<std::string> found;
  if (at == std::string::npos) return found;
  std::istringstream line(csv.substr(at + 1, csv.find('\n', at + 1) - at - 1) + ",");
  for (std::string cell; std::getline(line, cell, ',');) found.push_back(cell);
  return found;
}

TEST(Csv, timesAreThoseOfTheCurveAndBeyondItsEndThoseAtItsRate) {
  // 1 - SSIM is 0.3 / sqrt(t), up to 16 s: 0.1 after 9 s, 0.05 after 36 s. The runs of bpt have 0.9 from their first
  // snapshot on.
  ConvergenceReport report;
  report.metrics = {{.key = "ssim", .name = "SSIM", .higherIsBetter = true, .logarithmic = false, .best = 1}};
  ReportScene& scene = report.scenes.emplace_back();
  scene.name = "box";
  scene.noiseFloors = {0.99};
  for (const auto& [method, scale] : {std::pair{"pt", 0.3}, {"bpt", 0.09}}) {
    ReportSeries& series = scene.series.emplace_back();
    series.method = series.label = method;
    ReportRun& run = series.runs.emplace_back();
    for (const double seconds : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      const auto number = static_cast<unsigned>(run.points.size());
      run.points.push_back({.number = number, .seconds = seconds, .values = {1 - scale / std::sqrt(seconds)}});
    }
  }
  const std::string csv = timesAsCsv(report);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 2) << "no Q_MOS was measured\n" << csv;
  const std::vector<std::string> there = cells(csv, "box,pt,pt,ssim,0.9,"), ahead = cells(csv, "box,pt,pt,ssim,0.95,");
  ASSERT_EQ(there.size(), 11U) << csv;
  ASSERT_EQ(ahead.size(), 11U) << csv;
  EXPECT_NEAR(std::stod(there[5]), 9, 0.3);
  EXPECT_EQ(there[6] + there[7] + there[8] + there[9] + there[10], "");
  EXPECT_EQ(ahead[5] + ahead[6] + ahead[10], "");
  EXPECT_NEAR(std::stod(ahead[7]), 36, 0.01);
  EXPECT_NEAR(std::stod(ahead[8]), std::max(16.0, 36 / std::pow(36 / 16.0, 0.75)), 0.01);
  EXPECT_NEAR(std::stod(ahead[9]), 36 * std::pow(36 / 16.0, 0.75), 0.01);
  EXPECT_NE(csv.find("\nbox,bpt,bpt,ssim,0.9,1,yes,,,,\n"), std::string::npos) << csv;

  scene.noiseFloors = {0.97};  // more than half of the loss at 0.95 is that of the reference's noise
  EXPECT_NE(timesAsCsv(report).find("\nbox,pt,pt,ssim,0.95,,,,,,yes\n"), std::string::npos) << timesAsCsv(report);
}

}  // namespace
}  // namespace wavecrest
