// A reference image as a file: the mean of two independent halves A and B, and what they say about its own noise.
//
// EXR, single part, fp32. R G B: the mean M = (A + B) / 2. Layer `difference`: D = (A - B) / 2, so that A = M + D and
// B = M - D. Layer `variance`: the variance of M, D squared (METHODS 8.4). Both layers are rounded to 12 significant
// bits: they are noise, and the zeros compress. String attributes say how the image was made (ReferenceInfo) and the
// noise floor of every metric, as "wavecrest:noise_floor.NAME". An EXR without the layers can be read as
// one, but is none: whyNoReference.
//
// A compact reference is a smaller file for a repository, a seventh of the size: half floats, the mean rounded to nine
// significant bits, the difference to two, and no variance. Images can be measured against it as against the whole
// file. Rendering cannot go on from it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "metrics/image/image_io.h"
#include "wavecrest/results.h"

namespace wavecrest {

// How a reference was made. The first part decides its value in the limit: rendering may go on only where it agrees.
struct ReferenceInfo {
  std::string scene, sceneHash, method, sampler, precision;
  std::string samples = kWholeSamples;  // kCompactSamples of a compact one
  uint64_t seed = 0;
  uint32_t maxDepth = 0, rouletteDepth = 0;
  double radius = 0, radiusAlpha = 0;  // of methods that merge, else 0

  std::string methodReason;
  uint64_t iterations = 0;   // of each half
  double renderSeconds = 0;  // of both halves
  double relativeError = 0;  // root of the mean relative variance, see relativeError(); of older files by another rule
  std::string version, commit;

  static constexpr const char *kWholeSamples = "float", *kCompactSamples = "half";
  bool isCompact() const { return samples == kCompactSamples; }
  bool isBiased() const { return radius > 0; }
};

struct Reference {
  Image mean;
  std::optional<Image> difference;
  ReferenceInfo info;
  MetricValues noiseFloors;

  Image halfA() const { return half(1); }
  Image halfB() const { return half(-1); }

 private:
  Image half(float sign) const;
};

// Root of the mean over samples of D^2 / brightness^2, the brightness of M around the pixel (errorWeights of
// bench/until/film_error.h): what share of its value a sample is off by, about, however bright the scene is. Of a black
// image 0.
double relativeError(const Image& mean, const Image& difference);

// Fills the noise floor of every metric that the image is large enough for, under its scoreName.
void measureNoiseFloors(Reference& reference);

// Sets mean, half difference and relative error from the halves A and B.
void setHalves(Reference& reference, const Image& a, const Image& b);

// Why an image cannot serve as a reference: a plain render has no halves, and another program's says of no scene that
// it is its own. Empty: it can.
std::string whyNoReference(const Reference& image);

// Throw ImageError. Of a compact one also where a sample is beyond kLargestHalf. Its noise floors are those of the
// whole.
void writeReference(const std::filesystem::path& path, const Reference& reference);
void writeCompactReference(const std::filesystem::path& path, const Reference& reference);
Reference readReference(const std::filesystem::path& path);

}  // namespace wavecrest
