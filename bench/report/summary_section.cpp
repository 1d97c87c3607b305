#include "bench/report/summary_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/series_values.h"

namespace wavecrest {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One heat map, a table of scenes x methods. `value` is the number of a cell, and `text` is what the cell shows.
// `behind` is the distance from the best of the row: 0 at the best, 1 or more for the full tint.
struct HeatMap {
  std::string name, explanation;
  std::function<double(const ReportScene&, const ReportSeries&)> value;
  std::function<double(double value, double best)> behind;
  std::function<std::string(const ReportSeries&, double)> text;
  std::function<bool(const ReportScene&, const ReportSeries&)> isBest;  // beyond noise
  bool higherIsBetter = false;
};

// Scores at the ends of the runs. The tint of a logarithmic metric grows with the factor between score and best, up to
// a factor of 16. The tint of any other metric grows with the difference, up to half of the best.
HeatMap metricMap(const ReportMetric& metric, size_t index) {
  return {
      .name = metric.name,
      .explanation = fmt::format("{}{}at the end of each run, {}", metric.formula, metric.formula.empty() ? "" : "; ",
                                 metric.higherIsBetter ? "higher is better" : "lower is better"),
      .value = [index](const ReportScene&, const ReportSeries& series) { return finalValue(series, index); },
      .behind =
          [logarithmic = metric.logarithmic](double value, double best) {
            if (logarithmic) return std::abs(std::log2(value / best)) / 4;
            return std::abs(value - best) / std::max(std::abs(best), 1e-12) * 2;
          },
      .text = [&metric](const ReportSeries&, double value) { return formatScore(metric, value); },
      .isBest = [&metric, index](const ReportScene& scene,
                                 const ReportSeries& series) { return isClearlyBest(scene, series, metric, index); },
      .higherIsBetter = metric.higherIsBetter};
}

// Render times from which on a metric has its target, NaN where it does not end with it. The tint is full at 16 times
// the fastest.
HeatMap targetMap(const ReportMetric& metric, size_t index) {
  return {
      .name = fmt::format("time to {} {}", metric.name, *metric.target),
      .explanation = fmt::format("from when on {} is {} or better; – if not at the end", metric.name, *metric.target),
      .value =
          [&metric, index](const ReportScene&, const ReportSeries& series) {
            return timeToReach(series, metric, index, *metric.target).value_or(TargetTime{kNan}).seconds;
          },
      .behind = [](double value, double best) { return std::abs(std::log2(value / best)) / 4; },
      .text = [&metric, index](const ReportSeries& series,
                               double) { return formatTime(*timeToReach(series, metric, index, *metric.target)); },
      .isBest =
          [&metric, index](const ReportScene& scene, const ReportSeries& series) {
            return isClearlyFastest(scene, series, metric, index, *metric.target);
          },
      .higherIsBetter = false};
}

// The cells of one scene, one for each name. A series without a number gets a dash.
std::string renderRow(const HeatMap& map, const ReportScene& scene, const std::vector<SeriesName>& names) {
  // Find the values of the row and the best of them. isBetter only asks the metric for its direction.
  ReportMetric order;
  order.higherIsBetter = map.higherIsBetter;
  std::vector<double> values;
  double best = kNan;
  for (const SeriesName& name : names) {
    const ReportSeries* series = seriesOf(scene, name);
    values.push_back(series ? map.value(scene, *series) : kNan);
    if (isBetter(order, values.back(), best)) best = values.back();
  }
  // Write the cells.
  std::string html;
  for (size_t i = 0; i < names.size(); ++i) {
    const double value = values[i];
    if (std::isnan(value)) {
      html += "<td class=\"n none\">–";
      continue;
    }
    const ReportSeries& series = *seriesOf(scene, names[i]);
    // The best is not behind itself, even where both are zero.
    const double behind = value == best ? 0 : map.behind(value, best);
    append(html, "<td class=\"n{}\" style=\"--behind:{:.2f}\">{}", map.isBest(scene, series) ? " best" : "",
           std::isfinite(behind) ? std::min(1.0, behind) : 1.0, map.text(series, value));
  }
  return html;
}

// One map as a figure: a row for each scene, a column for each series.
std::string renderHeatMap(const ConvergenceReport& report, const HeatMap& map) {
  const std::vector<SeriesName> names = seriesNamesOf(report);
  std::string html = fmt::format(
      "<figure class=\"heatmap\" data-name=\"{0}\"><figcaption><b>{0}</b> <small>{1}</small></figcaption>"
      "<div class=\"scroll\"><table class=\"heat\"><thead><tr><th>scene",
      escapeHtml(map.name), escapeHtml(map.explanation));
  for (const SeriesName& name : names) {
    append(html, "<th class=\"n\"><i class=\"swatch m-{}\"></i>{}", escapeHtml(name.method), escapeHtml(name.label));
  }
  html += "</thead><tbody>";
  for (size_t i = 0; i < report.scenes.size(); ++i) {
    append(html, "<tr><th><a href=\"#scene-{}\">{}</a>{}", i, escapeHtml(report.scenes[i].name),
           renderRow(map, report.scenes[i], names));
  }
  return html + "</tbody></table></div></figure>\n";
}

// How a series fares over the scenes that it was run on.
struct Standing {
  SeriesName name;
  std::vector<double> ranks;   // mean rank over scenes, by metric
  std::vector<double> factor;  // by metric: geometric mean of its score over the best one's, where that makes sense
  size_t wins = 0;             // scenes where it is first by the first metric
};

// Ranks count from 1. Series with equal scores share the better rank.
Standing standingOf(const ConvergenceReport& report, const SeriesName& name) {
  Standing standing{.name = name, .ranks = {}, .factor = {}};
  for (size_t m = 0; m < report.metrics.size(); ++m) {
    const ReportMetric& metric = report.metrics[m];
    // Sum ranks and logarithms over the scenes that the series was run on.
    double rankSum = 0, logSum = 0, scenes = 0;
    for (const ReportScene& scene : report.scenes) {
      const ReportSeries* series = seriesOf(scene, name);
      const double value = series ? finalValue(*series, m) : kNan;
      if (std::isnan(value)) continue;
      const auto better = std::count_if(scene.series.begin(), scene.series.end(), [&](const ReportSeries& other) {
        return isBetter(metric, finalValue(other, m), value);
      });
      rankSum += 1 + static_cast<double>(better);
      logSum += std::log(value / bestFinalValue(scene, metric, m));
      standing.wins += m == 0 && better == 0 ? 1 : 0;
      ++scenes;
    }
    // Take means. Ratios of scores only make sense for logarithmic metrics.
    standing.ranks.push_back(scenes > 0 ? rankSum / scenes : kNan);
    standing.factor.push_back(scenes > 0 && metric.logarithmic ? std::exp(logSum / scenes) : kNan);
  }
  return standing;
}

// Three significant digits with a unit; a dash where there is no number.
std::string numberCell(double value, const char* unit) {
  if (!std::isfinite(value)) return "<td class=\"n\">–";
  return fmt::format("<td class=\"n\">{}{}", formatSignificant(value), unit);
}

// The CSS class for the text of a verdict.
std::string verdictClass(const std::string& verdict) {
  if (verdict == "holds") return "holds";
  if (verdict == "not judged") return "unjudged";
  return verdict == "undecided" || verdict == "not reached in this time" ? "undecided" : "fails";
}

// A table row: scene, statement, verdict and the figure that decides. Explanation and evidence are folded behind a
// click.
std::string renderClaim(const ReportClaim& claim) {
  std::string html = fmt::format("<tr><th>{}<td>{}", escapeHtml(claim.scene), escapeHtml(claim.statement));
  if (!claim.source.empty()) append(html, "<small class=\"source\">{}</small>", escapeHtml(claim.source));
  append(html, "<td><span class=\"verdict {}\">{}</span><td>{}", verdictClass(claim.verdict), escapeHtml(claim.verdict),
         escapeHtml(claim.figure));
  if (claim.explanation.empty() && claim.evidence.empty()) return html;
  html += "<details><summary>evidence</summary>";
  if (!claim.explanation.empty()) append(html, "<p>{}</p>", escapeHtml(claim.explanation));
  return html + escapeHtml(claim.evidence) + "</details>";
}

}  // namespace

std::string renderTargetMaps(const ConvergenceReport& report) {
  std::string html = "<div class=\"heatmaps\">\n";
  for (size_t m = 0; m < report.metrics.size(); ++m) {
    if (report.metrics[m].target) html += renderHeatMap(report, targetMap(report.metrics[m], m));
  }
  return html + "</div>\n";
}

std::string renderHeatMaps(const ConvergenceReport& report) {
  std::string html = "<div class=\"heatmaps\">\n";
  for (size_t m = 0; m < report.metrics.size(); ++m) html += renderHeatMap(report, metricMap(report.metrics[m], m));
  return html +
         "</div><p class=\"facts\">The stronger the tint, the further behind the best of its row, which is bold where "
         "seeds tell it from all others.</p>\n";
}

std::string renderRanking(const ConvergenceReport& report) {
  // Order series by their rank in the first metric. Those without a score come last.
  std::vector<Standing> standings;
  for (const SeriesName& name : seriesNamesOf(report)) standings.push_back(standingOf(report, name));
  std::stable_sort(standings.begin(), standings.end(), [](const Standing& a, const Standing& b) {
    const double x = a.ranks.front(), y = b.ranks.front();
    return std::isnan(y) ? !std::isnan(x) : x < y;
  });
  // Write the head: rank by each metric, wins and mean ratio by the first metric.
  const ReportMetric& first = report.metrics.front();
  std::string html = "<h3>Ranking</h3><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>method";
  for (const ReportMetric& metric : report.metrics) append(html, "<th class=\"n\">by {}", escapeHtml(metric.name));
  append(html, "<th class=\"n\">first by {0}<th class=\"n\">{0} over best</thead><tbody>", escapeHtml(first.name));
  // Write a row for each series.
  for (const Standing& standing : standings) {
    append(html, "<tr><th><i class=\"swatch m-{}\"></i>{} <small>{}</small>", escapeHtml(standing.name.method),
           escapeHtml(standing.name.label), escapeHtml(methodStyle(standing.name.method).name));
    for (const double rank : standing.ranks) html += numberCell(rank, "");
    append(html, "<td class=\"n\">{} of {}", standing.wins, report.scenes.size());
    html += numberCell(standing.factor.front(), " ×");
  }
  return html + fmt::format(
                    "</tbody></table></div><p class=\"facts\">Ranks at the end of the runs by one metric each, means "
                    "over the scenes that a method was run on. In the order of {}; a click on another metric ranks by "
                    "it. The last "
                    "column is the geometric mean over scenes.</p>\n",
                    escapeHtml(first.name));
}

std::string renderClaims(const ConvergenceReport& report) {
  if (report.claims.empty()) return "";
  // Sum up the verdicts in a sentence.
  const auto count = [&](const char* verdict) {
    return std::count_if(report.claims.begin(), report.claims.end(),
                         [&](const ReportClaim& claim) { return claim.verdict == verdict; });
  };
  const auto judged = std::ssize(report.claims) - count("not judged");
  std::string html = "<section id=\"claims\"><h2>The study's findings</h2><p class=\"facts\">";
  if (judged > 0) {
    const auto hold = count("holds"), fail = count("does not hold"), undecided = count("undecided");
    append(html, "{} {}, {} {} not, {} not in this time, {} {} undecided. ", hold, hold == 1 ? "holds" : "hold", fail,
           fail == 1 ? "does" : "do", count("not reached in this time"), undecided, undecided == 1 ? "is" : "are");
  }
  if (count("not judged") > 0) {
    append(html, "{} cannot be judged by this campaign, which counts neither for nor against them.",
           judged == 0 ? fmt::format("All {}", count("not judged")) : std::to_string(count("not judged")));
  }
  html += "</p>";
  if (judged == 0) return html + "</section>\n";
  html +=
      "<div class=\"scroll\"><table class=\"claims\"><thead><tr><th>scene<th>finding<th>verdict<th>why</thead>"
      "<tbody>";
  for (const ReportClaim& claim : report.claims) {
    if (claim.verdict != "not judged") html += renderClaim(claim);
  }
  return html + "</tbody></table></div></section>\n";
}

}  // namespace wavecrest
