// The page of `bench --tradeoff`: time against bias, and the table.
#include <algorithm>
#include <cmath>

#include "bench/report/html_text.h"
#include "bench/report/plain_page.h"
#include "bench/report/svg_plot.h"
#include "bench/tradeoff/tradeoff.h"

namespace wavecrest {
namespace {

// One curve for each knob. A bias that is lost in its own error is drawn at that error.
Plot plotOf(const TradeResult& result) {
  Plot plot;
  plot.title =
      fmt::format("{}, {}: time to a relative error of 1 % against bias", result.scene, toString(result.method));
  plot.xLabel = "CPU seconds to 1 %";
  plot.yLabel = "bias";
  for (const TradeRow& row : result.rows) {
    if (!row.refusal.empty()) continue;
    // A curve for each knob.
    auto curve = std::ranges::find(plot.curves, row.knob, &PlotCurve::label);
    if (curve == plot.curves.end()) {
      // Colours and marks are those of methods, in turn.
      const MethodStyle& style = kMethodStyles[plot.curves.size() % kMethodStyles.size()];
      plot.curves.push_back({.label = row.knob,
                             .cssClass = "m-" + std::string(style.id) + " variant-0",
                             .mark = style.mark,
                             .points = {}});
      curve = plot.curves.end() - 1;
    }
    const double bias = std::max(std::abs(row.mean.value), row.mean.standardError);
    curve->points.push_back({.x = row.secondsToPercent,
                             .y = bias,
                             .low = bias,
                             .high = bias,
                             .tooltip = fmt::format("{} {}: {:.3g} s, bias {:+.2g} \u00b1 {:.1g}", row.knob, row.value,
                                                    row.secondsToPercent, row.mean.value, row.mean.standardError)});
  }
  sortPoints(plot);
  return plot;
}

// All settings as an HTML table. A setting that was refused has the reason in place of figures.
std::string tableOf(const TradeResult& result) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>Setting<th class=\"n\">Speed<th class=\"n\">Efficiency"
      "<th class=\"n\">CPU seconds to 1 %<th class=\"n\">Bias of the mean<th class=\"n\">Worst block"
      "<th class=\"n\">Memory<th></thead><tbody>";
  for (const TradeRow& row : result.rows) {
    append(html, "<tr><td>{} {}", escapeHtml(row.knob), escapeHtml(row.value));
    if (!row.refusal.empty()) {
      append(html, "<td colspan=\"7\">{}", escapeHtml(row.refusal));
      continue;
    }
    append(html,
           "<td class=\"n\">{:.2f}<td class=\"n\">{:.2f} \u00b1 {:.2f}<td class=\"n\">{:.3g}<td class=\"n\">{:+.1e} "
           "\u00b1 {:.0e}<td class=\"n\">{:+.1e} \u00b1 {:.0e}<td class=\"n\">{:.1f} MB<td>{}",
           row.speed.value, row.efficiency.value, row.efficiency.interval.halfWidth(), row.secondsToPercent,
           row.mean.value, row.mean.standardError, row.worstBlock.value, row.worstBlock.standardError,
           1e-6 * static_cast<double>(row.bytes), row.biased ? "biased" : "");
  }
  return html + "</tbody></table></div>";
}

}  // namespace

// Advice, plot and table of each result.
std::string tradePage(const std::vector<TradeResult>& results) {
  std::string sections;
  for (const TradeResult& result : results) {
    append(sections, "<section><h2>{}, {}</h2>\n<p>{}</p>\n<p class=\"facts\">{}</p>\n", escapeHtml(result.scene),
           toString(result.method), escapeHtml(adviceOf(result)), escapeHtml(biasVerdictsInWords(result)));
    append(
        sections,
        "<p class=\"facts\">{} iterations of {}x{} pixels with {} seeds. Speed and efficiency are over the baseline's; "
        "verdicts of bias are wrong anywhere in a table in {:g} of 100 cases.</p>\n<p class=\"facts\">{}</p>\n",
        result.iterations, result.width, result.height, result.seeds, 100 * kTradeLevel, kBaselineInWords);
    sections += "<div class=\"card\">" + renderPlot(plotOf(result)) + "</div>\n" + tableOf(result) + "</section>\n";
  }
  return plainPage("What speed costs", sections);
}

}  // namespace wavecrest
