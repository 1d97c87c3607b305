#include "tests/bench/sample_report.h"

#include <cmath>
#include <random>

namespace wavecrest {
namespace {

// A picture with an edge and a gradient, and speckle of the given strength.
ReportImage sampleImage(const std::string& label, double noise) {
  constexpr uint32_t kWidth = 96, kHeight = 72;
  ReportImage image{.label = label, .width = kWidth, .height = kHeight, .rgb = {}};
  uint32_t state = 1;
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      state = state * 1664525U + 1013904223U;
      const double speckle = noise * (static_cast<double>(state >> 8) / (1 << 24) - 0.5);
      const double grey = 60 + 120.0 * x / kWidth + (y > kHeight / 2 ? 40 : 0) + speckle;
      for (const double tint : {1.0, 0.9, 0.75}) {
        image.rgb.push_back(static_cast<uint8_t>(std::min(255.0, std::max(0.0, tint * grey))));
      }
    }
  }
  return image;
}

// Error a / sqrt(t) over a floor, one point per third of a decade.
ReportSeries sampleSeries(const std::string& method, double start, double bias) {
  ReportSeries series;
  series.method = series.label = method;
  for (const uint64_t seed : {1u, 2u}) {
    ReportRun run{.seed = seed, .points = {}};
    for (int k = 0; k <= 8; ++k) {
      const double seconds = 0.1 * std::pow(10, k / 3.0);
      const double scatter = seed == 1 ? 0.94 : 1.06;
      const double rmse = std::hypot(scatter * start / std::sqrt(seconds), bias);
      run.points.push_back({.number = static_cast<unsigned>(k),
                            .seconds = seconds,
                            .iterations = static_cast<uint64_t>(30 * seconds),
                            .values = {rmse, 20 * rmse * rmse, 1 / (1 + 4 * rmse)},
                            .further = {{"ssim_r", 0.5}}});
    }
    series.runs.push_back(run);
  }
  series.pathsPerSecond = 11.3e6;
  series.cpuSeconds = 93;
  series.stages = {{"generate", 41000000, 0.04},
                   {"extend", 250000000, 8.5},
                   {"shade", 210000000, 3.4},
                   {"occlude", 170000000, 4.6},
                   {"splat", 41000000, 0.3}};
  series.settings = {{"sampler", "independent"}, {"precision", "float"}, {"max_depth", "-1"}};
  series.finalImage = sampleImage(method + ", 46 s", 300 * start);
  series.errorMap = sampleImage(method + ", FLIP 0.2", 900 * start);
  series.bias = {{.seconds = 1, .seeds = 4, .meanSquareError = 0.02, .variance = 0.02, .bias2 = -1e-5},
                 {.seconds = 46, .seeds = 4, .meanSquareError = 0.004, .variance = 0.003, .bias2 = 0.001}};
  return series;
}

}  // namespace

ConvergenceReport sampleReport() {
  ConvergenceReport report;
  report.title = "Convergence of <three> methods";
  report.metrics = {
      {.key = "rmse", .name = "RMSE", .explanation = "linear radiance, all pixels", .idealSlope = -0.5},
      {.key = "relmse", .name = "relMSE", .explanation = "squared error over squared value", .idealSlope = -1.0},
      {.key = "ssim",
       .name = "SSIM",
       .explanation = "structure",
       .higherIsBetter = true,
       .logarithmic = false,
       .target = 0.9}};
  ReportScene first;
  first.name = "cornell-spheres";
  first.width = 96;
  first.height = 72;
  first.reference = sampleImage("reference", 0);
  first.referenceOrigin = "bpt, two halves of 3 min 20 s";
  first.noiseFloors = {0.004, std::nullopt, 0.99};
  first.errorMapScale = "Error maps: FLIP";
  first.series = {sampleSeries("pt", 0.21, 0), sampleSeries("bpt", 0.12, 0), sampleSeries("vcm", 0.1, 0.03)};
  // The first snapshot of one run came out black: nothing a logarithmic axis could show.
  first.series[0].runs[0].points[0].values[1] = 0;
  first.pathClasses = {
      {.name = "LDE", .verdicts = {{"pt", "sampled"}, {"bpt", "sampled"}, {"vcm", "sampled"}}},
      {.name = "LSDSE", .verdicts = {{"pt", "impossible"}, {"bpt", "inefficient"}, {"vcm", "sampled"}}}};
  first.refusals = {{"ppm", "has no <light>"}};
  ReportScene second = first;
  second.name = "veach-door & co";
  second.series.resize(1);
  report.scenes = {first, second};
  report.environment = {{"cpu", "AMD EPYC"}, {"isa", "avx512"}, {"threads", "2"}, {"commit", "0123abc"}};
  report.claims = {{.scene = "cornell-spheres", .statement = "pt < bpt", .verdict = "does not hold", .evidence = "0.1"},
                   {.scene = "veach-door & co", .statement = "equal", .verdict = "undecided", .evidence = "0.2"}};
  return report;
}

ReportImage noiseImage(const std::string& label, uint32_t width, uint32_t height, uint32_t seed) {
  ReportImage image{.label = label, .width = width, .height = height, .rgb = {}};
  std::mt19937 random(seed);
  for (size_t i = 0; i < size_t{3} * width * height; ++i) image.rgb.push_back(static_cast<uint8_t>(random() >> 24));
  return image;
}

}  // namespace wavecrest
