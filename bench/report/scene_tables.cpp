#include "bench/report/scene_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/series_values.h"
#include "bench/report/time_ahead.h"

namespace wavecrest {
namespace {

// The order of a ranking by the first metric; series without a value come last.
std::vector<const ReportSeries*> ranked(const ConvergenceReport& report, const ReportScene& scene) {
  std::vector<const ReportSeries*> order;
  for (const ReportSeries& series : scene.series) order.push_back(&series);
  std::stable_sort(order.begin(), order.end(), [&](const ReportSeries* a, const ReportSeries* b) {
    return isBetter(report.metrics.front(), finalValue(*a, 0), finalValue(*b, 0));
  });
  return order;
}

// The head of a row: colour and label of a series.
std::string methodCell(const ReportSeries& series) {
  return fmt::format("<th><i class=\"swatch m-{}\"></i>{}", escapeHtml(series.method), escapeHtml(series.label));
}

// A dash for zero, which other programs leave open.
std::string countCell(double count) { return count > 0 ? formatCount(count) : "–"; }

// A dash where there is no number.
std::string numberText(double value) { return std::isnan(value) ? "–" : formatSignificant(value); }
std::string scoreText(const ReportMetric& metric, double value) {
  return std::isnan(value) ? "–" : formatScore(metric, value);
}

// "12 s", or for a method that does not end with the target a dash and how much longer it would take.
std::string targetCell(const ReportScene& scene, const ReportSeries& series, const ReportMetric& metric,
                       size_t metricIndex) {
  const std::optional<TargetTime> time = timeToReach(series, metric, metricIndex, *metric.target);
  const bool fastest = isClearlyFastest(scene, series, metric, metricIndex, *metric.target);
  std::string text = time ? formatTime(*time) : "–";
  const std::optional<double> floor = noiseFloorOf(scene, metricIndex);
  if (const auto ahead = timeAhead(series, metric, metricIndex, *metric.target, floor)) {
    text += fmt::format(" <small>{}</small>", formatTimeAhead(*ahead));
  }
  return fmt::format("<td class=\"n{}\">{}", fastest ? " best" : "", text);
}

// Another score of the last snapshots, such as that of a metric without its worst pixels: mean over runs, NaN if none
// has it.
double finalFurther(const ReportSeries& series, const std::string& name) {
  double sum = 0, count = 0;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    for (const NamedNumber& score : run.points.back().further) {
      if (score.name != name) continue;
      sum += score.value;
      ++count;
    }
  }
  return sum / count;
}

// relMSE without the 0.1 % of the pixels with the largest errors: fireflies do not decide it.
constexpr const char* kTrimmedScore = "relmse_trimmed";
constexpr const char* kTrimmedMetric = "relmse";

// One column for each metric; relMSE has a second one without its worst pixels.
std::string renderScores(const ConvergenceReport& report, const ReportScene& scene,
                         const std::vector<const ReportSeries*>& order) {
  const bool trimmed = std::ranges::any_of(
      order, [](const ReportSeries* series) { return std::isfinite(finalFurther(*series, kTrimmedScore)); });
  std::string html = "<div class=\"scroll\"><table class=\"scores\"><thead><tr><th>method";
  for (const ReportMetric& metric : report.metrics) {
    append(html, "<th class=\"n\" title=\"{}\">{}", escapeHtml(metric.formula), escapeHtml(metric.name));
    if (trimmed && metric.key == kTrimmedMetric) {
      append(html, "<th class=\"n\" title=\"without the 0.1 % of the pixels with the largest errors\">{} of 99.9 %",
             escapeHtml(metric.name));
    }
  }
  html += "</thead><tbody>";
  for (const ReportSeries* series : order) {
    html += "<tr>" + methodCell(*series);
    for (size_t m = 0; m < report.metrics.size(); ++m) {
      const bool best = isClearlyBest(scene, *series, report.metrics[m], m);
      append(html, "<td class=\"n{}\">{}", best ? " best" : "", scoreText(report.metrics[m], finalValue(*series, m)));
      if (trimmed && report.metrics[m].key == kTrimmedMetric) {
        append(html, "<td class=\"n\">{}", numberText(finalFurther(*series, kTrimmedScore)));
      }
    }
  }
  return html + "</tbody></table></div>\n";
}

// What the scores took: time, iterations, speed, and the time to each target.
std::string renderCosts(const ConvergenceReport& report, const ReportScene& scene,
                        const std::vector<const ReportSeries*>& order) {
  std::string html =
      "<div class=\"scroll\"><table class=\"costs\"><thead><tr><th>method<th class=\"n\">seeds<th class=\"n\">time"
      "<th class=\"n\">iterations<th class=\"n\">paths/s<th class=\"n\">CPU time";
  for (const ReportMetric& metric : report.metrics) {
    if (metric.target) append(html, "<th class=\"n\">{} {} after", escapeHtml(metric.name), *metric.target);
  }
  html += "</thead><tbody>";
  for (const ReportSeries* series : order) {
    // Iterations are those of the first run. Time and scores are means over runs.
    const ReportRun& run = series->runs.front();
    const ReportPoint last = run.points.empty() ? ReportPoint{} : run.points.back();
    append(html, "<tr>{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}",
           methodCell(*series), series->runs.size(), formatSeconds(finalSeconds(*series)),
           countCell(static_cast<double>(last.iterations)), countCell(series->pathsPerSecond),
           series->cpuSeconds > 0 ? formatSeconds(series->cpuSeconds) : "–");
    for (size_t m = 0; m < report.metrics.size(); ++m) {
      if (report.metrics[m].target) html += targetCell(scene, *series, report.metrics[m], m);
    }
  }
  return html + "</tbody></table></div>\n";
}

// A bar of stage shares and, below it, the figures: nanoseconds an item tell which kernel to look at.
std::string renderStagesOf(const ReportSeries& series) {
  // Shares are of the seconds of all stages together.
  const double total = std::accumulate(series.stages.begin(), series.stages.end(), 0.0,
                                       [](double sum, const ReportStage& stage) { return sum + stage.seconds; });
  if (!(total > 0)) return "";
  std::string bar, rows;
  for (size_t i = 0; i < series.stages.size(); ++i) {
    const ReportStage& stage = series.stages[i];
    const double share = 100 * stage.seconds / total;
    // ns per item; a dash for a stage that does not count items.
    const std::string perItem =
        stage.items > 0 ? formatSignificant(1e9 * stage.seconds / static_cast<double>(stage.items)) : "–";
    // The style sheet has eight colours. A bar segment and its row share one.
    append(bar, "<i class=\"s{}\" style=\"width:{:.2f}%\" title=\"{} {:.1f} %\"></i>", i % 8, share,
           escapeHtml(stage.name), share);
    append(rows,
           "<tr><th><i class=\"swatch s{}\"></i>{}<td class=\"n\">{:.1f} %<td class=\"n\">{}<td class=\"n\">{}"
           "<td class=\"n\">{}",
           i % 8, escapeHtml(stage.name), share, formatSeconds(stage.seconds),
           formatCount(static_cast<double>(stage.items)), perItem);
  }
  return fmt::format(
      "<div class=\"card stages\"><h4><i class=\"swatch m-{0}\"></i>{1} <small>{2} paths/s</small></h4>"
      "<div class=\"bar\">{3}</div><div class=\"scroll\"><table><thead><tr><th>stage<th class=\"n\">share"
      "<th class=\"n\">time<th class=\"n\">items<th "
      "class=\"n\">ns/item</thead><tbody>{4}</tbody></table></div></div>\n",
      escapeHtml(series.method), escapeHtml(series.label), formatCount(series.pathsPerSecond), bar, rows);
}

}  // namespace

std::string renderResults(const ConvergenceReport& report, const ReportScene& scene) {
  const std::vector<const ReportSeries*> order = ranked(report, scene);
  std::string html = renderScores(report, scene, order) + renderCosts(report, scene, order);
  // Methods that cannot render the scene stand below the table.
  for (const NamedValue& refusal : scene.refusals)
    append(html, "<p class=\"facts\"><b>{}</b> was refused: {}</p>\n", escapeHtml(refusal.name),
           escapeHtml(refusal.value));
  return html;
}

std::string renderBias(const ReportScene& scene) {
  std::string rows;
  for (const ReportSeries& series : scene.series) {
    if (series.bias.empty()) continue;
    // The table shows the last snapshot, the plot of bias shows all of them.
    const ReportBias& last = series.bias.back();
    const std::optional<double> share = shareOfBias(last);
    append(rows, "<tr>{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}",
           methodCell(series), last.seeds, numberText(last.meanSquareError), numberText(last.variance),
           numberText(last.bias2), share ? fmt::format("{:.1f} %", 100 * *share) : "–");
  }
  if (rows.empty()) return "";
  return "<h3>Bias and variance at the end</h3><p class=\"facts\">Mean square error over several seeds, without the "
         "noise of the reference. Variance falls with more samples, bias does not; a bias² around zero, of either "
         "sign, is none that these seeds could show. Of fewer than four seeds the share of bias is not told, as it "
         "would come from too few pairs, nor of an error that is not above zero.</p><div "
         "class=\"scroll\"><table><thead><tr><th>method"
         "<th class=\"n\">seeds<th class=\"n\">MSE<th class=\"n\">variance<th class=\"n\">bias²"
         "<th class=\"n\">share of bias</thead><tbody>" +
         rows + "</tbody></table></div>\n";
}

std::string renderPathClasses(const ReportScene& scene) {
  if (scene.pathClasses.empty()) return "";
  std::string html =
      "<h3>Which paths a method can find</h3><div class=\"scroll\"><table class=\"classes\"><thead><tr>"
      "<th>light path";
  // The first row names the columns. All rows list the same methods in the same order.
  for (const NamedValue& verdict : scene.pathClasses.front().verdicts)
    append(html, "<th><i class=\"swatch m-{0}\"></i>{0}", escapeHtml(verdict.name));
  html += "</thead><tbody>";
  // Signatures are those of `wavecrest inspect`.
  const std::string legend =
      "<p class=\"facts\">A: area light or sky, P: point light or direction, D: diffuse or glossy surface, S: mirror "
      "or "
      "glass, S+: one or more of them, D D: two or more in a row, E: eye.</p>\n";
  for (const ReportPathClass& pathClass : scene.pathClasses) {
    append(html, "<tr><th><code>{}</code>", escapeHtml(pathClass.name));
    for (const NamedValue& verdict : pathClass.verdicts)
      append(html, "<td class=\"v-{}\">{}", escapeHtml(verdict.value), escapeHtml(verdict.value));
  }
  return html + "</tbody></table></div>\n" + legend;
}

std::string renderStages(const ReportScene& scene) {
  std::string stages;
  for (const ReportSeries& series : scene.series) stages += renderStagesOf(series);
  if (stages.empty()) return "";
  return "<details><summary>Where the time went</summary><div class=\"grid\">\n" + stages + "</div></details>\n";
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

}  // namespace wavecrest
