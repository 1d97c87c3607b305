#include "bench/report/scene_section.h"

#include "bench/report/html_text.h"
#include "bench/report/scene_plots.h"
#include "bench/report/scene_tables.h"

namespace wavecrest {
namespace {

// data-name tells the script which picture and which error map belong together.
void appendPane(std::string& html, const ReportImage& image, const std::string& name, const EmbeddedImages& images) {
  append(html,
         "<figure class=\"pane\" data-name=\"{}\"><div class=\"frame\"><img src=\"{}\" width=\"{}\" height=\"{}\" "
         "alt=\"{}\"></div>",
         escapeHtml(name), images.uri(image), image.width, image.height, escapeHtml(image.label));
  append(html, "<figcaption>{}</figcaption></figure>\n", escapeHtml(image.label));
}

// Two rows of panes: pictures, with the reference first, and below them the error map of each.
std::string renderImages(const ReportScene& scene, const EmbeddedImages& images) {
  if (scene.reference.rgb.empty()) return "";
  std::string html =
      "<h3>Pictures at the end</h3>\n"
      "<div class=\"viewer\"><div class=\"panes\" data-kind=\"Pictures\">\n";
  appendPane(html, scene.reference, "reference", images);
  std::string maps;
  for (const ReportSeries& series : scene.series) {
    if (!series.finalImage.rgb.empty()) appendPane(html, series.finalImage, series.label, images);
    if (!series.errorMap.rgb.empty()) appendPane(maps, series.errorMap, series.label, images);
  }
  html += "</div>\n";
  if (!maps.empty()) {
    append(html, "<p class=\"facts maps\">{}</p><div class=\"panes\" data-kind=\"Error maps\">\n{}</div>\n",
           escapeHtml(scene.errorMapScale), maps);
  }
  return html + "</div>\n";
}

std::string renderPlots(const ConvergenceReport& report, const ReportScene& scene) {
  std::string html = "<div class=\"grid plots\">\n";
  for (const ScenePlot& plot : scenePlots(report, scene)) {
    append(html, "<figure class=\"card\"><figcaption><b>{}</b> {}</figcaption>{}</figure>\n", escapeHtml(plot.heading),
           escapeHtml(plot.explanation), renderPlot(plot.plot));
  }
  return html + "</div>\n";
}

}  // namespace

std::string renderScene(const ConvergenceReport& report, size_t index, const EmbeddedImages& images) {
  const ReportScene& scene = report.scenes[index];
  std::string html;
  append(html, "<section id=\"scene-{}\"><h2>{}</h2><p class=\"facts\">{} × {} pixels. Reference: {}.</p>\n", index,
         escapeHtml(scene.name), scene.width, scene.height, escapeHtml(scene.referenceOrigin));
  html += "<h3>Error over time</h3>\n" + renderPlots(report, scene);
  html += "<h3>At the end</h3>\n" + renderResults(report, scene);
  html += renderImages(scene, images);
  html += renderBias(scene) + renderPathClasses(scene) + renderStages(scene) + renderSettings(scene);
  return html + "</section>\n";
}

}  // namespace wavecrest
