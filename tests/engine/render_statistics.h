// Renders for statistical tests: the same image from independent seeds, and its comparison with what is known.
//
// With 16 seeds every pixel has a mean and a standard error, and (mean - truth) / error follows Student's t with 15
// degrees of freedom. Two statistics are tested:
//  - the image's mean over its seeds: |t| <= 7, false alarm 4e-6;
//  - the mean of t^2 over all pixels, whose expectation is 15/13 and whose standard deviation 1.84 / sqrt(pixels): at
//    most 6 of these above, false alarm below 1e-6 for a thousand pixels or more.
// Seeds are fixed, so a test that passes once passes always.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/session.h"

namespace wavecrest {

using RgbImage = std::vector<float>;  // row by row, as Film::resolve()

inline RgbImage render(const Scene& scene, const RenderSettings& settings, uint64_t iterations) {
  const auto session = Session::create(scene, settings);
  session->renderUntil(iterations, std::nullopt);
  return session->film().resolve();
}

constexpr size_t kSeeds = 16;

struct SeedMeans {
  uint32_t width = 0;
  std::vector<double> mean, error;  // of each value of the image
  std::vector<RgbImage> images;     // one per seed
};

inline SeedMeans renderSeeds(const Scene& scene, RenderSettings settings, uint64_t iterations,
                             uint64_t firstSeed = 1000) {
  SeedMeans out;
  out.width = scene.film.width;
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    settings.seed = firstSeed + seed;
    out.images.push_back(render(scene, settings, iterations));
  }
  const size_t values = out.images[0].size();
  for (size_t i = 0; i < values; ++i) {
    double sum = 0, squares = 0;
    for (const RgbImage& image : out.images) sum += image[i];
    const double mean = sum / kSeeds;
    for (const RgbImage& image : out.images) squares += (image[i] - mean) * (image[i] - mean);
    out.mean.push_back(mean);
    out.error.push_back(std::sqrt(squares / (kSeeds - 1) / kSeeds));
  }
  return out;
}

// What value c of pixel (x, y) should be; nothing where no answer is known.
using Truth = std::function<std::optional<double>(uint32_t x, uint32_t y, size_t c)>;

// relativeRounding: what an exact estimator may still be off by.
inline void expectTruth(const SeedMeans& seeds, const Truth& truth, const std::string& where,
                        double relativeRounding = 2e-6) {
  double sumT2 = 0, truthMean = 0, largest = 0;
  std::vector<double> seedMeans(kSeeds, 0.0);
  size_t count = 0, largestAt = 0;
  for (size_t i = 0; i < seeds.mean.size(); ++i) {
    const auto pixel = static_cast<uint32_t>(i / 3);
    const std::optional<double> want = truth(pixel % seeds.width, pixel / seeds.width, i % 3);
    if (!want) continue;
    const double rounding = relativeRounding * std::abs(*want);
    const double error = std::hypot(seeds.error[i], rounding);
    const double t = error > 0 ? (seeds.mean[i] - *want) / error : seeds.mean[i] == *want ? 0 : HUGE_VAL;
    sumT2 += t * t;
    if (std::abs(t) > largest) {
      largest = std::abs(t);
      largestAt = i;
    }
    truthMean += *want;
    for (size_t s = 0; s < kSeeds; ++s) seedMeans[s] += seeds.images[s][i];
    ++count;
  }
  ASSERT_GT(count, 0u) << where;
  const auto n = static_cast<double>(count);
  truthMean /= n;
  double mean = 0, squares = 0;
  for (double& m : seedMeans) mean += (m /= n) / kSeeds;
  for (const double m : seedMeans) squares += (m - mean) * (m - mean);
  const double error = std::hypot(std::sqrt(squares / (kSeeds - 1) / kSeeds), relativeRounding * std::abs(truthMean));
  EXPECT_LE(std::abs(mean - truthMean), 7 * error) << where << ": mean " << mean << ", known " << truthMean;
  constexpr double kNu = kSeeds - 1;
  const double bound = kNu / (kNu - 2) + 6 * 1.84 / std::sqrt(n);
  EXPECT_LE(sumT2 / n, bound) << where << ": largest |t| " << largest << " at value " << largestAt << ", "
                              << seeds.mean[largestAt] << " +- " << seeds.error[largestAt];
}

// Two images of the same truth, value by value: t of the difference with at least 15 degrees of freedom, same bounds.
inline void expectSameTruth(const SeedMeans& a, const SeedMeans& b, const std::string& where) {
  double sumT2 = 0;
  std::vector<double> differences(kSeeds, 0.0);
  for (size_t i = 0; i < a.mean.size(); ++i) {
    const double error = std::hypot(a.error[i], b.error[i], 2e-6 * std::abs(a.mean[i]));
    if (error > 0) sumT2 += std::pow((a.mean[i] - b.mean[i]) / error, 2);
    for (size_t s = 0; s < kSeeds; ++s) differences[s] += a.images[s][i] - b.images[s][i];
  }
  const auto n = static_cast<double>(a.mean.size());
  double mean = 0, squares = 0;
  for (double& d : differences) mean += (d /= n) / kSeeds;
  for (const double d : differences) squares += (d - mean) * (d - mean);
  EXPECT_LE(std::abs(mean), 7 * std::sqrt(squares / (kSeeds - 1) / kSeeds) + 1e-12) << where;
  constexpr double kNu = kSeeds - 1;
  EXPECT_LE(sumT2 / n, kNu / (kNu - 2) + 6 * 1.84 / std::sqrt(n)) << where;
}

// ---- what a path tracer may be asked to run with --------------------------------------------------------------------

struct Variant {
  Precision precision;
  SamplerKind sampler;
  Accel accel;
};

inline std::string nameOf(const Variant& v) {
  return std::string(kPrecisionNames[static_cast<size_t>(v.precision)]) + "_" + std::string(toString(v.sampler)) + "_" +
         std::string(kAccelNames[static_cast<size_t>(v.accel)]);
}

inline std::vector<Variant> allVariants() {
  std::vector<Variant> list;
  for (const Precision precision : {Precision::floating, Precision::doubled, Precision::fast}) {
    for (const SamplerKind sampler : kAllSamplerKinds) {
      for (const Accel accel : {Accel::embree, Accel::small}) list.push_back({precision, sampler, accel});
    }
  }
  return list;
}

inline RenderSettings settingsFor(const Variant& variant) {
  RenderSettings settings;
  settings.precision = variant.precision;
  settings.sampler = variant.sampler;
  settings.accel = variant.accel;
  settings.isa = bestIsa();
  settings.threads = 2;
  settings.waveSize = 512;
  return settings;
}

}  // namespace wavecrest
