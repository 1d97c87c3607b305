#include "bench/report/html_page.h"

#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/report/answer_section.h"
#include "bench/report/embedded_images.h"
#include "bench/report/html_text.h"
#include "bench/report/scene_plots.h"
#include "bench/report/scene_section.h"
#include "bench/report/scene_tables.h"
#include "bench/report/speedup_section.h"
#include "bench/report/summary_section.h"
#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Opened offline: no address outside the file itself, in any attribute or style.
TEST(HtmlPage, refersToNothingOutsideItself) {
  const std::string page = renderReport(sampleReport());
  for (const char* outside : {"http:", "https:", "@import", "url(", "<link", "src=\"/", "src=\"."}) {
    EXPECT_FALSE(contains(page, outside)) << outside;
  }
  EXPECT_TRUE(contains(page, "src=\"data:image/png;base64,"));
}

TEST(HtmlPage, everyElementThatMustBeClosedIsClosed) {
  const std::string page = renderReport(sampleReport());
  for (const std::string tag : {"section", "figure", "table", "svg", "div", "details", "main", "header"}) {
    size_t opened = 0, closed = 0;
    for (size_t at = page.find("<" + tag); at != std::string::npos; at = page.find("<" + tag, at + 1)) {
      const char next = page[at + tag.size() + 1];
      opened += next == '>' || next == ' ' ? 1 : 0;
    }
    for (size_t at = page.find("</" + tag + ">"); at != std::string::npos; at = page.find("</" + tag + ">", at + 1)) {
      ++closed;
    }
    EXPECT_GT(opened, 0U) << tag;
    EXPECT_EQ(opened, closed) << tag;
  }
}

TEST(HtmlPage, escapesTextFromResults) {
  ConvergenceReport report = sampleReport();
  report.environment.push_back({"cpu", "<script>alert(1)</script>"});
  const std::string page = renderReport(report);
  EXPECT_FALSE(contains(page, "<script>alert"));
  EXPECT_TRUE(contains(page, "<h1>Convergence of &lt;three&gt; methods</h1>"));
}

TEST(HtmlPage, ranksByTheFirstMetric) {
  const std::string section = renderScene(sampleReport(), 0, EmbeddedImages());
  const size_t table = section.find("At the end");
  const size_t bpt = section.find("</i>bpt<", table), pt = section.find("</i>pt<", table),
               vcm = section.find("</i>vcm<", table);
  EXPECT_LT(table, bpt);
  EXPECT_LT(bpt, pt);
  EXPECT_LT(pt, vcm);
  EXPECT_LT(vcm, section.size());
}

// The order of a page: the answer, plots and pictures of the scenes, all scores, the study's findings.
TEST(HtmlPage, beginsWithTheAnswerAndEndsWithFindings) {
  const std::string page = renderReport(sampleReport());
  size_t last = 0;
  for (const char* part : {"class=\"answer\"", "<h2>Summary</h2>", "Speed-up at equal relMSE",
                           "relMSE at equal samples, and overhead", "<h3>Error over time</h3>", "<h3>Pictures</h3>",
                           "<h3>At the end</h3>", "<h2>All scores</h2>", "<h2>The study's findings</h2>"}) {
    const size_t at = page.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    EXPECT_GT(at, last) << part;
    last = at;
  }
}

// What a band or a formula means stands beside it.
TEST(HtmlPage, explainsBandsAndFormulasWhereTheyAre) {
  ConvergenceReport report = sampleReport();
  report.metrics[0].formula = "√ mean (x - r)²";
  EXPECT_TRUE(
      contains(renderScene(report, 0, EmbeddedImages()),
               "<b>RMSE</b> √ mean (x - r)²; linear radiance, all pixels; curve: mean over seeds, band: worst to "
               "best seed<"));
  EXPECT_TRUE(contains(renderHeatMaps(report), "<b>RMSE</b> <small>√ mean (x - r)²; at the end of each run"));
  for (ReportSeries& series : report.scenes[0].series) series.runs.resize(1);
  EXPECT_FALSE(contains(renderScene(report, 0, EmbeddedImages()), "band:")) << "one seed has no band";
}

TEST(HtmlPage, namesAxesAndPathClasses) {
  const std::string section = renderScene(sampleReport(), 0, EmbeddedImages());
  for (const char* name : {"rotate(-90)\" text-anchor=\"middle\">RMSE<", "rotate(-90)\" text-anchor=\"middle\">SSIM<",
                           "A: area light or sky", "E: eye"}) {
    EXPECT_TRUE(contains(section, name)) << name;
  }
}

TEST(HtmlPage, showsRelativeErrorsWithoutTheWorstPixels) {
  ConvergenceReport report = sampleReport();
  EXPECT_FALSE(contains(renderScene(report, 0, EmbeddedImages()), "of 99.9 %"));
  for (ReportRun& run : report.scenes[0].series[0].runs) run.points.back().further = {{"relmse_trimmed", 0.0125}};
  const std::string section = renderScene(report, 0, EmbeddedImages());
  EXPECT_TRUE(contains(section, ">relMSE of 99.9 %"));
  EXPECT_TRUE(contains(section, "<td class=\"n\">0.0125"));
}

TEST(HtmlPage, summaryIsForSeveralScenesOnly) {
  ConvergenceReport report = sampleReport();
  EXPECT_TRUE(contains(renderReport(report), "<h2>Summary</h2>"));
  EXPECT_TRUE(contains(renderReport(report), "<h3>Ranking</h3>"));
  report.scenes.resize(1);
  EXPECT_FALSE(contains(renderReport(report), "<h2>Summary</h2>"));
  EXPECT_FALSE(contains(renderReport(report), "<nav>"));
}

TEST(HtmlPage, manyRemarksAreCountedAndBehindAClick) {
  ConvergenceReport report = sampleReport();
  report.remarks = {"a noisy reference", "runs of unequal time", "disturbed runs"};
  EXPECT_FALSE(contains(renderReport(report), "<details class=\"remarks\">"));
  report.remarks.emplace_back("images that are not there");
  EXPECT_TRUE(contains(renderReport(report), "<details class=\"remarks\"><summary>4 remarks</summary>"));
}

// The second scene has only pt: first by every metric there, second of three in the first scene by RMSE.
TEST(Summary, ranksMethodsByOneMetric) {
  const std::string ranking = renderRanking(sampleReport());
  EXPECT_FALSE(contains(ranking, "mean rank")) << "metrics are correlated: their ranks are not averaged";
  EXPECT_TRUE(contains(ranking, ">Ranks at the end of the runs by one metric each")) << "whose times may be unequal";
  const std::regex row("</i>(\\w+) <small>[^<]*</small><td class=\"n\">([0-9.]+)");
  std::vector<std::pair<std::string, std::string>> found;
  for (std::sregex_iterator match(ranking.begin(), ranking.end(), row), end; match != end; ++match)
    found.emplace_back((*match)[1], (*match)[2]);
  EXPECT_EQ(found, (std::vector<std::pair<std::string, std::string>>{{"bpt", "1"}, {"pt", "1.5"}, {"vcm", "3"}}));
}

TEST(Summary, heatMapsShadeByTheDistanceToTheBestOfTheRow) {
  ConvergenceReport report = sampleReport();
  for (ReportSeries& series : report.scenes[0].series)
    for (ReportRun& run : series.runs) run.points.back().values[0] = series.method == "bpt" ? 0.01 : 0.04;
  const std::string maps = renderHeatMaps(report);
  EXPECT_FALSE(contains(maps, "time to SSIM"));
  // Four times the best: two factors of two of the four that are the full shade.
  EXPECT_TRUE(
      contains(maps, "<td class=\"n\" style=\"--behind:0.50\">0.04<td class=\"n best\" style=\"--behind:0.00\">0.01"));
  EXPECT_TRUE(contains(renderTargetMaps(report), "data-name=\"time to SSIM 0.9\""));
  EXPECT_TRUE(contains(maps, "<td class=\"n none\">–")) << "the second scene has one method";
}

TEST(Summary, everySeriesOfAMethodHasAColumnAndARow) {
  ConvergenceReport report = sampleReport();
  for (ReportSeries& series : report.scenes[0].series) series.method = "pt";
  for (const std::string& html : {renderHeatMaps(report), renderRanking(report), renderSpeedUps(report)}) {
    for (const char* label : {"pt", "bpt", "vcm"}) {
      EXPECT_TRUE(contains(html, std::string("<i class=\"swatch m-pt\"></i>") + label)) << html;
    }
  }
}

TEST(Summary, aPerfectScoreIsNotBehindItself) {
  ConvergenceReport report = sampleReport();
  for (ReportSeries& series : report.scenes[0].series)
    for (ReportRun& run : series.runs) run.points.back().values[0] = series.method == "bpt" ? 0 : 0.04;
  const std::string maps = renderHeatMaps(report);
  EXPECT_TRUE(
      contains(maps, "<td class=\"n\" style=\"--behind:1.00\">0.04<td class=\"n best\" style=\"--behind:0.00\">0<"));
}

TEST(Summary, claimsCarryTheirVerdicts) {
  const std::string claims = renderClaims(sampleReport());
  EXPECT_TRUE(contains(claims, "0 hold, 1 does not, 0 not in this time, 1 is undecided"));
  EXPECT_TRUE(contains(claims, "<td>pt &lt; bpt<td><span class=\"verdict fails\">does not hold</span>"));
  ConvergenceReport report = sampleReport();
  report.claims[0].source = "BPT & PT";
  report.claims[0].explanation = "a < b";
  const std::string explained = renderClaims(report);
  EXPECT_TRUE(contains(explained, "<td>pt &lt; bpt<small class=\"source\">BPT &amp; PT</small><td>"));
  EXPECT_TRUE(contains(explained, "<summary>evidence</summary><p>a &lt; b</p>0.1</details>")) << "behind a click";
  report.claims[1].verdict = "not reached in this time";
  const std::string later = renderClaims(report);
  EXPECT_TRUE(contains(later, "0 hold, 1 does not, 1 not in this time, 0 are undecided"));
  EXPECT_TRUE(contains(later, "<span class=\"verdict undecided\">not reached in this time</span>"));
  report.claims[0].figure = "SSIM 0.9 < 0.95";
  report.claims[1].verdict = "not judged";
  const std::string unjudged = renderClaims(report);
  EXPECT_TRUE(contains(unjudged, "0 not in this time, 0 are undecided. 1 cannot be judged by this campaign"));
  EXPECT_TRUE(contains(unjudged, "<td>SSIM 0.9 &lt; 0.95<details>")) << "the figure that decides is in view";
  report.claims[0].verdict = "not judged";
  EXPECT_TRUE(contains(renderClaims(report), "<p class=\"facts\">All 2 cannot be judged")) << "no count of verdicts";
  EXPECT_FALSE(contains(renderClaims(report), "<table")) << "findings that cannot be judged are counted, not listed";
  report.claims.clear();
  EXPECT_EQ(renderClaims(report), "");
}

TEST(Answer, namesTheMethodsThatAreFirstToTheTarget) {
  ConvergenceReport report = sampleReport();
  ReportScene& scene = report.scenes[0];
  // SSIM over seconds: bpt is at 0.9 after 10 s, vcm after 11, level with it; pt never.
  const auto set = [&](size_t series, double at10) {
    for (ReportRun& run : scene.series[series].runs) {
      run.points.resize(2);
      run.points[0].seconds = 1;
      run.points[1].seconds = 10;
      run.points[0].values[2] = 0.5;
      run.points[1].values[2] = at10;
    }
  };
  set(0, 0.7);
  set(1, 0.9);
  set(2, 0.91);
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).figure, "9.45 s");
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).methods, (std::vector<std::string>{"vcm"}));
  scene.series[1].runs.resize(1);  // without a band
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).methods, (std::vector<std::string>{"vcm", "bpt"}));
  set(1, 0.8);
  set(2, 0.85);
  EXPECT_TRUE(
      contains(renderAnswer(report),
               "First to SSIM 0.9: none in <a href=\"#scene-0\">cornell-spheres</a> (0.85), where <b>vcm</b> came "
               "closest"));
  scene.noiseFloors[2] = 0.88;
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).figure, "0.85; the reference allows 0.88");
  set(2, 0.8996);
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).figure, "0.8996; the reference allows 0.88") << "and not 0.9";
  scene.noiseFloors[2] = 0.89996;
  EXPECT_EQ(answerFor(scene, report.metrics[2], 2).figure, "0.8996; the reference allows 0.89996");
  EXPECT_TRUE(contains(renderReport(report), ">0.8996<")) << "in the tables, too";
  EXPECT_LT(renderReport(report).find("class=\"answer\""), renderReport(report).find("<h2>Summary</h2>"));
}

// An image that is smaller than a metric's window has no score.
TEST(Answer, leavesOutScenesWithoutAScore) {
  ConvergenceReport report = sampleReport();
  EXPECT_TRUE(contains(renderAnswer(report), "SSIM"));
  for (ReportSeries& series : report.scenes[0].series) {
    for (ReportRun& run : series.runs) {
      for (ReportPoint& point : run.points) point.values[2] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  EXPECT_EQ(renderAnswer(report), "");
}

TEST(SceneSection, showsWhatIsKnownAndNothingElse) {
  ConvergenceReport report = sampleReport();
  const std::string full = renderScene(report, 0, EmbeddedImages());
  EXPECT_TRUE(contains(full, "Bias and variance"));
  EXPECT_TRUE(contains(full, "<td class=\"v-impossible\">impossible"));
  EXPECT_TRUE(contains(full, "<b>ppm</b> was refused: has no &lt;light&gt;"));
  EXPECT_TRUE(contains(full, "data-kind=\"Error maps\""));
  for (ReportSeries& series : report.scenes[0].series) {
    series.bias.clear();
    series.stages.clear();
    series.errorMap = {};
  }
  report.scenes[0].reference = {};  // results travel without their images
  report.scenes[0].pathClasses.clear();
  report.scenes[0].refusals.clear();
  const std::string bare = renderScene(report, 0, EmbeddedImages());
  for (const char* absent : {"Pictures", "<img", "Bias", "Which paths", "refused", "Error maps", "Where the time went"})
    EXPECT_FALSE(contains(bare, absent)) << absent;
}

TEST(SceneSection, tellsNoShareOfBiasInAnErrorThatIsNotAboveZero) {
  ConvergenceReport report = sampleReport();
  ReportScene& scene = report.scenes[0];
  EXPECT_TRUE(contains(renderBias(scene), "<td class=\"n\">25.0 %"));
  const auto setLast = [&](double meanSquareError) {
    for (ReportSeries& series : scene.series) series.bias.back().meanSquareError = meanSquareError;
  };
  for (const double none : {-0.004, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    setLast(none);
    const std::string table = renderBias(scene);
    EXPECT_TRUE(contains(table, "<td class=\"n\">–")) << none;
    for (const char* number : {" %", "nan", "inf"}) EXPECT_FALSE(contains(table, number)) << none;
    const ScenePlot plot = scenePlots(report, scene).back();
    ASSERT_EQ(plot.key, "bias");
    ASSERT_EQ(plot.plot.curves.size(), 3U);
    for (const PlotCurve& curve : plot.plot.curves) EXPECT_EQ(curve.points.size(), 1U) << "the other snapshot";
  }
  for (ReportSeries& series : scene.series) series.bias.front().meanSquareError = 0;
  EXPECT_NE(scenePlots(report, scene).back().key, "bias") << "a plot without a point";
}

TEST(HtmlPage, refusesValuesThatDoNotMatchTheMetrics) {
  ConvergenceReport report = sampleReport();
  report.scenes[0].series[1].runs[0].points[2].values.pop_back();
  EXPECT_THROW(renderReport(report), std::invalid_argument);
}

TEST(HtmlText, durationsRoundWithoutSixtySeconds) {
  EXPECT_EQ(formatSeconds(0.123456), "0.123 s");
  EXPECT_EQ(formatSeconds(60), "60 s");
  EXPECT_EQ(formatSeconds(119.6), "2 min 00 s");
  EXPECT_EQ(formatSeconds(3599.7), "1 h 00 min");
  EXPECT_EQ(formatSeconds(7500), "2 h 05 min");
}

TEST(HtmlText, countsCarryPrefixes) {
  EXPECT_EQ(formatCount(0), "0");
  EXPECT_EQ(formatCount(871414), "871 k");
  EXPECT_EQ(formatCount(999600), "1 M");
  EXPECT_EQ(formatCount(12.6e6), "12.6 M");
}

}  // namespace
}  // namespace wavecrest
