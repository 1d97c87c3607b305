// Comparisons of the interface.
#include "wavecrest/compare.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "library/comparison.h"
#include "library/image_conversion.h"
#include "library/option_values.h"
#include "library/translate.h"
#include "metrics/false_colour.h"

namespace wavecrest::api {
namespace {

// Whether all values are codes of 8 bits over 255, to rounding. Codes of 16 bits that are none lie 1/257 of a code or
// more from them.
bool isOf8Bits(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) {
    const double code = 255 * double{value};
    return std::abs(code - std::round(code)) <= 1e-4;
  });
}

// An image of the interface as one that was read from a file. name: for messages. Throws ImageError.
ImageFile toFile(const std::string& name, Image image) {
  checkPixels(name, image);
  Encoding encoding = Encoding::linear;
  if (image.srgb) {
    // NaN is refused as well.
    if (!std::ranges::all_of(image.pixels, [](float value) { return value >= 0 && value <= 1; })) {
      throw ImageError(name, "sRGB value outside 0..1", "expected codes over 255 or 65535");
    }
    encoding = isOf8Bits(image.pixels) ? Encoding::srgb8 : Encoding::srgb16;
  }
  return {.image = toImage(std::move(image)), .encoding = encoding, .metadata = {}};
}

// Names, scores and map of one metric.
MetricResult toResult(Measured measured) {
  const Metric& metric = *measured.metric;
  MetricResult result;
  result.metric = metric.name;
  result.score = mainScore(metric, measured.measurement);
  result.mapRange = metric.mapRange;
  for (const Score& score : measured.measurement.scores) {
    result.scores.push_back({scoreName(metric, score.name), score.value});
  }
  result.map = std::move(measured.measurement.map);
  // Where the metric has no range of its own, false colours end at the quantile of the map.
  if (result.mapRange == 0) result.mapRange = quantile(result.map, 0.999);
  return result;
}

}  // namespace

std::vector<MetricInfo> metrics() {
  std::vector<MetricInfo> all;
  for (const Metric& metric : metricList()) {
    all.push_back({.name = std::string(metric.name),
                   .symbol = std::string(metric.symbol),
                   .title = std::string(metric.title),
                   .basis = std::string(metric.basis),
                   .higherIsBetter = metric.higherIsBetter,
                   .byDefault = metric.byDefault,
                   .smallestSide = metric.smallestSide});
  }
  return all;
}

// What the handle keeps; the header does not show the engine's types.
struct Reference::Data {
  PreparedReference prepared;
};

Reference::Reference(Image image, const CompareOptions& options, const std::string& name) {
  translated([&] {
    requireInRange("--exposure", options.exposure, kExposureRange);
    ComparisonSettings settings;
    settings.exposure = options.exposure;
    settings.gammaCorrectedErrors = options.gammaCorrectedErrors;
    data_ = std::make_unique<Data>(Data{PreparedReference(name, toFile(name, std::move(image)), settings)});
  });
}
Reference::~Reference() = default;
Reference::Reference(Reference&&) noexcept = default;
Reference& Reference::operator=(Reference&&) noexcept = default;

Comparison Reference::compare(Image test, const std::vector<std::string>& metrics, bool withMaps,
                              const std::string& name) const {
  return translated([&] {
    // Prepares the test image, then measures it by all chosen metrics.
    const ComparedImage prepared = data_->prepared.prepareTest(name, toFile(name, std::move(test)));
    const std::vector<const Metric*> chosen = chosenMetrics(metrics, prepared.file.image);
    std::vector<Measured> all = measure(data_->prepared, prepared, chosen, withMaps);
    Comparison comparison{.width = prepared.file.image.width,
                          .height = prepared.file.image.height,
                          .nonFinitePixels = prepared.nonFinitePixels,
                          .results = {},
                          .json = comparisonJson(all, prepared.nonFinitePixels).dump()};
    // The results take the maps, so the JSON is made before them.
    for (Measured& measured : all) comparison.results.push_back(toResult(std::move(measured)));
    return comparison;
  });
}

}  // namespace wavecrest::api
