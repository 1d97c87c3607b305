#include "bench/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/report/assets.h"
#include "bench/report/html_text.h"

namespace wavecrest {
namespace {

// Small in user units, so that text stays readable when a phone shows the plot 330 pixels wide.
constexpr double kWidth = 460, kHeight = 320;
constexpr double kTop = 12, kBottom = kHeight - 46;
constexpr double kLeastLeft = 50, kTickGap = 7;  // the margin at the left, and what is between a label and the axis
constexpr double kNameRoom = 17;                 // at the left of tick labels, for the name of the y axis
constexpr double kMarkRoom = 18;                 // between the plot and the text of an end label
constexpr double kLeastMargin = 44, kGreatestMargin = 190;  // at the right
constexpr double kLabelSpacing = 15;
constexpr double kTitleHeight = 26;  // above the plot in a file
constexpr size_t kDensePoints = 24;  // from here on marks shrink to dots

// Maps values to user units of the SVG, in which y grows downwards: the plot area reaches from `left` to `right` and
// from kTop down to kBottom.
struct Frame {
  Axis x, y;
  double left, right;
  double pixelX(double value) const { return left + x.position(value) * (right - left); }
  double pixelY(double value) const { return kBottom - y.position(value) * (kBottom - kTop); }
};

// Whether an axis can show a value at all.
bool showable(AxisScale scale, double value) {
  return std::isfinite(value) && (scale == AxisScale::kLinear || value > 0);
}

// The curves without what the axes cannot show.
std::vector<PlotCurve> showableCurves(const Plot& plot) {
  std::vector<PlotCurve> curves = plot.curves;
  for (PlotCurve& curve : curves) {
    std::erase_if(curve.points, [&](const PlotPoint& point) {
      return !showable(plot.xScale, point.x) || !showable(plot.yScale, point.y);
    });
    // A band is dropped where the axis cannot show one of its ends.
    for (PlotPoint& point : curve.points) {
      if (!showable(plot.yScale, point.low) || !showable(plot.yScale, point.high)) point.low = point.high = point.y;
    }
  }
  std::erase_if(curves, [](const PlotCurve& curve) { return curve.points.empty(); });
  return curves;
}

// The left margin takes the longest label of the axis.
double leftMargin(const Axis& axis) {
  constexpr double kLetter = 9;
  // Bytes 10xxxxxx continue a character of UTF-8.
  size_t longest = 0;  // in characters of UTF-8
  for (const AxisTick& tick : axis.ticks()) {
    const auto begins = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; };
    longest = std::max<size_t>(longest, std::count_if(tick.label.begin(), tick.label.end(), begins));
  }
  return std::max(kLeastLeft, kTickGap + kLetter * static_cast<double>(longest));
}

// What an end label needs at most: bold letters of a wide font, at the size that phones get (assets/report.css).
double labelWidth(const std::string& label) {
  double width = 0;
  for (const char letter : label) width += letter == 'm' || letter == 'w' ? 15 : 10.5;
  return width;
}

// Axes around all curves with their bands, and margins that take all labels.
Frame frameAround(const Plot& plot, const std::vector<PlotCurve>& curves) {
  // Find the range of the data.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double left = kInfinity, right = -kInfinity, low = kInfinity, high = -kInfinity;
  for (const PlotCurve& curve : curves) {
    for (const PlotPoint& point : curve.points) {
      left = std::min(left, point.x);
      right = std::max(right, point.x);
      low = std::min({low, point.y, point.low});
      high = std::max({high, point.y, point.high});
    }
  }
  // The floor line extends the range. The target line does not.
  if (plot.floor && showable(plot.yScale, plot.floor->y)) {
    low = std::min(low, plot.floor->y);
    high = std::max(high, plot.floor->y);
  }
  // The right margin takes the longest label.
  double longest = 0;
  for (const PlotCurve& curve : curves) longest = std::max(longest, labelWidth(curve.label));
  const double margin = kMarkRoom + longest;
  const Axis y(plot.yScale, low, high);
  const double name = plot.yLabel.empty() ? 0 : kNameRoom;
  return {Axis(plot.xScale, left, right), y, name + leftMargin(y),
          kWidth - std::clamp(margin, kLeastMargin, kGreatestMargin)};
}

// Grid lines, tick labels, axis lines and the names of both axes.
void drawGrid(std::string& svg, const Plot& plot, const Frame& frame) {
  // Vertical lines, with labels below.
  for (const AxisTick& tick : frame.x.ticks()) {
    const double x = frame.pixelX(tick.value);
    append(svg, "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{}\" x2=\"{:.1f}\" y2=\"{}\"/>",
           tick.label.empty() ? "minor" : "major", x, kTop, x, kBottom);
    if (!tick.label.empty()) {
      append(svg, "<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", x, kBottom + 17,
             tick.label);
    }
  }
  // Horizontal lines, with labels at the left.
  for (const AxisTick& tick : frame.y.ticks()) {
    const double y = frame.pixelY(tick.value);
    append(svg, "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
           tick.label.empty() ? "minor" : "major", frame.left, y, frame.right, y);
    if (!tick.label.empty()) {
      append(svg, "<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", frame.left - kTickGap,
             y + 4, tick.label);
    }
  }
  // The two axes and their names.
  append(svg, "<path class=\"axis\" d=\"M{:.1f} {}V{}H{:.1f}\"/>", frame.left, kTop, kBottom, frame.right);
  append(svg, "<text class=\"axis-label\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
         0.5 * (frame.left + frame.right), kHeight - 8, escapeHtml(plot.xLabel));
  if (plot.yLabel.empty()) return;
  append(svg,
         "<text class=\"axis-label\" transform=\"translate(13 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
         0.5 * (kTop + kBottom), escapeHtml(plot.yLabel));
}

// Whether a horizontal line lies within the y axis.
bool isWithin(const PlotLine& line, AxisScale scale, const Frame& frame) {
  return showable(scale, line.y) && frame.y.position(line.y) >= 0 && frame.y.position(line.y) <= 1;
}

// A horizontal line across the plot, unless it lies outside the y axis.
void drawLine(std::string& svg, const PlotLine& line, const char* cssClass, AxisScale scale, const Frame& frame) {
  if (!isWithin(line, scale, frame)) return;
  const double y = frame.pixelY(line.y);
  append(svg, "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", cssClass, frame.left, y,
         frame.right, y);
}

// Its label, which curves drawn before do not hide.
void drawLineLabel(std::string& svg, const PlotLine& line, AxisScale scale, const Frame& frame) {
  if (line.label.empty() || !isWithin(line, scale, frame)) return;
  const double y = frame.pixelY(line.y);
  // Above the line, or below it where there is no room.
  append(svg, "<text class=\"note\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", frame.left + 6,
         y - kTop < 18 ? y + 14 : y - 5, escapeHtml(line.label));
}

// Draws y ~ x^slope as a straight line on two logarithmic axes, a little above the curve that ends lowest.
void drawGuide(std::string& svg, const Plot& plot, const Frame& frame, const std::vector<PlotCurve>& curves) {
  constexpr double kAbove = 1.7;
  if (!plot.guideSlope || plot.xScale != AxisScale::kLogarithmic || plot.yScale != AxisScale::kLogarithmic) return;
  const auto& lowest = *std::min_element(curves.begin(), curves.end(), [](const PlotCurve& a, const PlotCurve& b) {
    return a.points.back().y < b.points.back().y;
  });
  // The line passes above the end of that curve by the factor kAbove.
  const PlotPoint& anchor = lowest.points.back();
  const auto guide = [&](double x) { return kAbove * anchor.y * std::pow(x / anchor.x, *plot.guideSlope); };
  const auto inverse = [&](double y) { return anchor.x * std::pow(y / (kAbove * anchor.y), 1 / *plot.guideSlope); };
  // It spans that curve in x, as far as the y axis reaches. The cuts assume a negative slope.
  double first = lowest.points.front().x, last = anchor.x;
  if (guide(first) > frame.y.high()) first = inverse(frame.y.high());
  if (guide(last) < frame.y.low()) last = inverse(frame.y.low());
  if (!(first < last)) return;
  append(svg, "<line class=\"guide\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", frame.pixelX(first),
         frame.pixelY(guide(first)), frame.pixelX(last), frame.pixelY(guide(last)));
  const double labelX = std::sqrt(first * last);
  append(svg, "<text class=\"note\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", frame.pixelX(labelX) + 6,
         frame.pixelY(guide(labelX)) - 6, escapeHtml(plot.guideLabel));
}

// SVG path data of a mark centred at (x, y). Its half width is about r user units.
std::string markPath(CurveMark mark, double x, double y, double r) {
  switch (mark) {
    case CurveMark::kSquare:
      return fmt::format("M{:.1f} {:.1f}h{}v{}h{}z", x - r, y - r, 2 * r, 2 * r, -2 * r);
    case CurveMark::kTriangleUp:
      return fmt::format("M{:.1f} {:.1f}l{} {}h{}z", x, y - 1.2 * r, 1.2 * r, 2.1 * r, -2.4 * r);
    case CurveMark::kTriangleDown:
      return fmt::format("M{:.1f} {:.1f}l{} {}h{}z", x, y + 1.2 * r, 1.2 * r, -2.1 * r, -2.4 * r);
    case CurveMark::kDiamond:
      return fmt::format("M{:.1f} {:.1f}l{} {}l{} {}l{} {}z", x, y - 1.3 * r, 1.3 * r, 1.3 * r, -1.3 * r, 1.3 * r,
                         -1.3 * r, -1.3 * r);
    case CurveMark::kPlus:
      return fmt::format("M{:.1f} {:.1f}h{}M{:.1f} {:.1f}v{}", x - 1.2 * r, y, 2.4 * r, x, y - 1.2 * r, 2.4 * r);
    case CurveMark::kCross:
      return fmt::format("M{:.1f} {:.1f}l{} {}M{:.1f} {:.1f}l{} {}", x - r, y - r, 2 * r, 2 * r, x - r, y + r, 2 * r,
                         -2 * r);
    case CurveMark::kCircle:
      break;
  }
  return fmt::format("M{:.1f} {:.1f}a{} {} 0 1 0 {} 0a{} {} 0 1 0 {} 0z", x - r, y, r, r, 2 * r, r, r, -2 * r);
}

// The area between the low and high ends of all points. A curve without any band gets none.
void drawBand(std::string& svg, const PlotCurve& curve, const Frame& frame) {
  const bool visible = std::any_of(curve.points.begin(), curve.points.end(),
                                   [](const PlotPoint& point) { return point.low < point.high; });
  if (!visible) return;
  // Go forward along the upper edge and back along the lower one.
  svg += "<path class=\"band\" d=\"";
  char command = 'M';
  for (const PlotPoint& point : curve.points) {
    append(svg, "{}{:.1f} {:.1f}", command, frame.pixelX(point.x), frame.pixelY(point.high));
    command = 'L';
  }
  for (auto point = curve.points.rbegin(); point != curve.points.rend(); ++point) {
    append(svg, "L{:.1f} {:.1f}", frame.pixelX(point->x), frame.pixelY(point->low));
  }
  svg += "z\"/>";
}

// Band below, line, then marks with their tooltips; data-x and data-y let the script find the mark near the pointer.
void drawCurve(std::string& svg, const PlotCurve& curve, const Frame& frame) {
  append(svg, "<g class=\"curve {}\" data-label=\"{}\">", curve.cssClass, escapeHtml(curve.label));
  drawBand(svg, curve, frame);
  svg += "<path class=\"line\" d=\"";
  char command = 'M';
  for (const PlotPoint& point : curve.points) {
    append(svg, "{}{:.1f} {:.1f}", command, frame.pixelX(point.x), frame.pixelY(point.y));
    command = 'L';
  }
  svg += "\"/>";
  const double radius = curve.points.size() < kDensePoints ? 3.2 : 1.6;
  for (const PlotPoint& point : curve.points) {
    const double x = frame.pixelX(point.x), y = frame.pixelY(point.y);
    append(svg, "<path class=\"mark\" data-x=\"{:.1f}\" data-y=\"{:.1f}\" d=\"{}\"><title>{}</title></path>", x, y,
           markPath(curve.mark, x, y, radius), escapeHtml(point.tooltip));
  }
  svg += "</g>";
}

// Labels at the ends of the curves are the legend: in the order of the curves, moved apart where they would overlap.
void drawEndLabels(std::string& svg, const std::vector<PlotCurve>& curves, const Frame& frame) {
  struct Label {
    const PlotCurve* curve;
    double y;
  };
  std::vector<Label> labels;
  labels.reserve(curves.size());
  for (const PlotCurve& curve : curves) labels.push_back({&curve, frame.pixelY(curve.points.back().y)});
  std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
  // Closer together where so many would not fit between the edges.
  const double gaps = static_cast<double>(std::max<size_t>(labels.size(), 2)) - 1;
  const double spacing = std::min(kLabelSpacing, (kBottom - kTop) / gaps);
  // Downwards until each has room, then upwards from the lower edge for those that were pushed out.
  for (size_t i = 1; i < labels.size(); ++i) labels[i].y = std::max(labels[i].y, labels[i - 1].y + spacing);
  double limit = kBottom;
  for (size_t i = labels.size(); i-- > 0; limit = labels[i].y - spacing) {
    labels[i].y = std::min(labels[i].y, limit);
  }
  for (const Label& label : labels) {
    append(svg, "<g class=\"curve end {}\" data-label=\"{}\"><path class=\"mark\" d=\"{}\"/>", label.curve->cssClass,
           escapeHtml(label.curve->label), markPath(label.curve->mark, frame.right + 10, label.y, 3.2));
    append(svg, "<text class=\"end-label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>", frame.right + kMarkRoom,
           label.y + 4, escapeHtml(label.curve->label));
  }
}

// A style sheet with the values of its first block in place of its variables. Drawing programs that open the file do
// not know CSS variables.
std::string withoutVariables(std::string_view css) {
  std::string result(css);
  const std::string block = result.substr(0, result.find('}'));
  // Replace every use of each variable that the block declares.
  size_t end = 0;  // of a declaration, which is `--name: value;`
  for (size_t begin = block.find("--"); begin != std::string::npos; begin = block.find("--", end)) {
    const size_t colon = block.find(": ", begin);
    end = block.find(';', begin);
    const std::string use = fmt::format("var({})", block.substr(begin, colon - begin));
    const std::string value = block.substr(colon + 2, end - colon - 2);
    for (size_t at = result.find(use); at != std::string::npos; at = result.find(use, at))
      result.replace(at, use.size(), value);
  }
  // Leave out the block itself.
  return result.substr(result.find('}') + 1);
}

// Everything inside the <svg> element.
std::string drawPlot(const Plot& plot) {
  const std::vector<PlotCurve> curves = showableCurves(plot);
  std::string svg;
  if (curves.empty()) {
    append(svg,
           "<text class=\"note\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">no data that these axes can show</text>",
           kWidth / 2, kHeight / 2);
    return svg;
  }
  // Later elements cover earlier ones, so grid and lines lie below the curves.
  const Frame frame = frameAround(plot, curves);
  drawGrid(svg, plot, frame);
  if (plot.target) drawLine(svg, {*plot.target, ""}, "target", plot.yScale, frame);
  if (plot.floor) drawLine(svg, *plot.floor, "floor", plot.yScale, frame);
  for (const PlotCurve& curve : curves) drawCurve(svg, curve, frame);
  drawGuide(svg, plot, frame, curves);
  if (plot.floor) drawLineLabel(svg, *plot.floor, plot.yScale, frame);
  drawEndLabels(svg, curves, frame);
  return svg;
}

}  // namespace

void sortPoints(Plot& plot) {
  for (PlotCurve& curve : plot.curves) {
    std::sort(curve.points.begin(), curve.points.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  }
}

std::string renderPlot(const Plot& plot) {
  return fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>\n", kWidth,
                     kHeight, escapeHtml(plot.title), drawPlot(plot));
}

std::string renderPlotFile(const Plot& plot, std::string_view css) {
  // The title stands above y = 0, so the view box begins at a negative y.
  const double height = kHeight + kTitleHeight;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 {} {} {}\" width=\"{}\" height=\"{}\">\n"
      "<title>{}</title>\n<style>\n{}svg {{ background: #fff; font-family: sans-serif; }}\n</style>\n"
      "<text class=\"title\" x=\"{}\" y=\"{}\">{}</text>\n{}</svg>\n",
      -kTitleHeight, kWidth, height, 1.5 * kWidth, 1.5 * height, escapeHtml(plot.title),
      withoutVariables(std::string(kPlotCss) + std::string(css)), kLeastLeft, -8, escapeHtml(plot.title),
      drawPlot(plot));
}

}  // namespace wavecrest
