// Renders for statistical tests: the same image from independent seeds, and its comparison with what is known.
//
// With 16 seeds every tile of 8x8 pixels has a mean and a standard error, and (mean - truth) / error follows Student's
// t with 15 degrees of freedom (METHODS 10.4). Two statistics are tested:
//  - the image's mean over its seeds: |t| <= 7, false alarm 4e-6;
//  - the mean of t^2 over all tiles, whose expectation is 15/13 and whose standard deviation 1.84 / sqrt(tiles): at
//  most
//    6 of these above.
// Seeds are fixed, so a test that passes once passes always. Where iterations are uncorrelated, four runs of iterations
// of one session take the place of four seeds (renderSeeds).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/session.h"

namespace wavecrest {

using RgbImage = std::vector<float>;  // row by row, as Film::resolve()
inline double sumOf(const RgbImage& image) { return std::accumulate(image.begin(), image.end(), 0.0); }

inline RgbImage render(const Scene& scene, const RenderSettings& settings, uint64_t iterations) {
  const auto session = Session::create(scene, settings);
  session->renderUntil(iterations, std::nullopt);
  return session->film().resolve();
}

constexpr size_t kSeeds = 16;      // independent images
constexpr size_t kRunsOfSeed = 4;  // of them from one session, where its iterations are uncorrelated

// Sobol points of one seed belong together, and chains go on from where they are. What gpt has learned from earlier
// iterations changes the variance of later ones, not their mean.
inline bool iterationsAreUncorrelated(const RenderSettings& settings) {
  return settings.sampler == SamplerKind::independent && settings.method != Method::mlt;
}

struct SeedMeans {
  uint32_t width = 0;
  std::vector<double> mean, error;  // of each value of the image
  std::vector<RgbImage> images;     // one per seed
};

// Images of as many runs of a session, each of so many iterations: what a run adds to the sum of those before.
inline void appendRuns(Session& session, size_t runs, uint64_t iterations, std::vector<RgbImage>& images) {
  RgbImage before;
  for (size_t run = 0; run < runs; ++run) {
    session.renderUntil((run + 1) * iterations, std::nullopt);
    const RgbImage all = session.film().resolve();  // the mean over all runs so far
    before.resize(all.size());
    RgbImage own(all.size());
    const auto done = static_cast<double>(run);
    for (size_t i = 0; i < all.size(); ++i) own[i] = static_cast<float>((done + 1) * all[i] - done * before[i]);
    images.push_back(std::move(own));
    before = all;
  }
}

// Creating a session takes longer than the iterations of most tests, so one session renders several of the images where
// its iterations are uncorrelated.
inline SeedMeans renderSeeds(const Scene& scene, RenderSettings settings, uint64_t iterations,
                             uint64_t firstSeed = 1000) {
  SeedMeans out;
  out.width = scene.film.width;
  const size_t runs = iterationsAreUncorrelated(settings) ? kRunsOfSeed : 1;
  for (settings.seed = firstSeed; out.images.size() < kSeeds; ++settings.seed) {
    appendRuns(*Session::create(scene, settings), runs, iterations, out.images);
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

// Differences of one image per seed, as t values: of the whole image, and of tiles of 8x8 pixels. Single pixels would
// not do: a few samples of a skewed distribution are far from normal, and their t values with them.
struct TileStatistics {
  double imageT = 0;    // |t| of the mean over all values
  double meanT2 = 0;    // mean of t^2 over tiles
  double largestT = 0;  // largest |t| of a tile
  size_t tiles = 0;
  std::string describe() const {
    return "image |t| " + std::to_string(imageT) + ", mean t^2 of tiles " + std::to_string(meanT2) + ", largest |t| " +
           std::to_string(largestT);
  }
};

// difference(seed, i): of value i, or nothing where it is not known. rounding: what an exact estimator may be off by.
inline TileStatistics tileStatistics(uint32_t width, size_t values,
                                     const std::function<std::optional<double>(size_t seed, size_t i)>& difference,
                                     double rounding) {
  constexpr uint32_t kTile = 8;
  const uint32_t across = (width + kTile - 1) / kTile;
  const size_t rows = values / 3 / width;
  const size_t tileCount = size_t{across} * ((rows + kTile - 1) / kTile);
  std::vector<std::array<double, kSeeds>> sums(tileCount + 1, std::array<double, kSeeds>{});  // the last: all tiles
  std::vector<size_t> counts(tileCount + 1, 0);
  for (size_t i = 0; i < values; ++i) {
    const size_t x = i / 3 % width, y = i / 3 / width;
    const size_t tile = y / kTile * across + x / kTile;
    if (!difference(0, i)) continue;
    ++counts[tile];
    ++counts[tileCount];
    for (size_t s = 0; s < kSeeds; ++s) {
      const double d = *difference(s, i);
      sums[tile][s] += d;
      sums[tileCount][s] += d;
    }
  }
  const auto t = [&](size_t tile) {
    const auto n = static_cast<double>(counts[tile]);
    double mean = 0, squares = 0;
    for (const double sum : sums[tile]) mean += sum / n / kSeeds;
    for (const double sum : sums[tile]) squares += (sum / n - mean) * (sum / n - mean);
    const double error = std::hypot(std::sqrt(squares / (kSeeds - 1) / kSeeds), rounding);
    return mean == 0 ? 0.0 : mean / error;  // both exactly known: equal, or infinitely far apart
  };
  TileStatistics out;
  out.imageT = counts[tileCount] == 0 ? 0 : std::abs(t(tileCount));
  for (size_t tile = 0; tile < tileCount; ++tile) {
    if (counts[tile] == 0) continue;
    const double value = std::abs(t(tile));
    out.meanT2 += value * value;
    out.largestT = std::max(out.largestT, value);
    ++out.tiles;
  }
  out.meanT2 /= std::max<double>(1, static_cast<double>(out.tiles));
  return out;
}

// With 15 degrees of freedom |t| > 7 has probability 4e-6. t^2 has mean 15/13 and standard deviation 1.84, so its mean
// over the tiles exceeds the bound with a probability below 1e-6 where tiles are independent.
inline void expectWithinNoise(const TileStatistics& statistics, const std::string& where) {
  ASSERT_GT(statistics.tiles, 0u) << where;
  constexpr double kNu = kSeeds - 1;
  EXPECT_LE(statistics.imageT, 7) << where << ": " << statistics.describe();
  EXPECT_LE(statistics.meanT2, kNu / (kNu - 2) + 6 * 1.84 / std::sqrt(static_cast<double>(statistics.tiles)))
      << where << ": " << statistics.describe();
}

// relativeRounding: what an exact estimator may still be off by.
inline void expectTruth(const SeedMeans& seeds, const Truth& truth, const std::string& where,
                        double relativeRounding = 2e-6) {
  double largest = 0;
  const auto wanted = [&](size_t i) {
    const auto pixel = static_cast<uint32_t>(i / 3);
    return truth(pixel % seeds.width, pixel / seeds.width, i % 3);
  };
  for (size_t i = 0; i < seeds.mean.size(); ++i) largest = std::max(largest, std::abs(wanted(i).value_or(0)));
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> {
    const std::optional<double> want = wanted(i);
    if (!want) return std::nullopt;
    return seeds.images[s][i] - *want;
  };
  expectWithinNoise(tileStatistics(seeds.width, seeds.mean.size(), difference, relativeRounding * largest), where);
}

// Two estimates of the same truth.
inline void expectSameTruth(const SeedMeans& a, const SeedMeans& b, const std::string& where) {
  double largest = 0;
  for (const double mean : a.mean) largest = std::max(largest, std::abs(mean));
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> { return a.images[s][i] - b.images[s][i]; };
  expectWithinNoise(tileStatistics(a.width, a.mean.size(), difference, 2e-6 * largest), where);
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
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const SamplerKind sampler : kAllSamplerKinds) {
      for (const Accel accel : {Accel::embree, Accel::small, Accel::bvh}) {
        // Embree knows no precision but that of the columns.
        if (accel == Accel::embree && precision == Precision::doubled) continue;
        list.push_back({precision, sampler, accel});
      }
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
