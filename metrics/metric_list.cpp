#include "metrics/metric_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "metrics/rmse.h"

namespace wavecrest {
namespace {

// ---- errors of the numbers as read ----------------------------------------------------------------------------------

// Two images on one scale: both light, or both codes in 0..1.
struct ErrorPair {
  const Image& reference;
  const Image& test;
};

// Calls function with the pair that the error metrics compare, and returns what it returns.
template <class Function>
auto onOneScale(const PreparedReference& reference, const ComparedImage& test, Function function) {
  const ImageFile &a = reference.image().file, &b = test.file;
  const bool aLinear = a.encoding == Encoding::linear, bLinear = b.encoding == Encoding::linear;
  if (aLinear == bLinear) return function(ErrorPair{a.image, b.image});
  // One is coded: it is decoded. Codes are always finite, so linearLight changes nothing else.
  const Image decoded = linearLight(aLinear ? b : a);
  return aLinear ? function(ErrorPair{a.image, decoded}) : function(ErrorPair{decoded, b.image});
}

// 8-bit codes as values in 0..1.
Image toUnitRange(const Image8& codes) {
  Image image{codes.width, codes.height, 3, std::vector<float>(codes.pixels.size())};
  std::transform(codes.pixels.begin(), codes.pixels.end(), image.pixels.begin(),
                 [](uint8_t c) { return static_cast<float>(c) / 255.0f; });
  return image;
}

enum class MapOf { rmse, relmse, mape };

// Error of each pixel: the root mean square difference of its channels, or the mean over its channels of what relmse or
// mape is the mean of. Pixels that are not finite have no error. The others' errors end at the largest float, so that
// quantiles of the map are finite.
std::vector<float> errorMap(const ErrorPair& images, MapOf kind) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  std::vector<float> map(images.reference.pixelCount());
  for (size_t i = 0; i < map.size(); ++i) {
    double sum = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double r = images.reference.pixels[c], d = images.test.pixels[c] - r;
      sum += kind == MapOf::rmse     ? d * d
             : kind == MapOf::relmse ? d * d / (r * r + RelmseSettings{}.epsilon)
                                     : std::abs(d) / (std::abs(r) + kMapeEpsilon);
    }
    const double value = kind == MapOf::rmse ? std::sqrt(sum / 3) : sum / 3;
    map[i] = std::isfinite(value) ? static_cast<float>(std::min(value, kLargest)) : 0.0f;
  }
  return map;
}

// Sets the pixels of `codes` to NaN that are not finite in one of the images. They hold the reference's codes, which
// would count as no error.
void excludeNonFinite(const Image& reference, const Image& test, Image& codes) {
  for (size_t pixel = 0; pixel < codes.pixelCount(); ++pixel) {
    if (finitePixel(reference, pixel) && finitePixel(test, pixel)) continue;
    codes.pixels[3 * pixel] = std::numeric_limits<float>::quiet_NaN();
  }
}

// Calls measure with the pair, in codes where --gamma asks for that.
template <class Function>
void onOneScaleOrCodes(const PreparedReference& reference, const ComparedImage& test, Function measure) {
  if (reference.settings().gammaCorrectedErrors) {
    const Image a = toUnitRange(reference.image().codes);
    Image b = toUnitRange(test.codes);
    excludeNonFinite(reference.image().file.image, test.file.image, b);
    measure(ErrorPair{a, b});
  } else {
    onOneScale(reference, test, measure);
  }
}

Measurement measureRmse(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  const bool bothCodes = reference.image().file.encoding == Encoding::srgb8 && test.file.encoding == Encoding::srgb8;
  Measurement result;
  // Two 8-bit files are compared as whole codes, which is exact. An exposure changes the codes but not the values as
  // read, so the values are compared then.
  const bool asCodes = reference.settings().gammaCorrectedErrors || (bothCodes && reference.settings().exposure == 0);
  if (asCodes && test.nonFinitePixels == 0) {
    const Image8 &a = reference.image().codes, &b = test.codes;
    result.scores = {{"", rmse(a, b)}};
    if (withMap) result.map = errorMap({toUnitRange(a), toUnitRange(b)}, MapOf::rmse);
    return result;
  }
  onOneScaleOrCodes(reference, test, [&](const ErrorPair& images) {
    result.scores = {{"", rmse(images.reference, images.test)}};
    if (withMap) result.map = errorMap(images, MapOf::rmse);
  });
  return result;
}

Measurement measureRelmse(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  Measurement result;
  onOneScaleOrCodes(reference, test, [&](const ErrorPair& images) {
    const RelmseResult errors = relmse(images.reference, images.test);
    result.scores = {{"", errors.relmse}, {"trimmed", errors.trimmed}};
    if (withMap) result.map = errorMap(images, MapOf::relmse);
  });
  return result;
}

Measurement measureMape(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  Measurement result;
  onOneScaleOrCodes(reference, test, [&](const ErrorPair& images) {
    result.scores = {{"", mape(images.reference, images.test)}};
    if (withMap) result.map = errorMap(images, MapOf::mape);
  });
  return result;
}

// ---- perceptual metrics on 8-bit codes ------------------------------------------------------------------------------

// Similarities become 1 - similarity, because maps are zero where nothing differs.
std::vector<float> badness(std::vector<float> similarities) {
  for (float& v : similarities) v = 1 - v;
  return similarities;
}

Measurement measureSsim(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  SsimResult ssim = reference.ssim().compare(test.codes, withMap);
  return {{{"mean", ssim.mean},
           {"r", ssim.channels[0]},
           {"g", ssim.channels[1]},
           {"b", ssim.channels[2]},
           {"luma", ssim.luma}},
          badness(std::move(ssim.map))};
}

Measurement measureHdrVdp2(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  HdrVdp2Result result = reference.hdrVdp2().compare(test.codes, withMap);
  return {{{"q", result.q}, {"q_mos", result.qMos}}, std::move(result.probability)};
}

Measurement measureFlip(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  FlipResult result = reference.flip().compare(test.codes, withMap);
  return {{{"", result.mean}}, std::move(result.map)};
}

Measurement measureHdrFlip(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  FlipResult result = reference.hdrFlip().compare(reference.lightOf(test), withMap);
  return {{{"", result.mean}}, std::move(result.map)};
}

Measurement measureMsSsim(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  MsSsimResult result = reference.msSsim().compare(test.codes, withMap);
  return {{{"", result.mean}}, badness(std::move(result.map))};
}

Measurement measureCvvdp(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  CvvdpResult result = reference.cvvdp().compare(test.codes, withMap);
  return {{{"", result.jod}}, std::move(result.map)};
}

// ---- perceptual metrics on light ------------------------------------------------------------------------------------

Measurement measurePu21Psnr(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  Pu21PsnrResult result = reference.pu21().psnr(reference.lightOf(test), withMap);
  return {{{"", result.colour}, {"luminance", result.luminance}}, std::move(result.map)};
}

Measurement measurePu21Ssim(const PreparedReference& reference, const ComparedImage& test, bool withMap) {
  Pu21SsimResult result = reference.pu21().ssim(reference.lightOf(test), withMap);
  return {{{"", result.mean}}, badness(std::move(result.map))};
}

constexpr std::string_view kHdrVdp2Conditions = "HDR-VDP 2.2.0, sRGB display of 1 to 100 cd/m2, 30 pixels per degree";
constexpr std::string_view kFlipConditions = "67.02 pixels per degree";
constexpr std::string_view kPu21Conditions = "PU21 banding_glare, linear 1.0 after --exposure shown at 100 cd/m2";

// clang-format off
// sampleExponent: the error of a mean of n independent images falls as n^-1/2, its square as n^-1. The perceptual
// scores follow no power law.
constexpr std::array kMetrics{
    Metric{.name = "rmse", .symbol = "RMSE", .title = "root mean square error",
           .basis = "linear radiance", .input = MetricInput::values, .formula = "√ mean (x - r)²", .score = "", .higherIsBetter = false, .sampleExponent = -0.5,
           .threshold = "max-rmse", .byDefault = true, .smallestSide = 1, .mapRange = 0,
           .measure = measureRmse},
    Metric{.name = "relmse", .symbol = "relMSE", .title = "relative mean square error",
           .basis = "squared error over squared radiance", .input = MetricInput::values, .formula = "mean (x - r)² / (r² + 0.01)", .score = "", .higherIsBetter = false, .sampleExponent = -1,
           .threshold = "max-relmse", .byDefault = true, .smallestSide = 1, .mapRange = 0,
           .measure = measureRelmse},
    Metric{.name = "mape", .symbol = "MAPE", .title = "mean absolute percentage error",
           .basis = "error over radiance, 1 is 100 %", .input = MetricInput::values, .formula = "mean |x - r| / (|r| + 0.01)", .score = "", .higherIsBetter = false,
           .sampleExponent = -0.5, .threshold = "max-mape", .byDefault = true, .smallestSide = 1, .mapRange = 0,
           .measure = measureMape},
    Metric{.name = "ssim", .symbol = "SSIM", .title = "structural similarity",
           .basis = "structure of 8-bit sRGB", .input = MetricInput::codes, .formula = "Wang et al. 2004, windows of 11 x 11", .score = "mean", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-ssim", .byDefault = true, .smallestSide = kSsimSmallestSide, .mapRange = 1,
           .measure = measureSsim},
    Metric{.name = "hdrvdp2", .symbol = "Q_MOS", .title = "HDR-VDP-2.2 mean opinion score",
           .basis = "predicted opinion of viewers, 8-bit sRGB", .input = MetricInput::codes, .formula = "Narwaria et al. 2015", .score = "q_mos", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-qmos", .byDefault = true, .smallestSide = kHdrVdp2SmallestSide, .mapRange = 1,
           .measure = measureHdrVdp2, .conditions = kHdrVdp2Conditions},
    Metric{.name = "flip", .symbol = "FLIP", .title = "LDR-FLIP",
           .basis = "visible difference when flipping, 8-bit sRGB", .input = MetricInput::codes, .formula = "Andersson et al. 2020", .score = "", .higherIsBetter = false, .sampleExponent = 0,
           .threshold = "max-flip", .byDefault = true, .smallestSide = 1, .mapRange = 1,
           .measure = measureFlip, .conditions = kFlipConditions},
    Metric{.name = "hdrflip", .symbol = "HDR-FLIP", .title = "HDR-FLIP",
           .basis = "FLIP over a series of exposures", .input = MetricInput::lightAsRead, .formula = "Andersson et al. 2021", .score = "", .higherIsBetter = false, .sampleExponent = 0,
           .threshold = "max-hdrflip", .byDefault = false, .smallestSide = 1, .mapRange = 1,
           .measure = measureHdrFlip, .conditions = kFlipConditions},
    Metric{.name = "msssim", .symbol = "MS-SSIM", .title = "multi-scale structural similarity",
           .basis = "structure of 8-bit sRGB at five scales", .input = MetricInput::codes, .formula = "Wang et al. 2003", .score = "", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-msssim", .byDefault = true, .smallestSide = kMsSsimSmallestSide, .mapRange = 1,
           .measure = measureMsSsim},
    Metric{.name = "pu21psnr", .symbol = "PU21-PSNR", .title = "PSNR in PU21",
           .basis = "squared error of perceptually uniform light, dB", .input = MetricInput::exposedLight, .formula = "10 log₁₀ (256² / mean (PU(x) - PU(r))²)", .score = "", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-pu21psnr", .byDefault = true, .smallestSide = 1, .mapRange = 0,
           .measure = measurePu21Psnr, .conditions = kPu21Conditions},
    Metric{.name = "pu21ssim", .symbol = "PU21-SSIM", .title = "structural similarity in PU21",
           .basis = "structure of perceptually uniform luminance", .input = MetricInput::exposedLight, .formula = "SSIM of PU(x) and PU(r)", .score = "", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-pu21ssim", .byDefault = true, .smallestSide = 1, .mapRange = 1,
           .measure = measurePu21Ssim, .conditions = kPu21Conditions},
    Metric{.name = "cvvdp", .symbol = "JOD", .title = "ColorVideoVDP 0.5.7",
           .basis = "just-objectionable differences below 10, 8-bit sRGB", .input = MetricInput::codes, .formula = "Mantiuk et al. 2024", .score = "", .higherIsBetter = true, .sampleExponent = 0,
           .threshold = "min-cvvdp", .byDefault = true, .smallestSide = kCvvdpSmallestSide, .mapRange = 0,
           .measure = measureCvvdp, .conditions = kCvvdpConditions},
};
// clang-format on

}  // namespace

std::span<const Metric> metricList() { return kMetrics; }

const Metric* findMetric(std::string_view name) {
  const auto found = std::find_if(kMetrics.begin(), kMetrics.end(), [&](const Metric& m) { return m.name == name; });
  return found == kMetrics.end() ? nullptr : &*found;
}

std::string scoreName(const Metric& metric, std::string_view score) {
  // A score without a name, or the mean, is called as its metric. Other scores take the metric's name as a prefix,
  // unless the metric's main score has a name of its own.
  const auto isMain = [](std::string_view name) { return name.empty() || name == "mean"; };
  if (isMain(score)) return std::string(metric.name);
  return (isMain(metric.score) ? std::string(metric.name) + "_" : std::string()) + std::string(score);
}

double mainScore(const Metric& metric, const Measurement& measurement) {
  for (const Score& score : measurement.scores)
    if (score.name == metric.score) return score.value;
  throw std::logic_error("metric without its main score");
}

}  // namespace wavecrest
