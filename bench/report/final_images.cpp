#include "bench/report/final_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/report/float_image.h"
#include "bench/report/html_text.h"
#include "bench/report/series_values.h"
#include "metrics/false_colour.h"
#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"

namespace wavecrest {
namespace {

constexpr const char* kMapMetric = "flip";
constexpr double kShownPart = 0.99;   // of a map's pixels lie within the scale
constexpr double kLeastRange = 0.02;  // a map of nothing but rounding stays dark

ReportImage shownImage(std::string label, Image8 codes) {
  return {.label = std::move(label), .width = codes.width, .height = codes.height, .rgb = std::move(codes.pixels)};
}

// Of an image of light in colour.
void addFloats(ReportImage& image, const ImageFile& file) {
  if (file.encoding != Encoding::linear || file.image.channels != 3) return;
  image.floats = floatText(file.image.pixels, file.image.width, file.image.height);
}

}  // namespace

void addFinalImages(ReportScene& scene, const PreparedReference& reference,
                    const std::vector<std::filesystem::path>& files) {
  scene.reference = shownImage("reference", reference.image().codes);
  addFloats(scene.reference, reference.image().file);
  const Metric& metric = *findMetric(kMapMetric);
  std::vector<Measurement> measured(scene.series.size());
  double range = kLeastRange;
  for (size_t i = 0; i < scene.series.size(); ++i) {
    if (files[i].empty()) continue;
    ReportSeries& series = scene.series[i];
    const ComparedImage test = reference.prepareTest(files[i].string(), readImage(files[i].string()));
    measured[i] = metric.measure(reference, test, true);
    range = std::max(range, quantile(measured[i].map, kShownPart));
    series.finalImage =
        shownImage(fmt::format("{}, {}", series.label, formatSeconds(finalSeconds(series))), test.codes);
    if (!scene.reference.floats.empty()) addFloats(series.finalImage, test.file);
  }
  for (size_t i = 0; i < scene.series.size(); ++i) {
    if (files[i].empty()) continue;
    ReportSeries& series = scene.series[i];
    series.errorMap = shownImage(
        fmt::format("{}, {} {}", series.label, metric.symbol, formatSignificant(mainScore(metric, measured[i]))),
        falseColour(measured[i].map, series.finalImage.width, series.finalImage.height, range));
  }
  scene.errorMapScale = fmt::format("Error maps: {} of each pixel, all on one scale.", metric.symbol);
  scene.errorMapRange = range;
}

}  // namespace wavecrest
