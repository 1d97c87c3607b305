// How much better a sample is, how much longer it takes, and what both come to at equal time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bench/report/factor_table.h"
#include "bench/report/samples_section.h"
#include "bench/report/speedup_section.h"

namespace wavecrest {
namespace {

const ReportMetric kError{.key = "relmse", .name = "relMSE", .best = 0};

// One run with a snapshot for each number of samples: the error is loss / samples, the time samples * seconds.
ReportSeries sampled(const std::string& method, double loss, double seconds, const std::vector<uint64_t>& samples) {
  ReportSeries series{.method = method, .label = method};
  ReportRun run{.seed = 0, .points = {}};
  for (const uint64_t n : samples) {
    const auto count = static_cast<double>(n);
    run.points.push_back({.number = static_cast<unsigned>(run.points.size()),
                          .seconds = count * seconds,
                          .iterations = n,
                          .values = {loss / count}});
  }
  series.runs = {run};
  return series;
}

// pt takes 1/4 s a sample and vcm 1 s, for 16 s; the error of a sample is 3 and 1.
ReportSeries pt() { return sampled("pt", 3, 0.25, {4, 16, 64}); }
ReportSeries vcm() { return sampled("vcm", 1, 1, {1, 4, 16}); }

TEST(EqualSamples, areTheMostThatBothHave) {
  // After 16 samples: errors of 3/16 and 1/16, times of 4 s and 16 s.
  const auto equal = equalSamples(vcm(), pt(), 0);
  ASSERT_TRUE(equal);
  EXPECT_EQ(equal->samples, 16);
  EXPECT_NEAR(equal->error.factor, 3, 1e-12);
  EXPECT_NEAR(equal->overhead.factor, 4, 1e-12);
  ASSERT_TRUE(equal->gain);
  EXPECT_NEAR(equal->gain->factor, 0.75, 1e-12);
  EXPECT_EQ(equal->error.bound, 0);
  EXPECT_EQ(equal->overhead.bound, 0);
}

TEST(EqualSamples, lieOnTheLineBetweenSnapshots) {
  // pt has snapshots at 2 and 32 samples, vcm one at 8. On a logarithmic axis 8 is half way between 2 and 32, so pt's
  // error there is sqrt(0.9 * 0.1) = 0.3. Time is linear: 8 is a fifth of the way, so 1 s + 55 s / 5 = 12 s.
  ReportSeries base = sampled("pt", 1, 1, {2, 32});
  base.runs[0].points[0].values = {0.9};
  base.runs[0].points[1].values = {0.1};
  base.runs[0].points[0].seconds = 1;
  base.runs[0].points[1].seconds = 56;
  const auto equal = equalSamples(sampled("vcm", 1.2, 0.75, {8}), base, 0);
  ASSERT_TRUE(equal);
  EXPECT_NEAR(equal->error.factor, 0.3 / 0.15, 1e-12);
  EXPECT_NEAR(equal->overhead.factor, 6.0 / 12, 1e-12);
}

TEST(EqualSamples, areOfMeansOverSeeds) {
  // Errors of 1/16 and 3/16, 2/16 in the mean; the times 16 s and 24 s are 20 s.
  ReportSeries series = vcm();
  series.runs.push_back(sampled("vcm", 3, 1.5, {1, 4, 16}).runs[0]);
  const auto equal = equalSamples(series, pt(), 0);
  EXPECT_NEAR(equal->error.factor, 1.5, 1e-12);
  EXPECT_NEAR(equal->overhead.factor, 5, 1e-12);
}

TEST(EqualSamples, areBoundsWhereCurvesDoNotOverlap) {
  // pt has 4 samples in its first snapshot, with an error of 0.75 after 1 s; vcm ends at 2, with 0.5 after 2 s.
  const auto slow = equalSamples(sampled("vcm", 1, 1, {1, 2}), pt(), 0);
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->samples, 2);
  EXPECT_NEAR(slow->error.factor, 1.5, 1e-12);
  EXPECT_NEAR(slow->overhead.factor, 2, 1e-12);
  EXPECT_EQ(slow->error.bound, 1);
  EXPECT_EQ(slow->overhead.bound, 1);
  EXPECT_FALSE(slow->gain) << "the quotient of two lower bounds";
  const auto fast = equalSamples(pt(), sampled("vcm", 1, 1, {1, 2}), 0);
  EXPECT_NEAR(fast->error.factor, 1 / 1.5, 1e-12);
  EXPECT_EQ(fast->error.bound, -1);
  EXPECT_EQ(fast->overhead.bound, -1);
  // The first snapshot itself is no bound.
  EXPECT_EQ(equalSamples(sampled("vcm", 1, 1, {1, 4}), pt(), 0)->error.bound, 0);
}

TEST(EqualSamples, areUnknownWithoutCountsOrErrors) {
  ReportSeries other = vcm();
  for (ReportPoint& point : other.runs[0].points) point.iterations = 0;
  EXPECT_FALSE(equalSamples(other, pt(), 0)) << "an image of another program";
  EXPECT_FALSE(equalSamples(pt(), other, 0));
  EXPECT_FALSE(equalSamples(ReportSeries{.method = "vcm", .runs = {{}}}, pt(), 0));
  ReportSeries perfect = vcm();
  for (ReportPoint& point : perfect.runs[0].points) point.values = {0};
  EXPECT_FALSE(equalSamples(perfect, pt(), 0));
}

TEST(EqualSamples, gainWhatTheSpeedUpAtEqualErrorSays) {
  // The error of a sample is 12 times smaller, at 4 times the time. Straight lines over the logarithm of time are up to
  // 6.2 % above 1 / t between snapshots that double the time.
  const ReportSeries base = sampled("pt", 12, 0.25, {4, 8, 16, 32, 64});
  const ReportSeries better = sampled("vcm", 1, 1, {1, 2, 4, 8, 16});
  EXPECT_NEAR(equalSamples(better, base, 0)->gain->factor, 3, 1e-12);
  EXPECT_NEAR(speedUp(better, base, kError, 0)->factor, 3, 0.062 * 3);
  EXPECT_NEAR(equalSamples(base, better, 0)->gain->factor, 1 / 3.0, 1e-12);
  EXPECT_NEAR(speedUp(base, better, kError, 0)->factor, 1 / 3.0, 0.062 / 3);
}

TEST(EqualSamples, haveATableWithErrorTimeAndGain) {
  ConvergenceReport report;
  report.metrics = {{.key = "rmse"}, kError};
  for (const double loss : {3.0, 12.0}) {
    ReportScene scene{.name = loss < 5 ? "near" : "far"};
    ReportSeries other = vcm();
    other.method = other.label = "other";
    for (ReportPoint& point : other.runs[0].points) point.iterations = 0;
    scene.series = {sampled("pt", loss, 0.25, {4, 16, 64}), vcm(), other};
    for (ReportSeries& series : scene.series) {
      for (ReportPoint& point : series.runs[0].points) point.values.insert(point.values.begin(), 1.0);
    }
    report.scenes.push_back(scene);
  }
  // Errors 3 and 12 times smaller, 6 in the mean, at 4 times the time.
  const std::string html = renderEqualSamples(report);
  EXPECT_NE(html.find("name=\"samples\" open><summary>over pt<"), std::string::npos);
  EXPECT_NE(
      html.find("m-vcm\"></i>vcm<td class=\"n faster\" style=\"--behind:0.65\">6 ×<small>time 4 ×</small>"
                "<small>gain 1.5 ×</small><td class=\"n faster\" style=\"--behind:0.40\" title=\"after 16 samples "
                "per pixel\">3 ×<small>time 4 ×</small><small>gain 0.75 ×</small>"),
      std::string::npos)
      << html;
  EXPECT_NE(html.find("m-other\"></i>other<td class=\"n none\">–<td class=\"n none\">–<td class=\"n none\">–</tbody>"),
            std::string::npos)
      << "a method without sample counts has dashes, and comes last";
  EXPECT_EQ(html.find("over other"), std::string::npos);
  report.metrics[1].key = "ssim";
  EXPECT_EQ(renderEqualSamples(report), "") << "a ratio of errors is of relMSE";
}

TEST(FactorTable, meansOfBoundsAreBounds) {
  using Factors = std::vector<std::optional<Factor>>;
  const FactorMean plain = geometricMean(Factors{Factor{2}, std::nullopt, Factor{8}});
  EXPECT_EQ(formatFactor(plain.mean), "4 ×");
  EXPECT_EQ(plain.counted, 2U);
  EXPECT_EQ(formatFactor(geometricMean(Factors{Factor{2}, Factor{8, 1}}).mean), "≥ 4 ×");
  EXPECT_EQ(formatFactor(geometricMean(Factors{Factor{2, -1}, Factor{8}}).mean), "≤ 4 ×");
  EXPECT_EQ(formatFactor(geometricMean(Factors{Factor{2, -1}, Factor{8, 1}}).mean), "–");
  EXPECT_EQ(formatFactor(geometricMean(Factors{std::nullopt}).mean), "–");
}

TEST(FactorTable, saysOfHowManyScenesAMeanIs) {
  ConvergenceReport report;
  report.metrics = {kError};
  report.scenes = {ReportScene{.name = "both", .series = {pt(), vcm()}},
                   ReportScene{.name = "bounds", .series = {pt(), sampled("vcm", 1, 1, {1, 2})}},
                   ReportScene{.name = "one", .series = {pt()}}};
  // Error ratios of 3 and of at least 1.5; the gain is known in one scene.
  const std::string html = renderEqualSamples(report);
  EXPECT_NE(
      html.find("vcm<td class=\"n faster\" style=\"--behind:0.27\">≥ 2.12 ×<small> of 2</small><small>time ≥ 2.83 ×"
                "</small><small>gain 0.75 × of 1</small>"),
      std::string::npos)
      << html;
}

}  // namespace
}  // namespace wavecrest
