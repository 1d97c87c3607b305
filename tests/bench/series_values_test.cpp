#include "bench/report/series_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Runs of one metric from (seconds, value) pairs.
ReportSeries seriesOf(const std::vector<std::vector<std::pair<double, double>>>& runs) {
  ReportSeries series;
  series.method = series.label = "pt";
  for (const auto& points : runs) {
    ReportRun run;
    for (const auto& [seconds, value] : points) {
      const auto number = static_cast<unsigned>(run.points.size());
      run.points.push_back({.number = number, .seconds = seconds, .iterations = 10, .values = {value}});
    }
    series.runs.push_back(run);
  }
  return series;
}

ReportMetric rising() {
  ReportMetric metric;
  metric.higherIsBetter = true;
  return metric;
}

TEST(FormatScore, neverReadsAsATargetThatIsMissed) {
  ReportMetric metric = rising();
  EXPECT_EQ(formatScore(metric, 0.9496), "0.95");
  metric.target = 0.95;
  EXPECT_EQ(formatScore(metric, 0.9496), "0.9496");
  EXPECT_EQ(formatScore(metric, 0.9494), "0.949");
  EXPECT_EQ(formatScore(metric, 0.9504), "0.95") << "which is reached";
  EXPECT_EQ(formatScore(metric, 0.95), "0.95");
  metric.higherIsBetter = false;
  EXPECT_EQ(formatScore(metric, 0.9504), "0.9504");
  EXPECT_EQ(formatScore(metric, 0.9496), "0.95");
}

TEST(MeanCurve, isMeanAndExtremesOverTheRunsThatGotThere) {
  const auto curve = meanCurve(seriesOf({{{1, 4}, {2, 2}, {4, 1}}, {{1.2, 6}, {2.4, 3}}}), 0);
  ASSERT_EQ(curve.size(), 3U);
  EXPECT_DOUBLE_EQ(curve[0].seconds, 1.1);
  EXPECT_DOUBLE_EQ(curve[0].mean, 5);
  EXPECT_DOUBLE_EQ(curve[0].low, 4);
  EXPECT_DOUBLE_EQ(curve[0].high, 6);
  EXPECT_DOUBLE_EQ(curve[2].seconds, 4);
  EXPECT_DOUBLE_EQ(curve[2].low, curve[2].high);
}

// A run whose first whole image comes late has no snapshot of the first number.
TEST(MeanCurve, joinsSnapshotsOfOneNumber) {
  ReportSeries series = seriesOf({{{1, 4}, {2, 2}, {4, 1}}, {{2, 6}, {4, 3}}});
  for (ReportPoint& point : series.runs[1].points) ++point.number;
  const auto curve = meanCurve(series, 0);
  ASSERT_EQ(curve.size(), 3U);
  const double seconds[] = {1, 2, 4}, means[] = {4, 4, 2};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(curve[i].seconds, seconds[i]);
    EXPECT_DOUBLE_EQ(curve[i].mean, means[i]);
  }
}

TEST(MeanCurve, leavesOutWhatIsNoNumber) {
  const auto curve = meanCurve(seriesOf({{{1, kNan}, {2, 2}}, {{1, kNan}, {2, kNan}}}), 0);
  ASSERT_EQ(curve.size(), 1U);
  EXPECT_DOUBLE_EQ(curve[0].seconds, 2);
  EXPECT_DOUBLE_EQ(curve[0].mean, 2);
}

TEST(FinalValue, isTheMeanOverSeeds) {
  const ReportSeries series = sampleReport().scenes[0].series[0];
  const double first = series.runs[0].points.back().values[0], second = series.runs[1].points.back().values[0];
  ASSERT_NE(first, second);
  EXPECT_DOUBLE_EQ(finalValue(series, 0), 0.5 * (first + second));
  EXPECT_TRUE(std::isnan(finalValue(ReportSeries{}, 0)));
}

TEST(BestFinalValue, followsTheMetricsDirectionAndPassesOverNothing) {
  ReportScene scene;
  scene.series = {seriesOf({{{1, kNan}}}), seriesOf({{{1, 0.5}}}), seriesOf({{{1, 0.7}}})};
  EXPECT_EQ(bestFinalValue(scene, ReportMetric{}, 0), 0.5);
  EXPECT_EQ(bestFinalValue(scene, rising(), 0), 0.7);
}

TEST(TimeToReach, isBetweenSnapshotsByTheLogarithmOfTime) {
  const auto time = timeToReach(seriesOf({{{1, 0.5}, {100, 0.9}}}), rising(), 0, 0.7);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(time->seconds, 10, 1e-9);
  EXPECT_FALSE(time->atMost);
  EXPECT_EQ(timeToReach(seriesOf({{{1, 0.5}, {100, 0.7}}}), rising(), 0, 0.7)->seconds, 100);
}

TEST(TimeToReach, isTheFirstSnapshotAtLatestOrNever) {
  const TargetTime first = *timeToReach(seriesOf({{{3, 0.95}, {4, 0.96}}}), rising(), 0, 0.9);
  EXPECT_EQ(first.seconds, 3);
  EXPECT_TRUE(first.atMost) << "it may have been there sooner";
  EXPECT_EQ(formatTime(first), "≤ 3 s");
  EXPECT_FALSE(timeToReach(seriesOf({{{3, 0.5}, {4, 0.8}}}), rising(), 0, 0.9).has_value());
  EXPECT_NEAR(timeToReach(seriesOf({{{1, 0.4}, {4, 0.1}}}), ReportMetric{}, 0, 0.25)->seconds, 2, 1e-9)
      << "errors fall";
}

// An image without what its method finds late can be better than the image with its noise.
TEST(TimeToReach, isTheTimeFromWhichOnTheScoreStays) {
  EXPECT_EQ(timeToReach(seriesOf({{{1, 0.95}, {2, 0.6}, {4, 0.9}}}), rising(), 0, 0.9)->seconds, 4);
  EXPECT_FALSE(timeToReach(seriesOf({{{1, 0.5}, {2, 0.95}, {4, 0.8}}}), rising(), 0, 0.9).has_value());
}

// Two seeds each, whose ends differ by 0.02 or by 0.4.
TEST(IsClearlyBest, takesSeedsThatDoNotOverlap) {
  const auto seeds = [](double a, double b) { return seriesOf({{{1, 0.1}, {100, a}}, {{1, 0.1}, {100, b}}}); };
  ReportScene scene;
  scene.series = {seeds(0.5, 0.52), seeds(0.8, 0.82)};
  EXPECT_TRUE(isClearlyBest(scene, scene.series[1], rising(), 0));
  EXPECT_FALSE(isClearlyBest(scene, scene.series[0], rising(), 0));
  EXPECT_TRUE(isClearlyBest(scene, scene.series[0], ReportMetric{}, 0)) << "errors fall";
  EXPECT_TRUE(isClearlyFastest(scene, scene.series[1], rising(), 0, 0.7)) << "the other never gets there";
  EXPECT_FALSE(isClearlyFastest(scene, scene.series[1], rising(), 0, 0.9)) << "nor does this one";
  scene.series.push_back(seeds(0.4, 0.8));
  EXPECT_FALSE(isClearlyBest(scene, scene.series[1], rising(), 0)) << "0.6 give or take 2.5";
  scene.series.resize(2);
  scene.series[1].runs.push_back(seriesOf({{{1, 0.1}, {100, kNan}}}).runs[0]);
  EXPECT_FALSE(isClearlyBest(scene, scene.series[1], rising(), 0))
      << "a seed ends without a number, and so does the mean";
  scene.series[1].runs.resize(1);
  EXPECT_FALSE(isClearlyBest(scene, scene.series[1], rising(), 0)) << "one seed has no band";
  EXPECT_FALSE(isClearlyFastest(scene, scene.series[1], rising(), 0, 0.7)) << "whoever else gets there";
}

TEST(IsClearlyFastest, isNotDecidedByTheFirstSnapshot) {
  const auto seeds = [](double first) { return seriesOf({{{1, first}, {100, 0.99}}, {{1, first}, {100, 0.99}}}); };
  ReportScene scene;
  scene.series = {seeds(0.95), seeds(0.96)};
  EXPECT_FALSE(isClearlyFastest(scene, scene.series[1], rising(), 0, 0.9)) << "both have it at the first";
  scene.series[0] = seeds(0.5);
  EXPECT_TRUE(isClearlyFastest(scene, scene.series[1], rising(), 0, 0.9));
}

TEST(MethodsOf, areInTheOrderOfTheStyleListThenOthers) {
  ConvergenceReport report = sampleReport();
  report.scenes[0].series[0].method = "zz";
  EXPECT_EQ(methodsOf(report), (std::vector<std::string>{"pt", "bpt", "vcm", "zz"}));
}

TEST(SeriesNames, tellSeriesOfOneMethodApart) {
  ConvergenceReport report = sampleReport();
  for (ReportSeries& series : report.scenes[0].series) series.method = "pt";
  EXPECT_EQ(seriesNamesOf(report), (std::vector<SeriesName>{{"pt", "pt"}, {"pt", "bpt"}, {"pt", "vcm"}}));
  EXPECT_EQ(seriesOf(report.scenes[0], {"pt", "vcm"}), &report.scenes[0].series[2]);
  EXPECT_EQ(seriesOf(report.scenes[1], {"pt", "vcm"}), nullptr);
  EXPECT_EQ(findSeriesName(report, "vcm")->label, "vcm");
  report.scenes[0].series[0].label = report.scenes[1].series[0].label = "pt sobol";
  EXPECT_EQ(findSeriesName(report, "pt")->label, "pt sobol");
  EXPECT_FALSE(findSeriesName(report, "lt"));
}

}  // namespace
}  // namespace wavecrest
