// wavecrest compare REFERENCE TEST...: metrics of images against one reference, thresholds, false-colour maps.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/json_text.h"
#include "bench/report/picture_crop.h"
#include "bench/score_text.h"
#include "cli/commands.h"
#include "cli/compare_page.h"
#include "cli/compare_results.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "library/comparison.h"
#include "library/option_ranges.h"
#include "library/suggestion.h"
#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"
#include "metrics/prepared_reference.h"
#include "metrics/pu21.h"

namespace wavecrest {
namespace {

// The options as written on the command line. thresholds[i] and limits[i] belong to metric i of metricList().
struct CompareOptions {
  std::string reference, mapFolder, html, crop;
  std::vector<std::string> tests, metrics;
  bool json = false, gammaCorrected = false;
  double exposure = 0;
  std::vector<Option> thresholds;  // in the order of metricList()
  std::vector<double> limits;

  // Whether scores go to stdout as text. JSON or a page is alone there.
  bool printsText() const { return !json && html != kStandardStream; }
};

// Whether the threshold option of a metric was given; metric: its index in metricList().
bool hasThreshold(const CompareOptions& options, size_t metric) { return options.thresholds[metric].given(); }

// ---- which part of the images ---------------------------------------------------------------------------------------

PictureCrop cropOption(const std::string& text) {
  if (const std::optional<PictureCrop> crop = parseCrop(text)) return *crop;
  throw UsageError(fmt::format("--crop '{}': expected X,Y,WIDTHxHEIGHT in pixels from the top left", text));
}

// Keeps only the crop. Throws ImageError where the image does not contain it.
void cropTo(const PictureCrop& crop, const std::string& path, Image& image) {
  if (!crop.liesIn(image.width, image.height)) {
    throw ImageError(
        path, fmt::format("image of {}x{} pixels", image.width, image.height),
        fmt::format("expected one that holds --crop {},{},{}x{}", crop.x, crop.y, crop.width, crop.height));
  }
  Image part{crop.width, crop.height, image.channels, {}};
  part.pixels.reserve(part.pixelCount() * image.channels);
  for (uint32_t y = 0; y < crop.height; ++y) {
    const float* const row = image.pixels.data() + (size_t{crop.y + y} * image.width + crop.x) * image.channels;
    part.pixels.insert(part.pixels.end(), row, row + size_t{crop.width} * image.channels);
  }
  image = std::move(part);
}

// Reads an image, and crops it if --crop asks for that.
ImageFile readPart(const CompareOptions& options, const std::string& path) {
  ImageFile file = readImage(path);
  if (!options.crop.empty()) cropTo(cropOption(options.crop), path, file.image);
  return file;
}

// A note where the data windows of two files begin at different places: their pixels are compared all the same.
void noteWindows(const CompareOptions& options, const ImageFile& reference, const std::string& file,
                 const ImageFile& test) {
  const auto [x, y] = reference.corner;
  const auto [testX, testY] = test.corner;
  if (reference.corner == test.corner) return;
  tell(
      "wavecrest: note: the data window of {} begins at {},{} and that of {} at {},{}; their top left pixels are "
      "compared",
      options.reference, x, y, file, testX, testY);
}

// A note where an image is brighter than what the PU21 metrics tell apart. Pixels that are not finite are not counted.
void notePu21Range(const CompareOptions& options, const std::vector<const Metric*>& metrics, const std::string& file,
                   const ImageFile& image) {
  const bool measured =
      std::ranges::any_of(metrics, [](const Metric* metric) { return metric->name.starts_with("pu21"); });
  if (!measured) return;
  const double brightest = kPu21Brightest / (kPu21WhiteLuminance * std::exp2(options.exposure));
  const Image light = linearLight(image);
  size_t count = 0;
  for (size_t pixel = 0; pixel < light.pixelCount(); ++pixel) {
    const float* const rgb = light.pixels.data() + 3 * pixel;
    if (finitePixel(image.image, pixel)) count += std::max({rgb[0], rgb[1], rgb[2]}) > brightest;
  }
  if (count == 0) return;
  tell(
      "wavecrest: note: {} of {} pixels of {} are brighter than {:.0f} cd/m2, where PU21 ends, and count as that; a "
      "lower "
      "--exposure shows more of them",
      count, image.image.pixelCount(), file, kPu21Brightest);
}

// ---- which metrics --------------------------------------------------------------------------------------------------

// Whether a metric was named or has a threshold; metric: its index in metricList().
bool isAskedFor(const CompareOptions& options, size_t metric) {
  return hasThreshold(options, metric) ||
         std::ranges::find(options.metrics, metricList()[metric].name) != options.metrics.end();
}

// Whether it is measured where the image is large enough: it was asked for, or is a default where none was named.
bool isWanted(const CompareOptions& options, size_t metric) {
  return isAskedFor(options, metric) || (options.metrics.empty() && metricList()[metric].byDefault);
}

// Names the metrics with one of these inputs, as "ssim, flip or cvvdp".
std::string metricsThatSee(const std::vector<MetricInput>& inputs) {
  std::vector<std::string_view> names;
  for (const Metric& metric : metricList()) {
    if (std::ranges::find(inputs, metric.input) != inputs.end()) names.push_back(metric.name);
  }
  return alternatives(names);
}

// Refuses options that nothing of what is measured or shown depends on. Throws UsageError.
void refuseUnusedOptions(const CompareOptions& options) {
  const auto sees = [&](MetricInput input) {
    for (size_t i = 0; i < metricList().size(); ++i) {
      if (isWanted(options, i) && metricList()[i].input == input) return true;
    }
    return false;
  };
  if (options.gammaCorrected && !sees(MetricInput::values)) {
    throw UsageError(
        fmt::format("--gamma: is for errors of values, which are not measured; expected {} among --metrics",
                    metricsThatSee({MetricInput::values})));
  }
  // Pictures of the page are exposed whatever is measured.
  const bool exposes =
      sees(MetricInput::codes) || sees(MetricInput::exposedLight) || options.gammaCorrected || !options.html.empty();
  if (options.exposure != 0 && !exposes) {
    throw UsageError(
        fmt::format("--exposure: changes nothing of what is measured; expected {} among --metrics, --gamma or --html",
                    metricsThatSee({MetricInput::codes, MetricInput::exposedLight})));
  }
}

// What was named, or the defaults that the image is large enough for; a metric with a threshold is always measured.
// Throws ImageError where the image is too small for a metric that was asked for.
std::vector<const Metric*> chosenMetrics(const CompareOptions& options, const Image& image) {
  std::vector<const Metric*> chosen;
  for (size_t i = 0; i < metricList().size(); ++i) {
    const Metric& metric = metricList()[i];
    if (!isWanted(options, i)) continue;
    if (std::min(image.width, image.height) >= metric.smallestSide) {
      chosen.push_back(&metric);
      continue;
    }
    const std::string wrong =
        fmt::format("image of {}x{} pixels is too small for {}", image.width, image.height, metric.name);
    if (isAskedFor(options, i)) {
      throw ImageError(options.reference, wrong, fmt::format("expected at least {0}x{0}", metric.smallestSide));
    }
    tell("wavecrest: note: {}, which is left out", wrong);
  }
  return chosen;
}

// ---- what comes of it -----------------------------------------------------------------------------------------------

// Makes a folder for maps. Throws UsageError where that fails.
void makeMapFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw UsageError(fmt::format("--map {}: cannot be made: {}; expected a folder that takes new files", folder.string(),
                               error.message()));
}

// Makes the folders of maps, and checks that all outputs can be written and that none is an input or another output,
// before anything is measured.
void checkFiles(const CompareOptions& options, const std::vector<std::string>& labels) {
  if (options.json && options.html == kStandardStream) {
    throw UsageError("--json and --html -: both are for stdout; expected a file for the page");
  }
  FileCheck files;
  files.input("REFERENCE", options.reference);
  for (const std::string& test : options.tests) files.input("TEST", test);
  if (!options.html.empty()) files.output("--html", options.html);
  if (options.mapFolder.empty()) return;
  for (const std::string& label : labels) {
    for (const Metric& metric : metricList()) {
      const std::filesystem::path file = mapFile(options.mapFolder, label, labels.size() == 1, metric);
      makeMapFolder(file.parent_path());
      files.output("--map", file);
    }
  }
}

// Writes each map as a PNG in false colours.
void writeMaps(const CompareOptions& options, const std::vector<MeasuredTest>& tests) {
  for (const MeasuredTest& test : tests) {
    for (const Measured& score : test.scores) {
      const auto file = mapFile(options.mapFolder, test.label, tests.size() == 1, *score.metric);
      const ShownMap map = showMap(score, test.picture.width, test.picture.height);
      writePng(file.string(), map.picture);
      if (options.printsText()) printOut("map {}: 0 to {:.6g}\n", file.string(), map.range);
    }
  }
}

// Whether the test meets all thresholds; each one that it misses is told. A NaN misses its threshold, and an image with
// pixels that are not finite misses any.
bool checkThresholds(const CompareOptions& options, const MeasuredTest& test, bool single) {
  const std::string of = single ? "" : test.file + ": ";
  bool held = true, asked = false;
  for (size_t i = 0; i < metricList().size(); ++i) {
    if (!hasThreshold(options, i)) continue;
    asked = true;
    const Metric& metric = metricList()[i];
    const auto measured = std::find_if(test.scores.begin(), test.scores.end(),
                                       [&](const Measured& score) { return score.metric == &metric; });
    const double score = mainScore(metric, measured->measurement), limit = options.limits[i];
    if (metric.higherIsBetter ? score >= limit : score <= limit) continue;
    tell("wavecrest: check failed: {}{} is {}; --{} asks for {}", of, metric.name,
         scoreBesideTarget(score, limit, metric.higherIsBetter, 9), metric.threshold, limit);
    held = false;
  }
  if (!asked || test.nonFinitePixels == 0) return held;
  tell("wavecrest: check failed: {}{} of {} pixels are not finite; a check asks for numbers", of, test.nonFinitePixels,
       test.picture.pixelCount());
  return false;
}

// One test by all metrics. label: names its maps.
MeasuredTest measureTest(const PreparedReference& reference, const std::string& file, const std::string& label,
                         ImageFile image, const std::vector<const Metric*>& metrics, bool withMaps, bool withLight) {
  ComparedImage test = reference.prepareTest(file, std::move(image));
  MeasuredTest measured{.file = file,
                        .label = label,
                        .picture = reference.pictureOf(test),
                        .light = {},
                        .nonFinitePixels = test.nonFinitePixels,
                        .scores = measure(reference, test, metrics, withMaps)};
  if (withLight) measured.light = std::move(test.file);
  return measured;
}

int compare(const CompareOptions& options) {
  // Checks options and file names.
  checkMetricNames(options.metrics);
  refuseUnusedOptions(options);
  const std::vector<std::string> labels = uniqueLabels(options.tests);
  checkFiles(options, labels);
  // Prepares the reference once for all tests.
  ComparisonSettings settings;
  settings.exposure = options.exposure;
  settings.gammaCorrectedErrors = options.gammaCorrected;
  const PreparedReference reference(options.reference, readPart(options, options.reference), settings);
  const std::vector<const Metric*> metrics = chosenMetrics(options, reference.image().file.image);
  notePu21Range(options, metrics, options.reference, reference.image().file);

  // Measures the tests.
  const bool withMaps = !options.mapFolder.empty() || !options.html.empty();
  std::vector<MeasuredTest> tests;
  for (size_t i = 0; i < options.tests.size(); ++i) {
    const std::string& file = options.tests[i];
    ImageFile test = readPart(options, file);
    noteWindows(options, reference.image().file, file, test);
    notePu21Range(options, metrics, file, test);
    tests.push_back(measureTest(reference, file, labels[i], std::move(test), metrics, withMaps, !options.html.empty()));
  }
  // Shows scores, maps and page.
  if (options.printsText()) printText(tests);
  if (options.json) printOut("{}\n", jsonText(toJson(tests), 2));
  if (!options.mapFolder.empty()) writeMaps(options, tests);
  if (!options.html.empty()) writeText(options.html, comparePage(reference, tests));
  // Checks all tests, also after one that fails.
  bool held = true;
  for (const MeasuredTest& test : tests) held = checkThresholds(options, test, tests.size() == 1) && held;
  return held ? kExitDone : kExitCheck;
}

}  // namespace

void addCompareCommand(CommandLine& program, int& exitCode) {
  const Command command = program.add("compare", "measure test images against a reference");
  auto options = std::make_shared<CompareOptions>();
  command.add("REFERENCE", options->reference, "EXR, PFM, HDR or PNG").required();
  command.add("TEST", options->tests, "images of the same size").required();
  command
      .add("--metrics", options->metrics,
           "which of " + metricNames() + "; default: all but hdrflip that the image is large enough for")
      .separatedByCommas()
      .repeatable();
  command.addFlag("--json", options->json, "print one JSON object; of several tests an array of them");
  command.add("--map", options->mapFolder, "write a false-colour PNG of each metric into this folder");
  command.add("--html", options->html, "write scores, images and maps as one page; - for stdout");
  command.add("--crop", options->crop, "compare this part only: X,Y,WIDTHxHEIGHT");
  command.add("--exposure", options->exposure, "stops applied to light before it becomes 8-bit codes or PU21")
      .between(kExposureRange);
  command.addFlag("--gamma", options->gammaCorrected, "rmse, relmse and mape on gamma-corrected 8-bit values");
  options->limits.resize(metricList().size());
  for (size_t i = 0; i < metricList().size(); ++i) {
    const Metric& metric = metricList()[i];
    options->thresholds.push_back(command.add(
        "--" + std::string(metric.threshold), options->limits[i],
        fmt::format("exit code 4 if {} is {} than this", metric.title, metric.higherIsBetter ? "less" : "more")));
  }
  command.run([options, &exitCode] { exitCode = compare(*options); });
}

}  // namespace wavecrest
