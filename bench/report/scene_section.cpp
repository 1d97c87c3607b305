#include "bench/report/scene_section.h"

#include "bench/report/html_text.h"
#include "bench/report/scene_plots.h"
#include "bench/report/scene_tables.h"
#include "bench/report/viewer_html.h"

namespace wavecrest {
namespace {

std::string paneOf(const ReportImage& image, const std::string& name, const EmbeddedImages& images) {
  return viewerPane(
      {.name = name, .label = image.label, .uri = images.uri(image), .width = image.width, .height = image.height});
}

// Pictures, with the reference first, and the error map of each.
std::string renderImages(const ReportScene& scene, const EmbeddedImages& images) {
  if (scene.reference.rgb.empty()) return "";
  std::string pictures = paneOf(scene.reference, "reference", images), maps;
  for (const ReportSeries& series : scene.series) {
    if (!series.finalImage.rgb.empty()) pictures += paneOf(series.finalImage, series.label, images);
    if (!series.errorMap.rgb.empty()) maps += paneOf(series.errorMap, series.label, images);
  }
  std::string groups = viewerGroup("Pictures", "", pictures);
  if (!maps.empty()) {
    groups += viewerGroup("Error maps", escapeHtml(scene.errorMapScale) + colourBar(scene.errorMapRange), maps);
  }
  return "<h3>Pictures at the end</h3>\n" + viewer(groups);
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
  html += renderImages(scene, images);
  html += "<h3>At the end</h3>\n" + renderResults(report, scene);
  html += renderBias(scene) + renderPathClasses(scene) + renderStages(scene) + renderSettings(scene);
  return html + "</section>\n";
}

}  // namespace wavecrest
