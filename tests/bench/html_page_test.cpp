#include "bench/report/html_page.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "bench/report/html_text.h"
#include "bench/report/scene_section.h"
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
  const std::string section = renderScene(sampleReport(), 0);
  const size_t table = section.find("At the end");
  const size_t bpt = section.find(">bpt <", table), pt = section.find(">pt <", table),
               vcm = section.find(">vcm <", table);
  EXPECT_LT(table, bpt);
  EXPECT_LT(bpt, pt);
  EXPECT_LT(pt, vcm);
}

TEST(HtmlPage, summaryIsForSeveralScenesOnly) {
  ConvergenceReport report = sampleReport();
  EXPECT_TRUE(contains(renderReport(report), "<h2>Summary</h2>"));
  report.scenes.resize(1);
  EXPECT_FALSE(contains(renderReport(report), "<h2>Summary</h2>"));
}

TEST(HtmlPage, finalValueIsTheMeanOverSeeds) {
  const ReportSeries series = sampleReport().scenes[0].series[0];
  const double first = series.runs[0].points.back().values[0], second = series.runs[1].points.back().values[0];
  ASSERT_NE(first, second);
  EXPECT_DOUBLE_EQ(finalValue(series, 0), 0.5 * (first + second));
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
