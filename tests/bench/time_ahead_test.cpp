// What a curve says of the time beyond its end, and how many times faster methods are at equal error.
#include "bench/report/time_ahead.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bench/report/speedup_section.h"

namespace wavecrest {
namespace {

const ReportMetric kError{.key = "relmse", .name = "relMSE", .best = 0};
const ReportMetric kSimilarity{.key = "ssim", .name = "SSIM", .higherIsBetter = true, .logarithmic = false, .best = 1};

// Snapshots after 1, 2, 4, 8 and 16 s, of one run for each scale: the loss is scale / t^power.
ReportSeries falling(double power, const std::vector<double>& scales, bool similarity = false) {
  ReportSeries series;
  series.method = series.label = "pt";
  for (const double scale : scales) {
    ReportRun run{.seed = series.runs.size(), .points = {}};
    for (const double seconds : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      const auto number = static_cast<uint32_t>(run.points.size());
      const double loss = scale / std::pow(seconds, power);
      run.points.push_back({.number = number, .seconds = seconds, .values = {similarity ? 1 - loss : loss}});
    }
    series.runs.push_back(std::move(run));
  }
  return series;
}

TEST(TimeAhead, followsTheCurvesOwnSlope) {
  // 1 / t is 0.025 at 40 s; the run ends at 16 s. The points lie on the line, so the interval is only that of bent
  // curves.
  const auto ahead = timeAhead(falling(1, {1}), kError, 0, 0.025, {});
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->seconds, 24, 1e-6);
  const double bend = std::pow(40 / 16.0, 0.75);
  EXPECT_NEAR(ahead->interval.low, 40 / bend - 16, 1e-3);
  EXPECT_NEAR(ahead->interval.high, 40 * bend - 16, 1e-3);
  EXPECT_EQ(formatTimeAhead(*ahead), "about 24 s more (4.1 s to 64 s)");
  // 1 - SSIM = 0.4 / sqrt(t) is 0.05 at 64 s.
  const auto similar = timeAhead(falling(0.5, {0.4}, true), kSimilarity, 0, 0.95, {});
  ASSERT_TRUE(similar);
  EXPECT_NEAR(similar->seconds, 48, 1e-6);
}

TEST(TimeAhead, hasTheIntervalOfItsSeeds) {
  // Times of 40 / 1.4 s, 40 s and 56 s: t = 4.303 for two degrees of freedom, of the logarithms.
  const auto ahead = timeAhead(falling(1, {1 / 1.4, 1, 1.4}), kError, 0, 0.025, {});
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->seconds, 24, 1e-6);
  const double half = 4.3027 * std::log(1.4) / std::sqrt(3.0);
  EXPECT_NEAR(ahead->interval.low, std::max(0.0, 40 * std::exp(-half) - 16), 0.01);
  EXPECT_NEAR(ahead->interval.high, 40 * std::exp(half) - 16, 0.01);
}

TEST(TimeAhead, isNoTimeWhereTheLastPointIsAboveTheLine) {
  ReportSeries series = falling(1, {1}, true);
  const double seconds[] = {4, 5.66, 8, 11.3, 16}, losses[] = {0.1, 0.083, 0.069, 0.0585, 0.0503};
  for (size_t i = 0; i < 5; ++i) {
    ReportPoint& point = series.runs[0].points[i];
    point.seconds = seconds[i];
    point.values = {1 - losses[i]};
  }
  // The line is at 0.05 after 15.7 s, with an interval of 14.7 s to 16.88 s.
  const auto ahead = timeAhead(series, kSimilarity, 0, 0.95, {});
  ASSERT_TRUE(ahead);
  EXPECT_EQ(formatTimeAhead(*ahead), "about 0 s more (0 s to 0.88 s)");
  EXPECT_EQ(formatTimeAhead({.seconds = 24, .interval = {4, 1601}, .end = 16}), "about 24 s more (4 s or longer)");
}

TEST(TimeAhead, isUnknownWhereTheCurveDoesNotLeadThere) {
  EXPECT_FALSE(timeAhead(falling(1, {1}), kError, 0, 0.1, {})) << "reached";
  EXPECT_FALSE(timeAhead(falling(0, {1}), kError, 0, 0.1, {})) << "flat";
  EXPECT_FALSE(timeAhead(falling(-1, {1}), kError, 0, 0.1, {})) << "rises";
  EXPECT_FALSE(timeAhead(falling(0.5, {1}), kError, 0, 0.001, {})) << "a million seconds away";
  EXPECT_FALSE(timeAhead(falling(1, {1}), kError, 0, 0.025, 0.03)) << "the reference's noise is larger";
  EXPECT_FALSE(timeAhead(falling(1, {1}), kError, 0, 0.025, 0.013)) << "more than half of that error is its noise";
  EXPECT_TRUE(timeAhead(falling(1, {1}), kError, 0, 0.025, 0.012));
  ReportSeries brief = falling(1, {1});
  brief.runs[0].points.resize(2);
  EXPECT_FALSE(timeAhead(brief, kError, 0, 0.025, {})) << "two points have no residual";
  ReportMetric open = kError;
  open.best.reset();
  EXPECT_FALSE(timeAhead(falling(1, {1}), open, 0, 0.025, {}));
}

TEST(SpeedUp, isTheRatioOfTimesToTheErrorThatBothReach) {
  // 1 / t against 4 / t: the slower one ends at 0.25, which the faster one has after 4 s of its 16.
  const auto faster = speedUp(falling(1, {1}), falling(1, {4}), kError, 0);
  ASSERT_TRUE(faster);
  EXPECT_NEAR(faster->factor, 4, 1e-9);
  EXPECT_EQ(faster->bound, 0);
  const auto slower = speedUp(falling(1, {4}), falling(1, {1}), kError, 0);
  EXPECT_NEAR(slower->factor, 0.25, 1e-9);
  EXPECT_NEAR(speedUp(falling(1, {1}), falling(1, {1}), kError, 0)->factor, 1, 1e-9);
}

TEST(SpeedUp, isABoundWhereTheFirstSnapshotIsGoodEnough) {
  const auto faster = speedUp(falling(1, {1}), falling(1, {64}), kError, 0);
  EXPECT_NEAR(faster->factor, 16, 1e-9);
  EXPECT_EQ(faster->bound, 1);
  EXPECT_EQ(speedUp(falling(1, {64}), falling(1, {1}), kError, 0)->bound, -1);
  ReportSeries none = falling(1, {1});
  none.runs[0].points.back().values[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(speedUp(none, falling(1, {1}), kError, 0));
}

TEST(SpeedUp, isNoneOverWhatTookNoTime) {
  ReportSeries instant = falling(1, {64});
  for (ReportPoint& point : instant.runs[0].points) point.seconds = 0;
  EXPECT_FALSE(speedUp(falling(1, {1}), instant, kError, 0));
  EXPECT_FALSE(speedUp(instant, falling(1, {1}), kError, 0));
}

TEST(SpeedUp, isOneOverItselfThoughTheErrorRises) {
  // A firefly in the last snapshot: the error of the end was there after 2 s.
  ReportSeries rising = falling(1, {1});
  rising.runs[0].points.back().values[0] = 0.5;
  EXPECT_EQ(speedUp(rising, rising, kError, 0)->factor, 1);
}

TEST(SpeedUp, hasATableForEachBaselineWithTheGeometricMeanOverScenes) {
  ConvergenceReport report;
  report.metrics = {kError};
  for (const double scale : {4.0, 9.0}) {
    ReportScene scene{.name = scale < 5 ? "near" : "far"};
    scene.noiseFloors = {{}};
    ReportSeries pt = falling(1, {scale}), vcm = falling(1, {1});
    vcm.method = vcm.label = "vcm";
    scene.series = {pt, vcm};
    report.scenes.push_back(scene);
  }
  // Over pt: 4 and, between snapshots at 1 and 2 s by the logarithm of time, about 9; a mean of about 6.
  const std::string html = renderSpeedUps(report);
  EXPECT_NE(html.find("open><summary>over pt<"), std::string::npos);
  EXPECT_NE(html.find("<summary>over vcm<"), std::string::npos);
  EXPECT_NE(html.find("geometric mean<th class=\"n\">near<th class=\"n\">far"), std::string::npos);
  const double far = speedUp(report.scenes[1].series[1], report.scenes[1].series[0], kError, 0)->factor;
  EXPECT_NEAR(far, 9, 0.5);
  EXPECT_NE(html.find(fmt::format("{:.3g} ×<td class=\"n faster\"", std::sqrt(4 * far))), std::string::npos) << html;
  report.baseline = "vcm";
  EXPECT_NE(renderSpeedUps(report).find("open><summary>over vcm<"), std::string::npos);
}

}  // namespace
}  // namespace wavecrest
