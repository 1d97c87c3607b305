// Light paths from infinitely far away: that they start on the scene's box, and that whatever lies within it gets the
// light that it should, whichever of the box's faces the light shines on.
#include <gtest/gtest.h>

#include "tests/kernels/stage_room.h"

namespace wavecrest {
namespace {

constexpr size_t kLightPaths = 2048, kIterations = 16;
constexpr double kMostDeviations = 5;  // of six means at once: a false alarm in 3e5 runs, and the seed is fixed

struct LightBody {
  Point center;
  double radius;
};

class DistantLightTest : public testing::TestWithParam<Isa> {
 protected:
  DistantLightTest() : scene_({spherePrimitive({0, 0, 0}, 1)}) {
    const double center[] = {0.3, -0.2, 5}, half[] = {3, 0.4, 1.5};
    std::copy_n(center, 3, scene_.view.center);
    std::copy_n(half, 3, scene_.view.halfExtent);
    context_.scene = &scene_.view;
    context_.walk = Walk::light;
    context_.depth = 0;
    context_.sampler = {.kind = SamplerKind::independent, .seed = 7, .iteration = 0};
    context_.counters = &counters_;
    context_.mis.nextEvent = context_.mis.emission = true;
  }
  void setLight(LightKind kind, const Point& direction) {
    LightRecord<float> light{};
    light.kind = static_cast<uint32_t>(kind);
    light.texture = kNoIndex;
    for (size_t i = 0; i < 3; ++i) {
      light.normal[i] = static_cast<float>(direction[i]);
      light.radiance[i] = 1;
    }
    scene_.setLights({light});
  }
  // Calls function(ray's index) with each wave of paths.
  template <class Function>
  void forEachPath(const Function& function) {
    Wave<float> wave(kLightPaths, columnNeedsOf(Specialization::complete));
    for (context_.sampler.iteration = 0; context_.sampler.iteration < kIterations; ++context_.sampler.iteration) {
      wave.pathCount = kLightPaths;
      findStages<float>(GetParam(), Precision::floating, Specialization::complete).generateLightPaths(context_, wave);
      for (size_t i = 0; i < kLightPaths; ++i) function(wave, i);
    }
  }
  static Point originOf(const Wave<float>& wave, size_t i) {
    return {wave.rays.originX[i], wave.rays.originY[i], wave.rays.originZ[i]};
  }
  static Point directionOf(const Wave<float>& wave, size_t i) {
    return {wave.rays.directionX[i], wave.rays.directionY[i], wave.rays.directionZ[i]};
  }
  double projectedArea(const Point& w) const {
    const auto& h = scene_.view.halfExtent;
    return 4 * (std::abs(w[0]) * h[1] * h[2] + std::abs(w[1]) * h[0] * h[2] + std::abs(w[2]) * h[0] * h[1]);
  }

  StageScene<float> scene_;
  StageCounters counters_;
  StageContext<float> context_;
};
INSTANTIATE_TEST_SUITE_P(Kernels, DistantLightTest, testing::ValuesIn(availableIsas()),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// The flux through a sphere's cross section is pi r^2 times the irradiance across the light, or 4 pi times the radiance
// from all around. Spheres near the middle, in a corner and at the end of the longest edge see different faces.
TEST_P(DistantLightTest, bodiesGetTheFluxOfTheirCrossSection) {
  const LightBody bodies[] = {{{0.4, -0.2, 5}, 0.38}, {{3.0, 0.0, 3.7}, 0.19}, {{-2.3, -0.2, 5.9}, 0.35}};
  for (const LightKind kind : {LightKind::directional, LightKind::constant}) {
    setLight(kind, normalized({0.5, -0.6, 0.3}));
    for (const LightBody& body : bodies) {
      double sum = 0, squares = 0;
      forEachPath([&](const Wave<float>& wave, size_t i) {
        const Point toBody = body.center - originOf(wave, i), d = directionOf(wave, i);
        const double along = dot(toBody, d);
        const bool met = along > 0 && length(toBody - d * along) < body.radius;
        const double flux = met ? double{wave.paths.throughputR[i]} : 0;
        sum += flux;
        squares += flux * flux;
      });
      const double n = kLightPaths * kIterations, mean = sum / n;
      const double error = std::sqrt((squares / n - mean * mean) / n);
      const double want =
          3.141592653589793 * body.radius * body.radius * (kind == LightKind::constant ? 12.566370614 : 1);
      EXPECT_LT(std::abs(mean - want), kMostDeviations * error)
          << "kind " << static_cast<int>(kind) << " want " << want;
      EXPECT_LT(error, 0.1 * want);
    }
  }
}

TEST_P(DistantLightTest, pathsStartOnTheFacesThatTheLightShinesOnWithTheirDensity) {
  for (const LightKind kind : {LightKind::directional, LightKind::constant}) {
    setLight(kind, normalized({-0.2, 0.9, -0.4}));
    forEachPath([&](const Wave<float>& wave, size_t i) {
      const Point origin = originOf(wave, i), d = directionOf(wave, i);
      size_t faces = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double place = (origin[axis] - scene_.view.center[axis]) / scene_.view.halfExtent[axis];
        ASSERT_LE(std::abs(place), 1 + 1e-6);
        faces += std::abs(place + (d[axis] > 0 ? 1 : -1)) < 1e-6 ? 1 : 0;
      }
      ASSERT_GE(faces, 1u);
      const double area = projectedArea(d), emission = kind == LightKind::constant ? area * 12.566370614 : area;
      ASSERT_NEAR(wave.paths.throughputR[i], emission, 1e-5 * emission);
      ASSERT_NEAR(wave.paths.dVCM[i], area, 1e-5 * area);
      ASSERT_NEAR(wave.paths.dVC[i], kind == LightKind::constant ? emission : 0, 1e-5 * emission);
    });
  }
}

// Some directions towards a small sun round to outside of its disc, where the density is 0. Their paths carry nothing,
// and their sums are finite even where the box is so large that its area over 1e-30 overflows.
TEST_P(DistantLightTest, pathsThatRoundingLedPastTheRimOfTheSunAreDark) {
  const float black[3]{}, probability = 1;
  const AliasEntry entry{1.0f, 0};
  const Point towardsSun = normalized({0.3, 0.8, -0.4});
  EnvironmentView& map = scene_.view.environment;
  map.texels = black;
  map.probability = &probability;
  map.table = &entry;
  map.width = map.height = 1;
  map.isSky = true;
  map.sunShare = 1;
  map.sunChord2 = 7.6e-11;  // 0.001 degrees from rim to rim
  for (size_t i = 0; i < 3; ++i) {
    map.toLocal[i][i] = 1;
    map.sunDirection[i] = towardsSun[i];
    map.sunRadiance[i] = 1;
  }
  std::fill_n(scene_.view.halfExtent, 3, 1e5);
  setLight(LightKind::envmap, towardsSun);
  size_t dark = 0;
  forEachPath([&](const Wave<float>& wave, size_t i) {
    ASSERT_TRUE(std::isfinite(wave.paths.throughputR[i]));
    ASSERT_TRUE(std::isfinite(wave.paths.dVC[i]));
    ASSERT_TRUE(std::isfinite(wave.paths.dVCM[i]));
    dark += wave.paths.throughputR[i] > 0 ? 0 : 1;
  });
  EXPECT_GT(dark, 0u) << "none was led past the rim";
  EXPECT_LT(dark, kLightPaths * kIterations / 100);
}

}  // namespace
}  // namespace wavecrest
