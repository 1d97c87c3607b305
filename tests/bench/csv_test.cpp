#include "bench/report/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

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

}  // namespace
}  // namespace wavecrest
