// Metrics: how far a test image is from a reference.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "wavecrest/export.h"
#include "wavecrest/image.h"

namespace wavecrest::api {

struct MetricInfo {
  std::string name;    // "ssim": what compare() takes
  std::string symbol;  // "SSIM": for axes and table heads
  std::string title, basis;
  bool higherIsBetter = false;
  bool byDefault = false;     // measured when no metric is named
  uint32_t smallestSide = 1;  // images with a shorter side are refused
};
WAVECREST_EXPORT std::vector<MetricInfo> metrics();

struct NamedScore {
  std::string name;  // as in results files: "rmse", "relmse_trimmed", "ssim", "ssim_r", "q_mos", "q"
  double value = 0;
};

struct MetricResult {
  std::string metric;
  double score = 0;                // the one that counts
  std::vector<NamedScore> scores;  // all, that one included
  std::vector<float> map;          // badness of each pixel, 0 = none; empty unless asked for
  double mapRange = 0;             // the value that false colours show brightest
};

struct Comparison {
  uint32_t width = 0, height = 0;
  uint64_t nonFinitePixels = 0;  // in either image; they are left out
  std::vector<MetricResult> results;
  std::string json;  // the object that `wavecrest compare --json` prints
};

struct CompareOptions {
  double exposure = 0;                // stops, -100 to 100, applied to light before it becomes 8-bit codes or PU21
  bool gammaCorrectedErrors = false;  // rmse, relmse and mape on 8-bit codes instead of linear light
};

// A reference image and what the metrics derive from it alone: worth keeping for many comparisons, which may run on
// several threads.
class WAVECREST_EXPORT Reference {
 public:
  // name: for messages. Throws Error for an image without a finite pixel, for sRGB values outside 0..1 and for options
  // out of range.
  explicit Reference(Image image, const CompareOptions& options = {}, const std::string& name = "reference");
  ~Reference();
  Reference(Reference&&) noexcept;
  Reference& operator=(Reference&&) noexcept;

  // metrics: empty for those that are measured by default. Throws Error for another size, for sRGB values outside
  // 0..1 and for unknown metrics.
  Comparison compare(Image test, const std::vector<std::string>& metrics = {}, bool withMaps = false,
                     const std::string& name = "test") const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// A map in the false colours of `wavecrest compare --map`: 3 * width * height bytes of sRGB.
WAVECREST_EXPORT std::vector<uint8_t> falseColours(const std::vector<float>& map, uint32_t width, uint32_t height,
                                                   double range);

}  // namespace wavecrest::api
