#include "bench/report/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bench/report/answer_section.h"
#include "bench/report/assets.h"
#include "bench/report/embedded_images.h"
#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/plain_page.h"
#include "bench/report/samples_section.h"
#include "bench/report/scene_section.h"
#include "bench/report/series_values.h"
#include "bench/report/speedup_section.h"
#include "bench/report/summary_section.h"

namespace wavecrest {
namespace {

// A size that mail and wikis still accept. Images get the part that the text leaves.
constexpr size_t kPageBytes = 7'600'000;

// Throws unless a vector that is parallel to the metrics has one entry for each.
void requireMetricCount(const ConvergenceReport& report, size_t count, const std::string& where) {
  if (count != report.metrics.size()) {
    throw std::invalid_argument(
        fmt::format("report: {} has {} values; expected one per metric, {}", where, count, report.metrics.size()));
  }
}

// Throws std::invalid_argument unless all sections can index the data safely.
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

// Facts of the machine and the campaign, as a table of names and values.
std::string renderEnvironment(const ConvergenceReport& report) {
  std::string html = "<section id=\"environment\"><h2>Environment</h2><table class=\"pairs\"><tbody>";
  for (const NamedValue& entry : report.environment) {
    append(html, "<tr><th>{}<td>{}", escapeHtml(entry.name), escapeHtml(entry.value));
  }
  return html + "</tbody></table></section>\n";
}

// What a reader must know; behind a click where it is long, so that the answer stays in sight of the figures.
std::string renderRemarks(const ConvergenceReport& report, const EmbeddedImages& images) {
  constexpr size_t kShortList = 3;
  std::vector<std::string> remarks = report.remarks;
  if (!images.remark().empty()) remarks.push_back(images.remark());
  std::string html;
  for (const std::string& remark : remarks) append(html, "<p class=\"facts\">{}</p>\n", escapeHtml(remark));
  if (remarks.size() <= kShortList) return html;
  return fmt::format("<details class=\"remarks\"><summary>{} remarks</summary>{}</details>\n", remarks.size(), html);
}

// Title, legend of methods, answers and remarks.
std::string renderHeader(const ConvergenceReport& report, const EmbeddedImages& images) {
  std::string html = fmt::format("<header><h1>{}</h1>\n<p class=\"methods\">", escapeHtml(report.title));
  for (const std::string& method : methodsOf(report)) {
    append(html, "<span><i class=\"swatch m-{0}\"></i><b>{0}</b> {1}</span> ", escapeHtml(method),
           escapeHtml(methodStyle(method).name));
  }
  return html + "</p>\n" + renderAnswer(report) + renderRemarks(report, images) + "</header>\n";
}

// Where to go on a long page; a single scene needs none.
std::string renderContents(const ConvergenceReport& report) {
  std::string html = "<nav><a href=\"#summary\">Summary</a> ";
  for (size_t i = 0; i < report.scenes.size(); ++i)
    append(html, "<a href=\"#scene-{}\">{}</a> ", i, escapeHtml(report.scenes[i].name));
  html += "<a href=\"#scores\">All scores</a> ";
  if (!report.claims.empty()) html += "<a href=\"#claims\">Findings</a> ";
  return html + "<a href=\"#environment\">Environment</a></nav>\n";
}

// The whole document: the answer, the scenes with plots and pictures, then what compares them and judges the study. A
// single scene needs no summary.
std::string assemble(const ConvergenceReport& report, const EmbeddedImages& images) {
  const bool several = report.scenes.size() > 1;
  std::string html = pageHead(report.title, coloursOfOthers(report));
  html += renderHeader(report, images);
  if (several) html += renderContents(report);
  html += "<main>\n";
  if (several) {
    html += "<section id=\"summary\"><h2>Summary</h2>\n" + renderTargetMaps(report) + renderSpeedUps(report) +
            renderEqualSamples(report) + "</section>\n";
  }
  for (size_t i = 0; i < report.scenes.size(); ++i) html += renderScene(report, i, images);
  if (several) {
    html += "<section id=\"scores\"><h2>All scores</h2>\n" + renderRanking(report) + renderHeatMaps(report) +
            "</section>\n";
  } else if (const std::string speedUps = renderSpeedUps(report) + renderEqualSamples(report); !speedUps.empty()) {
    html += "<section id=\"speedups\">" + speedUps + "</section>\n";
  }
  html += renderClaims(report);
  html += renderEnvironment(report);
  // The page is complete without the script, which only adds interaction.
  append(html, "</main>\n<script>\n{}{}</script>\n</body></html>\n", kFloatsJs, kReportJs);
  return html;
}

}  // namespace

std::string renderReport(const ConvergenceReport& report) {
  validate(report);
  // The page is assembled twice: once without images to learn the size of its text, then with images in the rest.
  const size_t text = assemble(report, EmbeddedImages()).size();
  const EmbeddedImages images(report, kPageBytes - std::min(kPageBytes, text));
  return assemble(report, images);
}

}  // namespace wavecrest
