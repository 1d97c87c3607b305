#include "bench/report/factor_table.h"

#include <algorithm>
#include <cmath>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"

namespace wavecrest {
namespace {

// One series against a baseline: in each scene, and together.
struct Row {
  SeriesName name;
  std::vector<FactorCell> cells;  // by scene
  std::vector<FactorMean> means;  // by label
  bool shared = false;            // whether a scene has both
};

Row rowOf(const ConvergenceReport& report, const FactorTable& table, const SeriesName& name,
          const SeriesName& baseline) {
  Row row{.name = name, .cells = {}, .means = {}};
  for (const ReportScene& scene : report.scenes) {
    const ReportSeries *own = seriesOf(scene, name), *base = seriesOf(scene, baseline);
    const bool both = own != nullptr && base != nullptr;
    row.shared = row.shared || both;
    row.cells.push_back(both ? table.compare(*own, *base) : FactorCell{});
    row.cells.back().factors.resize(table.labels.size());
  }
  for (size_t label = 0; label < table.labels.size(); ++label) {
    std::vector<std::optional<Factor>> factors;
    for (const FactorCell& cell : row.cells) factors.push_back(cell.factors[label]);
    row.means.push_back(geometricMean(factors));
  }
  return row;
}

// A cell with its tint: full at 16 times, in another colour below 1.
std::string cellStart(const std::optional<Factor>& factor, const std::string& hint) {
  std::string html = "<td class=\"n none\"";
  if (factor) {
    html = fmt::format("<td class=\"n {}\" style=\"--behind:{:.2f}\"", factor->factor < 1 ? "slower" : "faster",
                       std::min(1.0, std::abs(std::log2(factor->factor)) / 4));
  }
  if (!hint.empty()) append(html, " title=\"{}\"", escapeHtml(hint));
  return html + ">" + formatFactor(factor);
}

std::string renderCell(const FactorTable& table, const FactorCell& cell) {
  std::string html = cellStart(cell.factors.front(), cell.hint);
  if (!cell.factors.front()) return html;
  for (size_t label = 1; label < cell.factors.size(); ++label) {
    append(html, "<small>{} {}</small>", table.labels[label], formatFactor(cell.factors[label]));
  }
  return html;
}

// The means of a row, each with the number of its scenes where those are not all.
std::string renderMeans(const FactorTable& table, const Row& row, size_t scenes) {
  const auto of = [&](const FactorMean& mean) {
    return mean.counted < scenes ? fmt::format(" of {}", mean.counted) : std::string();
  };
  std::string html = cellStart(row.means.front().mean, "");
  if (row.means.front().counted == 0) return html;
  if (const std::string count = of(row.means.front()); !count.empty()) append(html, "<small>{}</small>", count);
  for (size_t label = 1; label < row.means.size(); ++label) {
    append(html, "<small>{} {}{}</small>", table.labels[label], formatFactor(row.means[label].mean),
           row.means[label].counted == row.means.front().counted ? "" : of(row.means[label]));
  }
  return html;
}

std::string renderAgainst(const ConvergenceReport& report, const FactorTable& table, const SeriesName& baseline,
                          bool open) {
  std::vector<Row> rows;
  for (const SeriesName& name : seriesNamesOf(report)) rows.push_back(rowOf(report, table, name, baseline));
  std::erase_if(rows, [](const Row& row) { return !row.shared; });
  // The baseline's own row is always 1: there must be another.
  const auto compared = std::ranges::count_if(rows, [](const Row& row) { return row.means.front().counted > 0; });
  if (compared < 2) return "";
  // Largest mean first; rows without a mean come last.
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    const auto mean = [](const Row& row) { return row.means.front().mean.value_or(Factor{}).factor; };
    return mean(a) > mean(b);
  });
  const bool several = report.scenes.size() > 1;
  std::string html = fmt::format(
      "<details class=\"factors {0}\" name=\"{0}\"{1}><summary>over {2}</summary><div class=\"scroll\">"
      "<table class=\"heat\"><thead><tr><th>method",
      table.group, open ? " open" : "", escapeHtml(baseline.label));
  if (several) html += "<th class=\"n\">geometric mean";
  for (const ReportScene& scene : report.scenes) append(html, "<th class=\"n\">{}", escapeHtml(scene.name));
  html += "</thead><tbody>";
  for (const Row& row : rows) {
    append(html, "<tr><th><i class=\"swatch m-{}\"></i>{}", escapeHtml(row.name.method), escapeHtml(row.name.label));
    if (several) html += renderMeans(table, row, report.scenes.size());
    for (const FactorCell& cell : row.cells) html += renderCell(table, cell);
  }
  return html + "</tbody></table></div></details>\n";
}

}  // namespace

FactorMean geometricMean(std::span<const std::optional<Factor>> factors) {
  FactorMean result;
  double logSum = 0;
  bool least = false, most = false;
  for (const std::optional<Factor>& factor : factors) {
    if (!factor) continue;
    logSum += std::log(factor->factor);
    least = least || factor->bound > 0;
    most = most || factor->bound < 0;
    ++result.counted;
  }
  if (result.counted == 0 || (least && most)) return result;
  result.mean = Factor{.factor = std::exp(logSum / static_cast<double>(result.counted)), .bound = 0};
  if (least) result.mean->bound = 1;
  if (most) result.mean->bound = -1;
  return result;
}

std::string formatFactor(const std::optional<Factor>& factor) {
  if (!factor) return "–";
  const char* const sign = factor->bound > 0 ? "≥ " : factor->bound < 0 ? "≤ " : "";
  return fmt::format("{}{} ×", sign, formatSignificant(factor->factor));
}

std::string renderFactorTables(const ConvergenceReport& report, const FactorTable& table) {
  const std::vector<SeriesName> names = seriesNamesOf(report);
  if (names.empty()) return "";
  const SeriesName chosen = findSeriesName(report, report.baseline).value_or(names.front());
  std::string tables;
  for (const SeriesName& baseline : names) tables += renderAgainst(report, table, baseline, baseline == chosen);
  return tables;
}

}  // namespace wavecrest
