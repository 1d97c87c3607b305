#include "engine/pilot/walk_balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "engine/plan/survival.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"

namespace wavecrest {
namespace {

// Errors are looked at in kCells x kCells cells of the film; camera walks begin in about kPixels x kPixels pixels of
// each, kSamples in each pixel.
constexpr uint32_t kCells = 16, kPixels = 4, kSamples = 8;
constexpr uint32_t kCameraPaths = kCells * kCells * kPixels * kPixels, kLightPaths = 16384;
constexpr uint64_t kBalanceSeed = 0x62616c616e6365;
// Of the variance of a pixel's camera samples, where the filter spreads each over several pixels.
constexpr double kSpreadVariance = 1.0 / 3;
// What a shadow ray costs, of any other ray with the shading behind it.
constexpr double kShadowRay = 0.5;
constexpr double kDarkest = 0.01;  // of the mean brightness, the least that errors are relative to

// What one walk leaves: brightness of the cells' pixels, and the variance of a pixel, of as many paths as the film has
// pixels; of light walks the sum over the pixels of each cell, divided by the pixels that a cell has on average.
struct Walked {
  std::vector<double> brightness = std::vector<double>(kCells * kCells, 0);
  std::vector<std::pair<size_t, double>> variances{};  // with the cell
  double cost = 0;                                     // of a path, in rays
};

// The row or column of cells in which a row or column of pixels lies.
uint32_t cellAlong(uint32_t pixel, uint32_t size) { return pixel * kCells / size; }
// x, y: relative to the area.
size_t cellOf(const FilmArea& area, uint32_t x, uint32_t y) {
  return cellAlong(y, area.height) * kCells + cellAlong(x, area.width);
}

// How many pixels each cell has, relative to the mean. Cells of small films may have none.
std::vector<double> sharesOfCells(const FilmArea& area) {
  std::vector<double> columns(kCells, 0), shares(kCells * kCells, 0);
  for (uint32_t x = 0; x < area.width; ++x) columns[cellAlong(x, area.width)] += kCells;
  for (uint32_t y = 0; y < area.height; ++y) {
    for (uint32_t x = 0; x < kCells; ++x) shares[cellAlong(y, area.height) * kCells + x] += kCells * columns[x];
  }
  for (double& share : shares) share /= static_cast<double>(area.size());
  return shares;
}

// The pixels that camera walks begin in, as y << 16 | x.
std::vector<uint32_t> pixelsOfCells(const FilmArea& area) {
  std::vector<uint32_t> pixels;
  constexpr uint32_t kAcross = kCells * kPixels;
  const auto place = [](uint32_t i, uint32_t size) { return (2 * i + 1) * size / (2 * kAcross); };
  for (uint32_t cell = 0; cell < kCells * kCells; ++cell) {
    for (uint32_t i = 0; i < kPixels * kPixels; ++i) {
      const uint32_t x = area.x0 + place(cell % kCells * kPixels + i % kPixels, area.width);
      const uint32_t y = area.y0 + place(cell / kCells * kPixels + i / kPixels, area.height);
      pixels.push_back(y << 16 | x);
    }
  }
  return pixels;
}

double finiteOrZero(double value) { return std::isfinite(value) ? value : 0; }

// Takes all paths of a pass through it in one wave. pixels: of camera paths, whose random numbers follow from the pixel
// and the iteration. Returns what a path costs, in rays.
template <class S>
double costOfPass(const Pass<S>& pass, const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                  const uint32_t* pixels, uint32_t iteration, Wave<S>& wave, const SplatDrain<S>& drain) {
  StageCounters counters;
  const std::optional<SurvivalRule> rule = survivalRule(settings, pass.walk);
  StageContext<S> context{.scene = &plan.view,
                          .pixels = pixels,
                          .sampler = {SamplerKind::independent, kBalanceSeed, iteration},
                          .limits = settings.limits,
                          .survival = pointerTo(rule),
                          .mis = misSettings(pass.strategies, plan.mergeRadius, wave.pathCount, 0),
                          .film = area.window(),
                          .counters = &counters};
  runPass(pass, context, wave, nullptr, drain);
  return (static_cast<double>(counters.raysClosest) + kShadowRay * static_cast<double>(counters.raysShadow)) /
         static_cast<double>(wave.pathCount);
}

template <class S>
Walked walkCamera(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const std::vector<uint32_t> pixels = pixelsOfCells(area);
  Wave<S> wave(kCameraPaths, plan.needs);
  Walked walked;
  std::vector<double> sums(kCameraPaths, 0), squares(kCameraPaths, 0);
  for (uint32_t sample = 0; sample < kSamples; ++sample) {
    wave.pathCount = kCameraPaths;
    walked.cost +=
        costOfPass(plan.pipeline.cameraPass(), plan, settings, area, pixels.data(), sample, wave, {}) / kSamples;
    for (size_t i = 0; i < kCameraPaths; ++i) {
      const double value = finiteOrZero((wave.radiance.red[i] + wave.radiance.green[i] + wave.radiance.blue[i]) / 3);
      sums[i] += value;
      squares[i] += value * value;
    }
  }
  const double spread = spreadsSamples(plan, settings) ? kSpreadVariance : 1;
  std::vector<uint32_t> paths(kCells * kCells, 0);  // of each cell
  for (size_t i = 0; i < kCameraPaths; ++i) {
    const size_t cell = cellOf(area, (pixels[i] & 0xffffu) - area.x0, (pixels[i] >> 16) - area.y0);
    const double variance = std::max(squares[i] - sums[i] * sums[i] / kSamples, 0.0) / (kSamples - 1);
    walked.variances.emplace_back(cell, spread * variance);
    ++paths[cell];
  }
  for (size_t i = 0; i < kCameraPaths; ++i) {
    const size_t cell = walked.variances[i].first;
    walked.brightness[cell] += sums[i] / (kSamples * paths[cell]);
  }
  return walked;
}

template <class S>
Walked walkLight(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                 const std::vector<double>& shares) {
  Wave<S> wave(kLightPaths, plan.needs);
  wave.pathCount = kLightPaths;
  // Pixels of a cell on average.
  const double pixels = static_cast<double>(area.size()), inCell = pixels / (kCells * kCells);
  Walked walked;
  std::vector<double> squares(kCells * kCells, 0);
  const SplatDrain<S> drain = [&](Splats<S>& splats) {
    for (size_t i = 0; i < splats.size; ++i) {
      const size_t cell = cellOf(area, splats.pixel[i] % area.width, splats.pixel[i] / area.width);
      const double value = finiteOrZero((splats.red[i] + splats.green[i] + splats.blue[i]) / 3);
      walked.brightness[cell] += value / (kLightPaths * inCell * shares[cell]);
      squares[cell] += value * value / (kLightPaths * inCell * pixels);
    }
    splats.size = 0;
  };
  walked.cost = costOfPass<S>(*plan.pipeline.lightPass(), plan, settings, area, nullptr, 0, wave, drain);
  for (size_t cell = 0; cell < squares.size(); ++cell) walked.variances.emplace_back(cell, squares[cell]);
  return walked;
}

// The mean over pixels of the variance over the squared brightness of their cell.
double relativeVariance(const Walked& walked, const std::vector<double>& brightness,
                        const std::vector<double>& shares) {
  const double mean = std::inner_product(brightness.begin(), brightness.end(), shares.begin(), 0.0) / (kCells * kCells);
  double sum = 0;
  for (const auto& [cell, variance] : walked.variances) {
    const double here = std::max(brightness[cell], kDarkest * mean);
    if (here > 0) sum += variance / (here * here);
  }
  return sum / static_cast<double>(walked.variances.size());
}

}  // namespace

template <class S>
uint32_t lightWalksPerCameraWalk(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  if (!settings.balancedWalks || settings.method != Method::lt) return 1;
  const FlushToZero flushToZero;
  const std::vector<double> shares = sharesOfCells(area);
  const Walked camera = walkCamera(plan, settings, area), light = walkLight(plan, settings, area, shares);
  std::vector<double> brightness = camera.brightness;
  for (size_t cell = 0; cell < brightness.size(); ++cell) brightness[cell] += light.brightness[cell];
  // V_L / n + V_C for n c_L + c_C is least at n^2 = V_L c_C / (V_C c_L).
  const double ofLight = relativeVariance(light, brightness, shares) * camera.cost;
  const double ofCamera = relativeVariance(camera, brightness, shares) * light.cost;
  if (!(ofLight > ofCamera)) return 1;
  // A power of two, so that the last bits, in which instruction sets and precisions differ, do not change the choice.
  // Random numbers tell apart so many light paths.
  const double wanted = std::min(0.5 * std::log2(ofLight / std::max(ofCamera, 1e-9 * ofLight)), 30.0);
  const auto most = std::min<uint64_t>(kMostLightWalks, kMostPaths / area.size());
  uint32_t walks = 1u << static_cast<uint32_t>(std::lround(wanted));
  while (walks > most) walks /= 2;
  return walks;
}
template uint32_t lightWalksPerCameraWalk(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template uint32_t lightWalksPerCameraWalk(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
