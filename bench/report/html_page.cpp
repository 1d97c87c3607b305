#include "bench/report/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/report/assets.h"
#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/scene_section.h"

namespace wavecrest {
namespace {

void requireMetricCount(const ConvergenceReport& report, size_t count, const std::string& where) {
  if (count != report.metrics.size()) {
    throw std::invalid_argument(
        fmt::format("report: {} has {} values; expected one per metric, {}", where, count, report.metrics.size()));
  }
}

void validate(const ConvergenceReport& report) {
  if (report.metrics.empty()) throw std::invalid_argument("report: no metric; expected at least one");
  for (const ReportScene& scene : report.scenes) {
    requireMetricCount(report, scene.noiseFloors.size(), scene.name + " noise floor");
    for (const ReportSeries& series : scene.series) {
      if (series.runs.empty()) throw std::invalid_argument("report: " + series.method + " has no run; expected one");
      for (const ReportRun& run : series.runs) {
        for (const ReportPoint& point : run.points) requireMetricCount(report, point.values.size(), series.method);
      }
    }
  }
}

// Every method that occurs, in the order of kMethodStyles, then any others.
std::vector<std::string> methodsOf(const ConvergenceReport& report) {
  std::vector<std::string> methods;
  for (const ReportScene& scene : report.scenes) {
    for (const ReportSeries& series : scene.series) {
      if (std::find(methods.begin(), methods.end(), series.method) == methods.end()) methods.push_back(series.method);
    }
  }
  const auto rank = [](const std::string& method) {
    return std::find_if(kMethodStyles.begin(), kMethodStyles.end(),
                        [&](const MethodStyle& style) { return style.id == method; }) -
           kMethodStyles.begin();
  };
  std::stable_sort(methods.begin(), methods.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return methods;
}

// Scenes x methods by the first metric. Shade says how far a method is behind the best of its row, in factors of two.
std::string renderSummary(const ConvergenceReport& report) {
  const std::vector<std::string> methods = methodsOf(report);
  const ReportMetric& metric = report.metrics.front();
  std::string html = fmt::format(
      "<section><h2>Summary</h2><p class=\"facts\">{} at the end of each run; darker is "
      "further behind the best of the row.</p><div class=\"scroll\"><table class=\"heat\">"
      "<thead><tr><th>scene",
      escapeHtml(metric.name));
  for (const std::string& method : methods) append(html, "<th class=\"n\">{}", escapeHtml(method));
  html += "</thead><tbody>";
  for (size_t i = 0; i < report.scenes.size(); ++i) {
    const ReportScene& scene = report.scenes[i];
    append(html, "<tr><th><a href=\"#scene-{}\">{}</a>", i, escapeHtml(scene.name));
    const double best = bestFinalValue(scene, metric, 0);
    for (const std::string& method : methods) {
      const auto series = std::find_if(scene.series.begin(), scene.series.end(),
                                       [&](const ReportSeries& candidate) { return candidate.method == method; });
      if (series == scene.series.end()) {
        html += "<td class=\"n\">–";
        continue;
      }
      const double value = finalValue(*series, 0);
      const double behind = std::abs(std::log2(value / best));
      append(html, "<td class=\"n{}\" style=\"--behind:{:.2f}\">{}", value == best ? " best" : "",
             std::isfinite(behind) ? std::min(1.0, behind / 4) : 1.0, formatSignificant(value));
    }
  }
  return html + "</tbody></table></div></section>\n";
}

std::string renderEnvironment(const ConvergenceReport& report) {
  std::string html = "<section><h2>Environment</h2><table class=\"pairs\"><tbody>";
  for (const NamedValue& entry : report.environment) {
    append(html, "<tr><th>{}<td>{}", escapeHtml(entry.name), escapeHtml(entry.value));
  }
  return html + "</tbody></table></section>\n";
}

}  // namespace

std::string renderReport(const ConvergenceReport& report) {
  validate(report);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n";
  append(html, "<title>{}</title>\n<style>\n{}</style></head>\n<body>\n<header><h1>{}</h1>\n", escapeHtml(report.title),
         kReportCss, escapeHtml(report.title));
  html += "<p class=\"methods\">";
  for (const std::string& method : methodsOf(report)) {
    append(html, "<span class=\"m-{}\"><i class=\"swatch\"></i><b>{}</b> {}</span> ", escapeHtml(method),
           escapeHtml(method), escapeHtml(methodStyle(method).name));
  }
  html += "</p></header>\n<main>\n";
  if (report.scenes.size() > 1) html += renderSummary(report);
  for (size_t i = 0; i < report.scenes.size(); ++i) html += renderScene(report, i);
  html += renderEnvironment(report);
  append(html, "</main>\n<script>\n{}</script>\n</body></html>\n", kReportJs);
  return html;
}

}  // namespace wavecrest
