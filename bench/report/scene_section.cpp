#include "bench/report/scene_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bench/report/html_text.h"
#include "bench/report/png_embedding.h"
#include "bench/report/svg_plot.h"

namespace wavecrest {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The colour of the method; further series of the same method are told apart by dashes.
std::string seriesClass(const ReportScene& scene, const ReportSeries& series) {
  int earlier = 0;
  for (const ReportSeries& other : scene.series) {
    if (&other == &series) break;
    earlier += other.method == series.method ? 1 : 0;
  }
  return fmt::format("m-{} variant-{}", escapeHtml(series.method), earlier);
}

// Runs of one series meet at their k-th snapshot, since all were asked for the same times: the curve is the mean over
// the runs that got there, the band their extremes.
std::vector<PlotPoint> meanOverRuns(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex) {
  size_t longest = 0;
  for (const ReportRun& run : series.runs) longest = std::max(longest, run.points.size());
  std::vector<PlotPoint> points;
  for (size_t k = 0; k < longest; ++k) {
    PlotPoint mean;
    mean.low = std::numeric_limits<double>::infinity();
    mean.high = -mean.low;
    double count = 0, iterations = 0;
    for (const ReportRun& run : series.runs) {
      if (k >= run.points.size()) continue;
      const double value = run.points[k].values[metricIndex];
      mean.x += run.points[k].seconds;
      mean.y += value;
      mean.low = std::min(mean.low, value);
      mean.high = std::max(mean.high, value);
      iterations += static_cast<double>(run.points[k].iterations);
      ++count;
    }
    mean.x /= count;
    mean.y /= count;
    mean.tooltip = fmt::format("{}: {} {} after {}, {} iterations", series.label, metric.name,
                               formatSignificant(mean.y), formatSeconds(mean.x), formatCount(iterations / count));
    points.push_back(std::move(mean));
  }
  return points;
}

std::string renderMetricPlot(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex) {
  Plot plot;
  plot.title = metric.name + " over render time, " + scene.name;
  plot.xLabel = "render time in seconds";
  plot.yScale = metric.logarithmic ? AxisScale::kLogarithmic : AxisScale::kLinear;
  plot.floor = scene.noiseFloors[metricIndex];
  plot.floorLabel = "noise of the reference";
  plot.guideSlope = metric.idealSlope;
  if (metric.idealSlope) plot.guideLabel = *metric.idealSlope == -0.5 ? "1/√t" : "1/t";
  for (const ReportSeries& series : scene.series) {
    plot.curves.push_back({.label = series.label,
                           .cssClass = seriesClass(scene, series),
                           .mark = methodStyle(series.method).mark,
                           .points = meanOverRuns(series, metric, metricIndex)});
  }
  return fmt::format("<figure class=\"card\"><figcaption><b>{}</b> {}</figcaption>{}</figure>\n",
                     escapeHtml(metric.name), escapeHtml(metric.explanation), renderPlot(plot));
}

// The order of a ranking by the first metric; series without a value come last.
std::vector<const ReportSeries*> ranked(const ConvergenceReport& report, const ReportScene& scene) {
  std::vector<const ReportSeries*> order;
  for (const ReportSeries& series : scene.series) order.push_back(&series);
  const double sign = report.metrics.front().higherIsBetter ? -1 : 1;
  std::stable_sort(order.begin(), order.end(), [&](const ReportSeries* a, const ReportSeries* b) {
    const double valueA = sign * finalValue(*a, 0), valueB = sign * finalValue(*b, 0);
    return std::isnan(valueB) ? !std::isnan(valueA) : valueA < valueB;
  });
  return order;
}

std::string renderResults(const ConvergenceReport& report, const ReportScene& scene) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>method<th class=\"n\">runs<th class=\"n\">time"
      "<th class=\"n\">iterations";
  for (const ReportMetric& metric : report.metrics) append(html, "<th class=\"n\">{}", escapeHtml(metric.name));
  html += "<th class=\"n\">paths/s<th class=\"n\">CPU time</thead><tbody>";
  for (const ReportSeries* series : ranked(report, scene)) {
    const ReportRun& run = series->runs.front();
    const ReportPoint last = run.points.empty() ? ReportPoint{} : run.points.back();
    append(html,
           "<tr><th class=\"m-{}\"><i class=\"swatch\"></i>{} <small>{}</small><td class=\"n\">{}<td class=\"n\">{}",
           escapeHtml(series->method), escapeHtml(series->label), escapeHtml(methodStyle(series->method).name),
           series->runs.size(), formatSeconds(last.seconds));
    append(html, "<td class=\"n\">{}", formatCount(static_cast<double>(last.iterations)));
    for (size_t m = 0; m < report.metrics.size(); ++m) {
      const double value = finalValue(*series, m);
      const bool best = scene.series.size() > 1 && value == bestFinalValue(scene, report.metrics[m], m);
      append(html, "<td class=\"n{}\">{}", best ? " best" : "", std::isnan(value) ? "–" : formatSignificant(value));
    }
    append(html, "<td class=\"n\">{}<td class=\"n\">{}", formatCount(series->pathsPerSecond),
           formatSeconds(series->cpuSeconds));
  }
  return html + "</tbody></table></div>\n";
}

void appendImage(std::string& html, const ReportImage& image, const std::string& caption) {
  append(html,
         "<figure class=\"pane\"><div class=\"frame\"><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\"></div>",
         pngDataUri(image), image.width, image.height, escapeHtml(caption));
  append(html, "<figcaption>{}</figcaption></figure>\n", escapeHtml(caption));
}

std::string renderImages(const ReportScene& scene) {
  std::string html = "<div class=\"viewer\"><div class=\"panes\">\n";
  appendImage(html, scene.reference, "reference");
  for (const ReportSeries& series : scene.series) {
    for (const ReportImage& image : series.snapshots) appendImage(html, image, image.label);
  }
  return html + "</div></div>\n";
}

// A bar of stage shares and, below it, the figures: nanoseconds an item tell which kernel to look at.
std::string renderStages(const ReportSeries& series) {
  const double total = std::accumulate(series.stages.begin(), series.stages.end(), 0.0,
                                       [](double sum, const ReportStage& stage) { return sum + stage.seconds; });
  if (!(total > 0)) return "";
  std::string bar, rows;
  for (size_t i = 0; i < series.stages.size(); ++i) {
    const ReportStage& stage = series.stages[i];
    const double share = 100 * stage.seconds / total;
    const std::string perItem =
        stage.items > 0 ? formatSignificant(1e9 * stage.seconds / static_cast<double>(stage.items)) : "–";
    append(bar, "<i class=\"s{}\" style=\"width:{:.2f}%\" title=\"{} {:.1f} %\"></i>", i % 8, share,
           escapeHtml(stage.name), share);
    append(rows,
           "<tr><th><i class=\"swatch s{}\"></i>{}<td class=\"n\">{:.1f} %<td class=\"n\">{}<td class=\"n\">{}"
           "<td class=\"n\">{}",
           i % 8, escapeHtml(stage.name), share, formatSeconds(stage.seconds),
           formatCount(static_cast<double>(stage.items)), perItem);
  }
  return fmt::format(
      "<div class=\"card stages\"><h4 class=\"m-{0}\"><i class=\"swatch\"></i>{1}</h4><div class=\"bar\">{2}"
      "</div><div class=\"scroll\"><table><thead><tr><th>stage<th class=\"n\">share<th class=\"n\">time"
      "<th class=\"n\">items<th class=\"n\">ns/item</thead><tbody>{3}</tbody></table></div></div>\n",
      escapeHtml(series.method), escapeHtml(series.label), bar, rows);
}

std::string renderSettings(const ReportScene& scene) {
  std::string html = "<details><summary>Settings of each run</summary><div class=\"grid\">\n";
  for (const ReportSeries& series : scene.series) {
    append(html, "<table class=\"pairs\"><caption>{}</caption><tbody>", escapeHtml(series.label));
    for (const NamedValue& setting : series.settings) {
      append(html, "<tr><th>{}<td>{}", escapeHtml(setting.name), escapeHtml(setting.value));
    }
    html += "</tbody></table>\n";
  }
  return html + "</div></details>\n";
}

}  // namespace

double finalValue(const ReportSeries& series, size_t metric) {
  double sum = 0, count = 0;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    sum += run.points.back().values[metric];
    ++count;
  }
  return count > 0 ? sum / count : kNan;
}

double bestFinalValue(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex) {
  double best = kNan;
  for (const ReportSeries& series : scene.series) {
    const double value = finalValue(series, metricIndex);
    if (std::isnan(best) || (metric.higherIsBetter ? value > best : value < best)) best = value;
  }
  return best;
}

std::string renderScene(const ConvergenceReport& report, size_t index) {
  const ReportScene& scene = report.scenes[index];
  std::string html;
  append(html, "<section id=\"scene-{}\"><h2>{}</h2><p class=\"facts\">{} × {} pixels. Reference: {}.</p>\n", index,
         escapeHtml(scene.name), scene.width, scene.height, escapeHtml(scene.referenceOrigin));
  html += "<h3>Error over time</h3><div class=\"grid\">\n";
  for (size_t m = 0; m < report.metrics.size(); ++m) html += renderMetricPlot(scene, report.metrics[m], m);
  html += "</div>\n<h3>At the end</h3>\n" + renderResults(report, scene);
  html += "<h3>Images</h3>\n" + renderImages(scene);
  std::string stages;
  for (const ReportSeries& series : scene.series) stages += renderStages(series);
  if (!stages.empty()) html += "<h3>Where the time went</h3><div class=\"grid\">\n" + stages + "</div>\n";
  return html + renderSettings(scene) + "</section>\n";
}

}  // namespace wavecrest
