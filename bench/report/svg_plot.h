// A line plot as SVG text: curves with marks, bands and end labels over a grid. Carries class names and no colours: the
// style sheet assets/plot.css decides those, for light, dark and print alike.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/report/axis.h"
#include "bench/report/method_style.h"

namespace wavecrest {

struct PlotPoint {
  double x = 0, y = 0;
  double low = 0, high = 0;  ///< band around y; low == high where there is none
  std::string tooltip;       ///< plain text
};

struct PlotCurve {
  std::string label;     ///< short: written at the end of the curve
  std::string cssClass;  ///< carries the colour
  CurveMark mark = CurveMark::kCircle;
  std::vector<PlotPoint> points;  ///< in order of x, at least one
};

/// A horizontal line across the plot.
struct PlotLine {
  double y = 0;
  std::string label;
};

struct Plot {
  std::string title;  ///< for screen readers
  std::string xLabel, yLabel;
  AxisScale xScale = AxisScale::kLogarithmic, yScale = AxisScale::kLogarithmic;
  std::vector<PlotCurve> curves;
  std::optional<PlotLine> floor;     ///< what cannot be passed; the axis is extended to show it
  std::optional<double> target;      ///< line at what is to be reached, where it lies within the curves' range
  std::optional<double> guideSlope;  ///< dashed line y ~ x^slope beside the lowest curve; logarithmic axes only
  std::string guideLabel;
};

/// Puts the points of each curve in order of x.
void sortPoints(Plot& plot);

/// The `<svg>` element, for a page that has the style sheet. Points that an axis cannot show (non-finite, or not
/// positive on a logarithmic axis) are left out; a plot without any point says so instead of drawing axes.
std::string renderPlot(const Plot& plot);

/// The plot as an SVG file of its own, with its title above it and the style sheet inside.
std::string renderPlotFile(const Plot& plot, std::string_view css = {});

}  // namespace wavecrest
