#include "bench/report/svg_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <utility>
#include <vector>

namespace wavecrest {
namespace {

PlotCurve curveOf(const std::string& label, const std::vector<std::pair<double, double>>& points) {
  PlotCurve curve;
  curve.label = label;
  curve.cssClass = "m-" + label;
  for (const auto& [x, y] : points) {
    PlotPoint point;
    point.x = x;
    point.y = point.low = point.high = y;
    curve.points.push_back(point);
  }
  return curve;
}

Plot plotOf(const std::vector<PlotCurve>& curves) {
  Plot plot;
  plot.curves = curves;
  return plot;
}

// All matches of the pattern's first group, as numbers.
std::vector<double> numbers(const std::string& svg, const std::string& pattern) {
  std::vector<double> found;
  const std::regex expression(pattern);
  for (auto match = std::sregex_iterator(svg.begin(), svg.end(), expression); match != std::sregex_iterator();
       ++match) {
    found.push_back(std::stod((*match)[1]));
  }
  return found;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

TEST(SvgPlot, powerLawIsAStraightLineOnLogarithmicAxes) {
  const std::string svg = renderPlot(plotOf({curveOf("pt", {{1, 1}, {10, 0.1}, {100, 0.01}})}));
  const std::vector<double> x = numbers(svg, "data-x=\"([0-9.]+)\"");
  const std::vector<double> y = numbers(svg, "data-y=\"([0-9.]+)\"");
  ASSERT_EQ(x.size(), 3U);
  ASSERT_EQ(y.size(), 3U);
  // Coordinates are printed with one decimal.
  EXPECT_NEAR(x[1], 0.5 * (x[0] + x[2]), 0.11);
  EXPECT_NEAR(y[1], 0.5 * (y[0] + y[2]), 0.11);
  EXPECT_LT(y[0], y[2]) << "larger values are higher up";
}

TEST(SvgPlot, leavesOutWhatTheAxesCannotShow) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string svg = renderPlot(
      plotOf({curveOf("pt", {{0, 1}, {1, 0.5}, {2, 0}, {3, -1}, {4, std::nan("")}, {5, infinity}, {6, 0.2}})}));
  EXPECT_EQ(count(svg, "data-x"), 2U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(SvgPlot, saysSoWhenThereIsNothingToShow) {
  const std::string svg = renderPlot(plotOf({curveOf("pt", {{0, 0}})}));
  EXPECT_NE(svg.find("no data"), std::string::npos);
  EXPECT_EQ(svg.find("class=\"axis\""), std::string::npos);
}

TEST(SvgPlot, keepsEndLabelsApartAndInsideThePlot) {
  for (const auto& [curveCount, spacing] : std::vector<std::pair<size_t, double>>{{7, 14.9}, {20, 13.6}}) {
    std::vector<PlotCurve> curves;
    for (size_t i = 0; i < curveCount; ++i) {
      curves.push_back(curveOf("pt", {{1, 100}, {10, 1}}));  // all end in one point, at the lower edge
    }
    const std::string svg = renderPlot(plotOf(curves));
    const std::vector<double> y = numbers(svg, "class=\"end-label\" x=\"[0-9.]+\" y=\"([-0-9.]+)\"");
    ASSERT_EQ(y.size(), curveCount);
    for (size_t i = 1; i < y.size(); ++i) EXPECT_GE(y[i] - y[i - 1], spacing);
    const double lowerEdge = numbers(svg, "class=\"axis\" d=\"M[0-9.]+ [0-9.]+V([0-9.]+)").front();
    EXPECT_LE(y.back(), lowerEdge + 4.1);
    EXPECT_GT(y.front(), 12) << "its letters are within the picture";
  }
}

TEST(SvgPlot, noiseFloorBelowAllCurvesExtendsTheAxis) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}, {10, 0.3}})});
  plot.floor = {1e-3, "noise"};
  const std::string svg = renderPlot(plot);
  const std::vector<double> floor = numbers(svg, "class=\"floor\" x1=\"[0-9.]+\" y1=\"([0-9.]+)\"");
  const double lowerEdge = numbers(svg, "class=\"axis\" d=\"M[0-9.]+ [0-9.]+V([0-9.]+)").front();
  ASSERT_EQ(floor.size(), 1U);
  EXPECT_LT(floor[0], lowerEdge);
  EXPECT_GT(floor[0], numbers(svg, "data-y=\"([0-9.]+)\"").back());
}

TEST(SvgPlot, drawsABandOnlyWhereSeedsDiffer) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}, {10, 0.3}})});
  EXPECT_EQ(count(renderPlot(plot), "class=\"band\""), 0U);
  plot.curves[0].points[1].low = 0.2;
  EXPECT_EQ(count(renderPlot(plot), "class=\"band\""), 1U);
}

TEST(SvgPlot, guideRunsParallelToACurveOfTheIdealSlope) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}, {100, 0.1}})});
  plot.guideSlope = -0.5;
  const std::string svg = renderPlot(plot);
  const std::regex line("class=\"guide\" x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\" y2=\"([0-9.]+)\"");
  std::smatch guide;
  ASSERT_TRUE(std::regex_search(svg, guide, line));
  const std::vector<double> x = numbers(svg, "data-x=\"([0-9.]+)\"");
  const std::vector<double> y = numbers(svg, "data-y=\"([0-9.]+)\"");
  const double slopeOfGuide = (std::stod(guide[4]) - std::stod(guide[2])) / (std::stod(guide[3]) - std::stod(guide[1]));
  EXPECT_NEAR(slopeOfGuide, (y[1] - y[0]) / (x[1] - x[0]), 2e-3);
}

// Bold letters of common fonts are up to 8.7 units wide at the page's size, an m 13; phones get 1.16 times that.
TEST(SvgPlot, longEndLabelsHaveRoomAtTheRight) {
  for (const std::string label : {"pt", "pt independent", "vcm sobol fast"}) {
    const std::string svg = renderPlot(plotOf({curveOf(label, {{1, 1}, {10, 0.1}})}));
    const double x = numbers(svg, "class=\"end-label\" x=\"([0-9.]+)\"").front();
    const double width = numbers(svg, "viewBox=\"0 0 ([0-9.]+) ").front();
    const double wide = static_cast<double>(std::count(label.begin(), label.end(), 'm'));
    EXPECT_LE(x + 1.16 * (8.7 * static_cast<double>(label.size()) + 4.3 * wide), width) << label;
    EXPECT_GT(numbers(svg, "data-x=\"([0-9.]+)\"").back(), 0.4 * width) << "the curves keep most of the plot";
  }
}

TEST(SvgPlot, targetIsDrawnWhereItLiesWithinTheCurves) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}, {10, 0.3}})});
  plot.target = 0.5;
  EXPECT_EQ(count(renderPlot(plot), "class=\"target\""), 1U);
  plot.target = 0.01;
  EXPECT_EQ(count(renderPlot(plot), "class=\"target\""), 0U) << "it must not stretch the axis";
}

// Drawing programs know no CSS variables: a file states its colours.
TEST(SvgPlotFile, standsAloneWithColoursInPlaceOfVariables) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}, {10, 0.3}})});
  plot.title = "a < b";
  const std::string svg = renderPlotFile(plot);
  EXPECT_EQ(svg.find("<svg xmlns=\"http://www.w3.org/2000/svg\""), 0U);
  EXPECT_EQ(svg.find("var("), std::string::npos);
  EXPECT_NE(svg.find(".m-pt { color: #"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b</text>"), std::string::npos);
  EXPECT_EQ(count(svg, "data-x"), 2U);
}

TEST(SvgPlot, escapesLabels) {
  Plot plot = plotOf({curveOf("pt", {{1, 1}})});
  plot.curves[0].label = "a<b";
  plot.curves[0].points[0].tooltip = "\"&\"";
  const std::string svg = renderPlot(plot);
  EXPECT_EQ(svg.find("a<b"), std::string::npos);
  EXPECT_NE(svg.find("a&lt;b"), std::string::npos);
  EXPECT_NE(svg.find("<title>&quot;&amp;&quot;</title>"), std::string::npos);
}

}  // namespace
}  // namespace wavecrest
