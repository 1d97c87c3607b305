#include "bench/report/scene_section.h"

#include <fmt/format.h>

#include "bench/report/html_text.h"
#include "bench/report/scene_plots.h"
#include "bench/report/scene_tables.h"
#include "bench/report/viewer_html.h"

namespace wavecrest {
namespace {

// Where the floats of an image are: of the reference, or of series `number`, from 1 on, at its end or at earlier time
// `step`, from 1 on.
std::string floatFile(size_t scene, size_t number, size_t step = 0) {
  return step == 0 ? fmt::format("report.floats/{}-{}.js", scene, number)
                   : fmt::format("report.floats/{}-{}-{}.js", scene, number, step);
}

std::string paneOf(const ReportImage& image, const std::string& name, const EmbeddedImages& images,
                   const std::string& floats = {}) {
  return viewerPane({.name = name,
                     .label = image.label,
                     .uri = images.uri(image),
                     .width = image.width,
                     .height = image.height,
                     .floats = image.floats.empty() ? "" : floats});
}

// Pictures, with the reference first, and the error map of each.
std::string renderImages(const ReportScene& scene, size_t index, const EmbeddedImages& images) {
  if (scene.reference.rgb.empty()) return "";
  std::string pictures = paneOf(scene.reference, "reference", images, floatFile(index, 0)), maps;
  size_t number = 0;
  for (const ReportSeries& series : scene.series) {
    const std::string floats = floatFile(index, ++number);
    if (!series.finalImage.rgb.empty()) pictures += paneOf(series.finalImage, series.label, images, floats);
    if (!series.errorMap.rgb.empty()) maps += paneOf(series.errorMap, series.label, images);
  }
  std::string groups = viewerGroup("Pictures", "", pictures);
  if (!maps.empty()) {
    groups += viewerGroup("Error maps", escapeHtml(scene.errorMapScale) + colourBar(scene.errorMapRange), maps);
  }
  for (size_t step = 0; step < scene.earlierSeconds.size(); ++step) {
    std::string earlier;
    for (size_t i = 0; i < scene.series.size(); ++i) {
      const ReportSeries& series = scene.series[i];
      if (step >= series.earlierImages.size() || series.earlierImages[step].rgb.empty()) continue;
      earlier += paneOf(series.earlierImages[step], series.label, images, floatFile(index, i + 1, step + 1));
    }
    const std::string time = formatSeconds(scene.earlierSeconds[step]);
    groups += viewerGroup("Pictures", "After about " + time, earlier, time);
  }
  return "<h3>Pictures</h3>\n" + viewer(groups, scene.crops);
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
  html += renderImages(scene, index, images);
  html += "<h3>At the end</h3>\n" + renderResults(report, scene);
  html += renderBias(scene) + renderPathClasses(scene) + renderStages(scene) + renderSettings(scene);
  return html + "</section>\n";
}

std::vector<std::pair<std::string, std::string>> floatFiles(const ConvergenceReport& report) {
  std::vector<std::pair<std::string, std::string>> files;
  const auto add = [&](const ReportImage& image, const std::string& file) {
    if (image.floats.empty()) return;
    files.emplace_back(file, fmt::format("wavecrestFloats(\"{}\", \"{}\");\n", file, image.floats));
  };
  for (size_t scene = 0; scene < report.scenes.size(); ++scene) {
    add(report.scenes[scene].reference, floatFile(scene, 0));
    size_t number = 0;
    for (const ReportSeries& series : report.scenes[scene].series) {
      add(series.finalImage, floatFile(scene, ++number));
      for (size_t step = 0; step < series.earlierImages.size(); ++step) {
        add(series.earlierImages[step], floatFile(scene, number, step + 1));
      }
    }
  }
  return files;
}

}  // namespace wavecrest
