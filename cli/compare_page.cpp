#include "cli/compare_page.h"

#include "bench/report/embedded_images.h"
#include "bench/report/html_text.h"

namespace wavecrest {
namespace {

// The style is part of the page, which needs no other file.
constexpr const char* kStyle = R"(
:root { --paper: #fbfbf9; --ink: #1c2126; --soft: #5c666f; --line: #d9dcde; --best: #1a7340; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #14171a; --ink: #e6e8ea; --soft: #9aa4ae; --line: #353b41; --best: #5cc98a; }
}
body { margin: 24px; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 24px; }
h2 { font-size: 18px; margin: 32px 0 8px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--line); text-align: right; font-weight: normal; }
th:first-child { text-align: left; }
thead th, figcaption { color: var(--soft); font-size: 14px; }
.best { color: var(--best); font-weight: 650; }
.row { display: flex; flex-wrap: wrap; gap: 16px; }
figure { margin: 0; }
img { max-width: 100%; min-width: 128px; image-rendering: pixelated; border: 1px solid var(--line); }
)";

// Adds an image, embedded as PNG, with its caption.
void addFigure(std::string& page, const Image8& image, const std::string& caption) {
  const std::vector<uint8_t> png =
      encodeImage({.label = {}, .width = image.width, .height = image.height, .rgb = image.pixels}, ImageCoding{});
  append(page, "<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
         base64(png), escapeHtml(caption), escapeHtml(caption));
}

// Adds a row of the table: a metric's main score of each test. With several tests the best is marked.
void addScoreRow(std::string& page, const std::vector<MeasuredTest>& tests, size_t index) {
  const Metric& metric = *tests.front().scores[index].metric;
  const auto scoreOf = [&](const MeasuredTest& test) { return mainScore(metric, test.scores[index].measurement); };
  double best = scoreOf(tests.front());
  for (const MeasuredTest& test : tests) {
    const double score = scoreOf(test);
    if (metric.higherIsBetter ? score > best : score < best) best = score;
  }
  append(page, "<tr><th title=\"{}\">{} ({} is better)</th>", escapeHtml(metric.title), escapeHtml(metric.symbol),
         metric.higherIsBetter ? "more" : "less");
  for (const MeasuredTest& test : tests) {
    const double score = scoreOf(test);
    // Tests with equal best scores are all marked.
    const bool marked = tests.size() > 1 && score == best;
    append(page, "<td{}>{}</td>", marked ? " class=\"best\"" : "", formatSignificant(score, 6));
  }
  page += "</tr>\n";
}

// Adds the table of scores: one column per test, one row per metric.
void addTable(std::string& page, const std::vector<MeasuredTest>& tests) {
  page += "<div class=\"scroll\"><table><thead><tr><th></th>";
  for (const MeasuredTest& test : tests) append(page, "<th>{}</th>", escapeHtml(test.file));
  page += "</tr></thead><tbody>\n";
  for (size_t i = 0; i < tests.front().scores.size(); ++i) addScoreRow(page, tests, i);
  page += "<tr><th>pixels that are not finite</th>";
  for (const MeasuredTest& test : tests) append(page, "<td>{}</td>", test.nonFinitePixels);
  page += "</tr>\n</tbody></table></div>\n";
}

}  // namespace

std::string comparePage(const std::string& referenceFile, const Image8& reference,
                        const std::vector<MeasuredTest>& tests) {
  // Head, and the table of all tests.
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width\">\n";
  append(page, "<title>Against {}</title><style>{}</style></head><body>\n", escapeHtml(referenceFile), kStyle);
  append(page, "<h1>Against {}</h1>\n", escapeHtml(referenceFile));
  addTable(page, tests);
  // The reference.
  page += "<h2>Reference</h2><div class=\"row\">\n";
  addFigure(page, reference, referenceFile);
  page += "</div>\n";
  // Each test, with the map of every metric.
  for (const MeasuredTest& test : tests) {
    append(page, "<h2>{}</h2><div class=\"row\">\n", escapeHtml(test.file));
    addFigure(page, test.codes, test.file);
    for (const Measured& score : test.scores) {
      const ShownMap map = showMap(score, test.codes.width, test.codes.height);
      addFigure(page, map.picture,
                fmt::format("{}: 0 (dark) to {}", score.metric->symbol, formatSignificant(map.range, 3)));
    }
    page += "</div>\n";
  }
  return page + "</body></html>\n";
}

}  // namespace wavecrest
