#include "cli/compare_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/report/assets.h"
#include "bench/report/embedded_images.h"
#include "bench/report/float_image.h"
#include "bench/report/html_text.h"
#include "bench/report/plain_page.h"
#include "bench/report/viewer_html.h"
#include "metrics/false_colour.h"

namespace wavecrest {
namespace {

// A pane of the viewer, embedded as PNG.
std::string imagePane(const Image8& image, const std::string& name, const std::string& label,
                      const std::string& floats = {}) {
  const std::vector<uint8_t> png =
      encodeImage({.label = {}, .width = image.width, .height = image.height, .rgb = image.pixels}, ImageCoding{});
  const std::string uri = "data:image/png;base64," + base64(png);
  return viewerPane(
      {.name = name, .label = label, .uri = uri, .width = image.width, .height = image.height, .floats = floats});
}

// Whether an image has light in colour behind its codes.
bool hasLight(const ImageFile& file) {
  return file.encoding == Encoding::linear && file.image.channels == 3 && !file.image.pixels.empty();
}

// An image of light with its floats in an element of the page.
std::string lightPane(const Image8& picture, const ImageFile& light, const std::string& name, const std::string& label,
                      size_t number) {
  const std::string id = fmt::format("floats-{}", number);
  return imagePane(picture, name, label, "#" + id) +
         fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id,
                     floatText(light.image.pixels, light.image.width, light.image.height));
}

// The maps of one metric, of all tests on one scale.
std::string mapGroup(const std::vector<MeasuredTest>& tests, size_t index) {
  const Metric& metric = *tests.front().scores[index].metric;
  double range = 0;
  for (const MeasuredTest& test : tests) range = std::max(range, rangeOfMap(test.scores[index]));
  std::string panes;
  for (const MeasuredTest& test : tests) {
    const Measurement& measurement = test.scores[index].measurement;
    panes += imagePane(
        falseColour(measurement.map, test.picture.width, test.picture.height, range), test.label,
        fmt::format("{}, {} {}", test.file, metric.symbol, formatSignificant(mainScore(metric, measurement))));
  }
  const std::string head = fmt::format("{}: {}", metric.symbol, metric.formula);
  return viewerGroup(metric.symbol, escapeHtml(head) + colourBar(range), panes);
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
  const std::string conditions = metric.conditions.empty() ? "" : fmt::format("; {}", metric.conditions);
  append(page, "<tr><th title=\"{}\">{} <small>{}; {} is better{}</small></th>", escapeHtml(metric.title),
         escapeHtml(metric.symbol), escapeHtml(metric.formula), metric.higherIsBetter ? "more" : "less",
         escapeHtml(conditions));
  for (const MeasuredTest& test : tests) {
    const double score = scoreOf(test);
    // Tests with equal best scores are all marked.
    const bool marked = tests.size() > 1 && score == best;
    append(page, "<td class=\"n{}\">{}</td>", marked ? " best" : "", formatSignificant(score, 6));
  }
  page += "</tr>\n";
}

// Adds the table of scores: one column per test, one row per metric.
void addTable(std::string& page, const std::vector<MeasuredTest>& tests) {
  page += "<div class=\"scroll\"><table><thead><tr><th>metric</th>";
  for (const MeasuredTest& test : tests) append(page, "<th class=\"n\">{}</th>", escapeHtml(test.file));
  page += "</tr></thead><tbody>\n";
  for (size_t i = 0; i < tests.front().scores.size(); ++i) addScoreRow(page, tests, i);
  page += "<tr><th>pixels that are not finite</th>";
  for (const MeasuredTest& test : tests) append(page, "<td class=\"n\">{}</td>", test.nonFinitePixels);
  page += "</tr>\n</tbody></table></div>\n";
}

}  // namespace

std::string comparePage(const PreparedReference& reference, const std::vector<MeasuredTest>& tests) {
  // What is small in the table wraps, so that long viewing conditions leave room for the scores.
  std::string page = pageHead("Against " + reference.name(), "tbody th small { white-space: normal; }\n");
  append(page, "<header><h1>Against {}</h1></header>\n<main>\n", escapeHtml(reference.name()));
  addTable(page, tests);
  // Pictures, then the maps of each metric.
  // Floats have errors against the reference: tests show theirs where the reference has some.
  size_t number = 0;
  const ImageFile& referenceLight = reference.image().file;
  const bool lit = hasLight(referenceLight);
  const auto pane = [&](const Image8& picture, const ImageFile& light, const std::string& name,
                        const std::string& label) {
    return lit && hasLight(light) ? lightPane(picture, light, name, label, number++) : imagePane(picture, name, label);
  };
  std::string pictures = pane(reference.pictureOf(reference.image()), referenceLight, "reference", reference.name());
  for (const MeasuredTest& test : tests) pictures += pane(test.picture, test.light, test.label, test.file);
  std::string groups = viewerGroup("Pictures", "", pictures);
  for (size_t i = 0; i < tests.front().scores.size(); ++i) groups += mapGroup(tests, i);
  append(page, "<h3>Pictures and maps</h3>\n{}</main>\n<script>\n{}{}</script>\n</body></html>\n",
         viewer(groups, {}, reference.settings().exposure), kFloatsJs, kReportJs);
  return page;
}

}  // namespace wavecrest
