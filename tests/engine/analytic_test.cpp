// Path tracing where the answer is known in every pixel, for each precision policy, both samplers, both intersectors.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 24;

class AnalyticTest : public testing::TestWithParam<Variant> {
 protected:
  RenderSettings settings() const { return settingsFor(GetParam()); }
  static uint64_t iterations() { return samples(24, 6); }

  // Every pixel of the scene has the same radiance.
  void expectEverywhere(const Scene& scene, const RenderSettings& chosen, double radiance, const std::string& where) {
    expectTruth(
        renderSeeds(scene, chosen, iterations()),
        [&](uint32_t, uint32_t, size_t) -> std::optional<double> { return radiance; }, where);
  }
};

std::map<std::string, std::string> albedo(double value) { return {{"albedo", std::to_string(value)}}; }

// What k = 2, 3, ... up to K add to a geometric series that begins with 1.
double series(double rho, uint32_t maxDepth) { return (1 - std::pow(rho, maxDepth)) / (1 - rho); }

// A convex body sees only the environment: its radiance is its albedo. The silhouette, a circle of 0.7094 half widths,
// is left out.
TEST_P(AnalyticTest, whiteFurnace) {
  for (const double rho : {0.2, 0.7, 1.0}) {
    const Scene scene = sceneFile("validation/furnace-sphere", kSide, kSide, albedo(rho));
    const auto truth = [&](uint32_t x, uint32_t y, size_t) -> std::optional<double> {
      constexpr double kCentre = kSide / 2.0;
      const double radius = std::hypot(x + 0.5 - kCentre, y + 0.5 - kCentre), edge = 0.7094 * kCentre;
      if (std::abs(radius - edge) < 0.8) return std::nullopt;
      return radius < edge ? rho : 1.0;
    };
    expectTruth(renderSeeds(scene, settings(), iterations()), truth, "albedo " + std::to_string(rho));
  }
}

// Fresnel reflectance and transmittance add up to one, and the square of the IOR is undone on the way out.
TEST_P(AnalyticTest, glassFurnace) {
  expectEverywhere(sceneFile("validation/furnace-glass", kSide, kSide), settings(), 1, "glass");
}

TEST_P(AnalyticTest, mirrorFurnace) {
  Scene scene = sceneFile("validation/furnace-sphere", kSide, kSide);
  Conductor mirror;
  mirror.perfectMirror = true;
  for (Material& material : scene.materials) material.kind = mirror;
  expectEverywhere(scene, settings(), 1, "mirror");
}

// L = L_e (1 - rho^K) / (1 - rho): what a path of each length adds shows in its own K.
TEST_P(AnalyticTest, closedBoxForEachDepth) {
  for (const uint32_t maxDepth : {1u, 2u, 3u, 6u, kUnlimitedDepth}) {
    const Scene scene = sceneFile("validation/closed-box", kSide, kSide, albedo(0.5));
    RenderSettings chosen = settings();
    chosen.limits.maxDepth = maxDepth;
    expectEverywhere(scene, chosen, series(0.5, maxDepth), "K = " + std::to_string(maxDepth));
  }
}

// Paths are long: roulette's division must not change the mean.
TEST_P(AnalyticTest, closedBoxOfHighAlbedo) {
  const Scene scene = sceneFile("validation/closed-box", kSide, kSide, albedo(0.9));
  expectEverywhere(scene, settings(), series(0.9, kUnlimitedDepth), "albedo 0.9");
}

TEST_P(AnalyticTest, closedSphereForEachDepth) {
  for (const uint32_t maxDepth : {1u, 2u, 3u, 6u, kUnlimitedDepth}) {
    const Scene scene = sceneFile("validation/closed-sphere", kSide, kSide, albedo(0.5));
    RenderSettings chosen = settings();
    chosen.limits.maxDepth = maxDepth;
    expectEverywhere(scene, chosen, series(0.5, maxDepth), "K = " + std::to_string(maxDepth));
  }
}

// k-th term rho^(k-1) I / (pi R^2) for k >= 2, with I = R^2 = 4.
TEST_P(AnalyticTest, pointLightInADiffuseSphere) {
  for (const uint32_t maxDepth : {1u, 2u, 3u, kUnlimitedDepth}) {
    const Scene scene = sceneFile("validation/point-in-sphere", kSide, kSide, albedo(0.5));
    RenderSettings chosen = settings();
    chosen.limits.maxDepth = maxDepth;
    expectEverywhere(scene, chosen, (series(0.5, maxDepth) - 1) / std::numbers::pi, "K = " + std::to_string(maxDepth));
  }
}

INSTANTIATE_TEST_SUITE_P(PathTracing, AnalyticTest, testing::ValuesIn(allVariants()),
                         [](const auto& instance) { return nameOf(instance.param); });

}  // namespace
}  // namespace wavecrest
