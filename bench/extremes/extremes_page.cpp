#include "bench/extremes/extremes_report.h"
#include "bench/report/html_text.h"
#include "bench/report/plain_page.h"
#include "bench/report/svg_plot.h"

namespace wavecrest {
namespace {

// Errors of either sign, which no logarithmic axis could show.
Plot plotOf(const SweepResult& result) {
  const Sweep& sweep = *result.sweep;
  // Values that span more than two decades, or fall towards zero, are on a logarithmic axis.
  const bool logarithmic =
      sweep.values.back() / sweep.values.front() > 100 || sweep.values.front() > sweep.values.back();
  Plot plot;
  plot.title = sweep.title;
  plot.xLabel = sweep.xLabel;
  plot.yLabel = "error";
  plot.xScale = logarithmic ? AxisScale::kLogarithmic : AxisScale::kLinear;
  plot.yScale = AxisScale::kLinear;
  // A line where there is no error.
  plot.target = 0;
  for (const SweepRow& row : result.rows) {
    const std::string method(toString(row.method));
    const bool doubled = row.precision == Precision::doubled;
    const std::string label = method + (doubled ? " double" : "");
    // Rows of a method and precision follow each other, so another label begins another curve.
    if (plot.curves.empty() || plot.curves.back().label != label) {
      plot.curves.push_back({.label = label,
                             .cssClass = "m-" + method + (doubled ? " variant-1" : " variant-0"),
                             .mark = methodStyle(method).mark,
                             .points = {}});
    }
    // The band is one standard error to either side.
    plot.curves.back().points.push_back(
        {.x = row.value,
         .y = row.error,
         .low = row.error - row.standardError,
         .high = row.error + row.standardError,
         .tooltip = fmt::format("{} at {:g}: {:+.2g} \u00b1 {:.1g}", label, row.value, row.error, row.standardError)});
  }
  sortPoints(plot);
  return plot;
}

// All rows of a sweep, with the samples that were lost, as an HTML table.
std::string tableOf(const SweepResult& result) {
  std::string html =
      "<details><summary>All rows</summary><div class=\"scroll\"><table><thead><tr><th>Method<th>Precision"
      "<th class=\"n\">Value<th class=\"n\">Error<th class=\"n\">Standard error<th class=\"n\">Not finite"
      "<th class=\"n\">Close pairs<th class=\"n\">Cut paths<th></thead><tbody>";
  for (const SweepRow& row : result.rows) {
    append(html,
           "<tr><td>{}<td>{}<td class=\"n\">{:g}<td class=\"n\">{:+.2e}<td class=\"n\">{:.1e}<td class=\"n\">{}"
           "<td class=\"n\">{}<td class=\"n\">{}<td>{}",
           toString(row.method), kPrecisionNames[static_cast<size_t>(row.precision)], row.value, row.error,
           row.standardError, row.losses.nonFinite, row.losses.closePairs, row.losses.cutPaths,
           escapeHtml(row.failure.empty() ? "within its bound" : row.failure));
  }
  return html + "</tbody></table></div></details>";
}

// Bound, plot and table of a sweep, and which methods have no rows.
std::string sectionOf(const SweepResult& result) {
  const Sweep& sweep = *result.sweep;
  std::string html = fmt::format("<section id=\"{}\"><h2>{}</h2>\n", escapeHtml(sweep.name), escapeHtml(sweep.title));
  append(html, "<p class=\"facts\">Relative error of the image's mean. Bound {:g}: {}. {}</p>\n", sweep.bound,
         escapeHtml(sweep.boundSource), result.passes() ? "All rows are within it." : "<b>Some rows are not.</b>");
  if (!sweep.leftOut.empty()) append(html, "<p class=\"facts\">Without rows: {}.</p>\n", escapeHtml(sweep.leftOut));
  return html + "<div class=\"card\">" + renderPlot(plotOf(result)) + "</div>\n" + tableOf(result) + "</section>\n";
}

}  // namespace

std::string extremesPage(const std::vector<SweepResult>& results) {
  std::string sections;
  for (const SweepResult& result : results) sections += sectionOf(result);
  return plainPage("Extremes", sections);
}

}  // namespace wavecrest
