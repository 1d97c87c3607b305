#include "bench/report/csv.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

}  // namespace
}  // namespace wavecrest
