#include "bench/report/speedup_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"

namespace wavecrest {
namespace {

// Errors at equal time that reviewers ask for; a report without it takes its first metric.
constexpr const char* kSpeedUpMetric = "relmse";

// One method against a baseline: in each scene, and together.
struct SpeedUpRow {
  std::string method;
  std::vector<std::optional<SpeedUp>> scenes;
  std::optional<SpeedUp> mean;  // geometric, over the scenes that have both
  size_t counted = 0;
};

SpeedUpRow rowOf(const ConvergenceReport& report, const std::string& method, const std::string& baseline,
                 size_t metricIndex) {
  SpeedUpRow row{.method = method, .scenes = {}, .mean = {}};
  double logSum = 0;
  bool least = false, most = false;
  for (const ReportScene& scene : report.scenes) {
    const ReportSeries *own = seriesOf(scene, method), *base = seriesOf(scene, baseline);
    row.scenes.push_back(own != nullptr && base != nullptr
                             ? speedUp(*own, *base, report.metrics[metricIndex], metricIndex)
                             : std::nullopt);
    if (!row.scenes.back()) continue;
    logSum += std::log(row.scenes.back()->factor);
    least = least || row.scenes.back()->bound > 0;
    most = most || row.scenes.back()->bound < 0;
    ++row.counted;
  }
  // A mean of bounds of both kinds is bounded by neither.
  if (row.counted > 0 && !(least && most)) {
    row.mean = SpeedUp{.factor = std::exp(logSum / static_cast<double>(row.counted)),
                       .bound = least  ? 1
                                : most ? -1
                                       : 0};
  }
  return row;
}

std::string speedUpCell(const std::optional<SpeedUp>& value) {
  if (!value) return "<td class=\"n none\">–";
  // A tint of four times is full; slower than the baseline is in the other colour.
  const double strength = std::min(1.0, std::abs(std::log2(value->factor)) / 4);
  const char* const sign = value->bound > 0 ? "≥ " : value->bound < 0 ? "≤ " : "";
  return fmt::format("<td class=\"n {}\" style=\"--behind:{:.2f}\">{}{} ×", value->factor < 1 ? "slower" : "faster",
                     strength, sign, formatSignificant(value->factor));
}

std::string renderAgainst(const ConvergenceReport& report, const std::string& baseline, size_t metricIndex, bool open) {
  std::vector<SpeedUpRow> rows;
  for (const std::string& method : methodsOf(report)) {
    rows.push_back(rowOf(report, method, baseline, metricIndex));
  }
  std::erase_if(rows, [](const SpeedUpRow& row) { return row.counted == 0; });
  if (rows.size() < 2) return "";
  // By the mean where there is one; the baseline's own row stands at 1.
  std::stable_sort(rows.begin(), rows.end(), [](const SpeedUpRow& a, const SpeedUpRow& b) {
    return (a.mean ? a.mean->factor : 0) > (b.mean ? b.mean->factor : 0);
  });
  const bool several = report.scenes.size() > 1;
  std::string html = fmt::format(
      "<details class=\"speedup\" name=\"speedup\"{}><summary>over {}</summary><div class=\"scroll\">"
      "<table class=\"heat\"><thead><tr><th>method",
      open ? " open" : "", escapeHtml(baseline));
  if (several) html += "<th class=\"n\">geometric mean";
  for (const ReportScene& scene : report.scenes) append(html, "<th class=\"n\">{}", escapeHtml(scene.name));
  html += "</thead><tbody>";
  for (const SpeedUpRow& row : rows) {
    append(html, "<tr><th><i class=\"swatch m-{0}\"></i>{0}", escapeHtml(row.method));
    if (several) {
      html += speedUpCell(row.mean);
      if (row.counted < report.scenes.size()) append(html, " <small>of {}</small>", row.counted);
    }
    for (const auto& value : row.scenes) html += speedUpCell(value);
  }
  return html + "</tbody></table></div></details>\n";
}

}  // namespace

std::optional<SpeedUp> speedUp(const ReportSeries& series, const ReportSeries& baseline, const ReportMetric& metric,
                               size_t metricIndex) {
  const double own = finalValue(series, metricIndex), base = finalValue(baseline, metricIndex);
  if (std::isnan(own) || std::isnan(base)) return std::nullopt;
  // The better one reaches the other's last error on its way.
  const bool ahead = !isBetter(metric, base, own);
  const std::optional<TargetTime> time =
      timeToReach(ahead ? series : baseline, metric, metricIndex, ahead ? base : own);
  if (!time || !(time->seconds > 0)) return std::nullopt;
  if (ahead) return SpeedUp{.factor = finalSeconds(baseline) / time->seconds, .bound = time->atMost ? 1 : 0};
  return SpeedUp{.factor = time->seconds / finalSeconds(series), .bound = time->atMost ? -1 : 0};
}

std::string renderSpeedUps(const ConvergenceReport& report) {
  const auto found = std::find_if(report.metrics.begin(), report.metrics.end(),
                                  [](const ReportMetric& metric) { return metric.key == kSpeedUpMetric; });
  const size_t index = found == report.metrics.end() ? 0 : static_cast<size_t>(found - report.metrics.begin());
  const std::vector<std::string> methods = methodsOf(report);
  if (methods.empty()) return "";
  const bool named = std::find(methods.begin(), methods.end(), report.baseline) != methods.end();
  const std::string& chosen = named ? report.baseline : methods.front();
  std::string tables;
  for (const std::string& baseline : methods) tables += renderAgainst(report, baseline, index, baseline == chosen);
  if (tables.empty()) return "";
  return fmt::format(
      "<h3>Speed-up at equal {0}</h3><p class=\"facts\">The baseline's render time over the method's, to the larger of "
      "their two {0} at the end{1}. ≥ and ≤: the first snapshot of the faster one has it already.</p>\n{2}",
      escapeHtml(report.metrics[index].name),
      report.scenes.size() > 1 ? "; the mean is over the scenes that both have been run on" : "", tables);
}

}  // namespace wavecrest
