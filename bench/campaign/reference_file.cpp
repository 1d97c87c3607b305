#include "bench/campaign/reference_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "bench/image_attributes.h"
#include "bench/until/film_error.h"
#include "bench/whole_number.h"
#include "metrics/metric_list.h"
#include "metrics/noise_floor.h"

namespace wavecrest {
namespace {

// Names of attributes and layers.
constexpr const char *kDifference = "difference", *kVariance = "variance";

// Significant bits that are kept: of the layers of a whole reference, and of the mean and the difference of a compact
// one. With two bits, squares of differences come out 1 % too small in the mean.
constexpr uint32_t kLayerBits = 12, kCompactBits = 9, kCompactLayerBits = 2;

// Rounds to so many significant bits. Floats have 24; the half that is added carries into the exponent where the
// mantissa overflows.
Image roundedTo(uint32_t bits, Image image) {
  const uint32_t dropped = 24 - bits, half = 1u << dropped >> 1;
  for (float& sample : image.pixels) {
    if (!std::isfinite(sample)) continue;
    sample = std::bit_cast<float>((std::bit_cast<uint32_t>(sample) + half) >> dropped << dropped);
  }
  return image;
}

// The square of each sample.
Image squared(Image image) {
  for (float& sample : image.pixels) sample *= sample;
  return image;
}

// ---- attributes -----------------------------------------------------------------------------------------------------

// Calls visit(name, value) for every field, in either direction.
template <class Info, class Visit>
void visitInfo(Info& info, Visit visit) {
  visit("scene", info.scene);
  visit("scene_hash", info.sceneHash);
  visit("method", info.method);
  visit("sampler", info.sampler);
  visit("precision", info.precision);
  visit("samples", info.samples);
  visit("seed", info.seed);
  visit("max_depth", info.maxDepth);
  visit("roulette_depth", info.rouletteDepth);
  visit("radius", info.radius);
  visit("radius_alpha", info.radiusAlpha);
  visit("method_reason", info.methodReason);
  visit("iterations", info.iterations);
  visit("render_seconds", info.renderSeconds);
  visit("relative_error", info.relativeError);
  visit("version", info.version);
  visit("commit", info.commit);
}

// The attributes of the file: the fields of ReferenceInfo, "biased", and the noise floors.
Metadata toMetadata(const Reference& reference) {
  Metadata metadata;
  visitInfo(reference.info,
            [&](const char* name, const auto& value) { metadata[attributeName(name)] = fmt::format("{}", value); });
  metadata[attributeName("biased")] = reference.info.isBiased() ? "true" : "false";
  const std::string floor = attributeName(kNoiseFloorKey);
  for (const auto& [name, value] : reference.noiseFloors) metadata[floor + name] = fmt::format("{}", value);
  return metadata;
}

// A visitor that reads fields from attributes. Fields without an attribute keep their value.
struct FromMetadata {
  const std::filesystem::path& path;
  const Metadata& metadata;

  void operator()(const char* name, std::string& value) const {
    if (const std::string* const text = findAttribute(metadata, name)) value = *text;
  }
  template <class Number>
  void operator()(const char* name, Number& value) const {
    const std::string* const text = findAttribute(metadata, name);
    if (text == nullptr) return;
    parse(attributeName(name), *text, value);
    // Unlike noise floors, none of these may be just any number.
    if (!(value >= 0 && static_cast<double>(value) < std::numeric_limits<double>::infinity())) {
      throw ImageError(path.string(), fmt::format("attribute {} is {}", attributeName(name), *text),
                       "expected a finite number, 0 or more");
    }
  }
  template <class Number>
  void parse(const std::string& name, const std::string& text, Number& value) const {
    const std::optional<Number> number = wholeNumber<Number>(text);
    if (!number) throw ImageError(path.string(), fmt::format("attribute {} is '{}'", name, text), "expected a number");
    value = *number;
  }
};

}  // namespace

Image Reference::half(float sign) const {
  Image image = mean;
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += sign * difference.value().pixels[i];
  return image;
}

double relativeError(const Image& mean, const Image& difference) {
  if (mean.pixels.empty()) return 0;
  // Samples that are not finite count as black, so that one of them does not hide all others.
  std::vector<float> film = mean.pixels;
  for (float& sample : film) sample = std::isfinite(sample) ? sample : 0.0f;
  const std::vector<float> weights = errorWeights(film, mean.width);
  double sum = 0;
  for (size_t i = 0; i < film.size(); ++i) {
    const double d = difference.pixels[i];
    if (std::isfinite(d)) sum += double{weights[i]} * d * d;
  }
  return std::sqrt(sum / static_cast<double>(film.size()));
}

void setHalves(Reference& reference, const Image& a, const Image& b) {
  reference.mean = a;
  reference.difference = a;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    reference.mean.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
    reference.difference->pixels[i] = 0.5f * (a.pixels[i] - b.pixels[i]);
  }
  reference.info.relativeError = relativeError(reference.mean, *reference.difference);
}

void measureNoiseFloors(Reference& reference) {
  reference.noiseFloors.clear();
  if (!reference.difference) return;
  // Only metrics that campaigns measure.
  for (const NoiseFloor& floor : noiseFloors(reference.halfA(), reference.halfB(), metricList())) {
    const Metric& metric = *findMetric(floor.metric);
    if (metric.byDefault) reference.noiseFloors[scoreName(metric, metric.score)] = floor.score;
  }
}

std::string whyNoReference(const Reference& image) {
  if (!image.difference) return "is a plain image, without the two halves of a reference";
  return image.info.sceneHash.empty() ? "does not say of which scene it is" : "";
}

void writeReference(const std::filesystem::path& path, const Reference& reference) {
  std::vector<ExrLayer> layers;
  if (reference.difference) {
    layers.push_back({kDifference, roundedTo(kLayerBits, *reference.difference)});
    layers.push_back({kVariance, roundedTo(kLayerBits, squared(*reference.difference))});
  }
  writeExr(path.string(), reference.mean, toMetadata(reference), layers);
}

void writeCompactReference(const std::filesystem::path& path, const Reference& reference) {
  Reference compact{.mean = {}, .difference = {}, .info = reference.info, .noiseFloors = reference.noiseFloors};
  // The attributes are those of the whole reference, but for the kind of samples. So its noise floors are kept too.
  compact.info.samples = ReferenceInfo::kCompactSamples;
  const ExrLayer layer{kDifference, roundedTo(kCompactLayerBits, reference.difference.value())};
  writeExr(path.string(), roundedTo(kCompactBits, reference.mean), toMetadata(compact), {&layer, 1}, {},
           ExrSamples::halves);
}

Reference readReference(const std::filesystem::path& path) {
  ImageFile file = readImage(path.string());
  if (file.encoding != Encoding::linear) {
    throw ImageError(path.string(), "is not in linear light", "expected a reference as EXR");
  }
  Reference reference{.mean = std::move(file.image), .difference = {}, .info = {}, .noiseFloors = {}};
  // Fields and noise floors, from the attributes.
  const FromMetadata from{path, file.metadata};
  visitInfo(reference.info, from);
  const std::string floor = attributeName(kNoiseFloorKey);
  for (const auto& [name, text] : file.metadata) {
    if (name.starts_with(floor)) from.parse(name, text, reference.noiseFloors[name.substr(floor.size())]);
  }
  // Only references have the attribute of the relative error. A plain render has no halves, so it is read without a
  // difference.
  if (findAttribute(file.metadata, "relative_error") != nullptr) {
    reference.difference = readExrLayer(path.string(), kDifference);
  }
  return reference;
}

}  // namespace wavecrest
