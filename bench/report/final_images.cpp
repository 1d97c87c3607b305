#include "bench/report/final_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
constexpr double kShownPart = 0.99;                      // of a map's pixels lie within the scale
constexpr double kLeastRange = 0.02;                     // a map of nothing but rounding stays dark
constexpr double kEarlierParts[] = {1 / 16.0, 1 / 4.0};  // of the longest run, at which there are pictures too
constexpr double kMostApart = 2.5;                       // times: an image further from such a time is not shown there

ReportImage shownImage(std::string label, Image8 picture) {
  return {
      .label = std::move(label), .width = picture.width, .height = picture.height, .rgb = std::move(picture.pixels)};
}

// Of an image of light in colour.
void addFloats(ReportImage& image, const ImageFile& file) {
  if (file.encoding != Encoding::linear || file.image.channels != 3) return;
  image.floats = floatText(file.image.pixels, file.image.width, file.image.height);
}

// For each time the image of each series that is nearest to it, by the ratio of times, and not the last.
void addEarlierImages(ReportScene& scene, const PreparedReference& reference,
                      const std::vector<std::vector<TimedImage>>& files) {
  double longest = 0;
  for (const auto& run : files) longest = std::max(longest, run.empty() ? 0 : run.back().seconds);
  for (const double part : kEarlierParts) {
    const double wanted = part * longest;
    const auto distance = [&](const TimedImage& image) { return std::abs(std::log(image.seconds / wanted)); };
    std::vector<ReportImage> images(files.size());
    for (size_t i = 0; i < files.size(); ++i) {
      if (files[i].size() < 2) continue;
      const TimedImage& near =
          *std::min_element(files[i].begin(), files[i].end() - 1,
                            [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      if (!(distance(near) < std::log(kMostApart))) continue;
      const ComparedImage test = reference.prepareTest(near.file.string(), readImage(near.file.string()));
      images[i] = shownImage(fmt::format("{}, {}", scene.series[i].label, formatSeconds(near.seconds)),
                             reference.pictureOf(test));
      if (!scene.reference.floats.empty()) addFloats(images[i], test.file);
    }
    if (std::ranges::all_of(images, [](const ReportImage& image) { return image.rgb.empty(); })) continue;
    scene.earlierSeconds.push_back(wanted);
    for (size_t i = 0; i < files.size(); ++i) scene.series[i].earlierImages.push_back(std::move(images[i]));
  }
}

}  // namespace

void addImages(ReportScene& scene, const PreparedReference& reference,
               const std::vector<std::vector<TimedImage>>& files) {
  scene.reference = shownImage("reference", reference.pictureOf(reference.image()));
  addFloats(scene.reference, reference.image().file);
  const Metric& metric = *findMetric(kMapMetric);
  std::vector<Measurement> measured(scene.series.size());
  double range = kLeastRange;
  for (size_t i = 0; i < scene.series.size(); ++i) {
    if (files[i].empty()) continue;
    ReportSeries& series = scene.series[i];
    const std::string last = files[i].back().file.string();
    const ComparedImage test = reference.prepareTest(last, readImage(last));
    measured[i] = metric.measure(reference, test, true);
    range = std::max(range, quantile(measured[i].map, kShownPart));
    series.finalImage = shownImage(fmt::format("{}, {}", series.label, formatSeconds(files[i].back().seconds)),
                                   reference.pictureOf(test));
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
  addEarlierImages(scene, reference, files);
}

}  // namespace wavecrest
