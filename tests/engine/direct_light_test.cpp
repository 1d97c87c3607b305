// Direct light of a rectangle, a triangle, a sphere and a point on a plane against closed forms, pixel by pixel.
//
// The truth of a pixel is its mean over the pixel's area, by Gauss-Legendre quadrature with 3 x 3 points: all lights
// are a good way above the plane, so the irradiance is smooth.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/compile/compiled_scene.h"
#include "engine/scene/vector_math.h"
#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

constexpr uint32_t kFilmWidth = 24, kFilmHeight = 18;
constexpr double kAlbedo = 0.7;
constexpr Rgb kRadiance{5, 3, 1};

// The plane y = 0 with its normal up, and an oblique camera above it that sees nothing else.
Scene planeScene() {
  Scene scene;
  scene.name = "plane";
  const uint32_t material = addDiffuse(scene, kAlbedo, kAlbedo, kAlbedo);
  addShape(scene, Rectangle{{-20, 0, 20}, {40, 0, 0}, {0, 0, -40}}, material);
  setCamera(scene, {0.3, 0.6, 2}, 40, kFilmWidth, kFilmHeight);
  const double tilt = 0.5;  // looks down
  scene.sensor.toWorld[1] = {0, std::cos(tilt), -std::sin(tilt), 0.6};
  scene.sensor.toWorld[2] = {0, std::sin(tilt), -std::cos(tilt), 2};
  return scene;
}

// Lambert's formula: irradiance of a surface with normal +y at p, from a polygon of unit radiance that lies wholly
// above its horizon, corners in the order that its front side sees as counter-clockwise (Arvo, "The Irradiance Jacobian
// for Partially Occluded Polyhedral Sources", 1994, eq. 2).
double polygonIrradiance(const std::vector<Double3>& polygon, const Double3& p) {
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Double3 a = normalized(polygon[i] - p), b = normalized(polygon[(i + 1) % polygon.size()] - p);
    sum += std::acos(dot(a, b)) * normalized(cross(a, b))[1];
  }
  return std::abs(sum) / 2;
}

class DirectLightTest : public testing::TestWithParam<Variant> {
 protected:
  // irradiance(p): of the plane at p, for unit radiance or intensity.
  void expectIrradiance(const Scene& scene, const std::function<double(const Double3&)>& irradiance) {
    RenderSettings settings = settingsFor(GetParam());
    settings.limits.maxDepth = 2;
    const CameraView camera = compileCamera(scene.sensor, scene.film);
    const double node = std::sqrt(0.6) / 2;
    constexpr double kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const auto truth = [&](uint32_t x, uint32_t y, size_t c) -> std::optional<double> {
      double mean = 0;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const double rasterX = x + 0.5 + (i - 1) * node, rasterY = y + 0.5 + (j - 1) * node;
          Double3 direction{}, point{};
          for (size_t k = 0; k < 3; ++k)
            direction[k] = camera.corner[k] + rasterX * camera.du[k] + rasterY * camera.dv[k];
          const double t = -camera.origin[1] / direction[1];
          for (size_t k = 0; k < 3; ++k) point[k] = camera.origin[k] + t * direction[k];
          mean += kWeights[i] * kWeights[j] * irradiance(point);
        }
      }
      return kAlbedo / std::numbers::pi * kRadiance[c] * mean;
    };
    expectTruth(renderSeeds(scene, settings, samples(32, 8)), truth, "direct light");
  }
};

TEST_P(DirectLightTest, ofATiltedRectangle) {
  Scene scene = planeScene();
  const Rectangle light{{-0.9, 1.4, -0.8}, {1.3, 0.2, 0.1}, {0.1, 0.5, 0.9}};
  addShape(scene, light, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, kRadiance);
  const Double3 &p = light.corner, u = p + light.edgeU, v = p + light.edgeV;
  ASSERT_LT(cross(light.edgeU, light.edgeV)[1], 0) << "the light faces down";
  expectIrradiance(scene, [&](const Double3& at) { return polygonIrradiance({p, u, u + light.edgeV, v}, at); });
}

TEST_P(DirectLightTest, ofATriangle) {
  Scene scene = planeScene();
  Mesh mesh;
  mesh.positions = {{-0.5f, 1.25f, -0.75f}, {0.75f, 1.5f, -0.5f}, {0.25f, 1.75f, 0.5f}};
  mesh.triangles = {{0, 1, 2}};
  addShape(scene, mesh, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, kRadiance);
  std::vector<Double3> corners;
  for (const Float3& p : mesh.positions) corners.push_back(widened(p));
  ASSERT_LT(cross(corners[1] - corners[0], corners[2] - corners[0])[1], 0) << "the light faces down";
  expectIrradiance(scene, [&](const Double3& at) { return polygonIrradiance(corners, at); });
}

// A sphere above the horizon, seen at distance d: pi (R / d)^2 cos(theta).
TEST_P(DirectLightTest, ofASphere) {
  Scene scene = planeScene();
  const Sphere light{.center = {0.2, 1.2, -0.3}, .radius = 0.5, .flipNormals = false, .toWorld = {}};
  addShape(scene, light, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, kRadiance);
  expectIrradiance(scene, [&](const Double3& at) {
    const Double3 to = light.center - at;
    return std::numbers::pi * light.radius * light.radius / dot(to, to) * to[1] / length(to);
  });
}

TEST_P(DirectLightTest, ofAPoint) {
  Scene scene = planeScene();
  const Double3 position{0.2, 1.1, -0.3};
  Emitter emitter;
  emitter.kind = PointEmitter{position, kRadiance};
  scene.emitters.push_back(emitter);
  expectIrradiance(scene, [&](const Double3& at) {
    const Double3 to = position - at;
    return to[1] / (dot(to, to) * length(to));
  });
}

// Several lights at once: each is picked with its own probability, and what it gives must not depend on that.
TEST_P(DirectLightTest, ofManyLightsOfDifferentPower) {
  Scene scene = planeScene();
  const uint32_t black = addDiffuse(scene, 0, 0, 0);
  std::vector<std::pair<Sphere, double>> lights;
  for (size_t i = 0; i < 5; ++i) {
    const auto step = static_cast<double>(i);
    const Sphere light{
        .center = {-0.8 + 0.4 * step, 0.8 + 0.1 * step, -0.5}, .radius = 0.1, .flipNormals = false, .toWorld = {}};
    lights.emplace_back(light, std::pow(4.0, step - 2));
    addShape(scene, light, black);
    makeLight(scene,
              {kRadiance[0] * lights[i].second, kRadiance[1] * lights[i].second, kRadiance[2] * lights[i].second});
  }
  expectIrradiance(scene, [&](const Double3& at) {
    double sum = 0;
    for (const auto& [light, power] : lights) {
      const Double3 to = light.center - at;
      sum += power * std::numbers::pi * light.radius * light.radius / dot(to, to) * to[1] / length(to);
    }
    return sum;
  });
}

INSTANTIATE_TEST_SUITE_P(PathTracing, DirectLightTest, testing::ValuesIn(allVariants()),
                         [](const auto& instance) { return nameOf(instance.param); });

// A sun lights a floor by its irradiance, whatever its size: within 5e-6 for the cosines of its disc, and one in 10^4
// directions towards the smallest sun rounds to outside of it.
TEST(DirectLight, ofASunDoesNotDependOnItsSize) {
  const auto brightness = [](const std::string& aperture) {
    const Scene scene = loadBody(
        "<sensor type=\"perspective\"><float name=\"fov\" value=\"20\"/><transform name=\"to_world\">"
        "<lookat origin=\"0, 0, 5\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>"
        "<film type=\"hdrfilm\"><integer name=\"width\" value=\"16\"/><integer name=\"height\" value=\"16\"/></film>"
        "</sensor><shape type=\"rectangle\"/><emitter type=\"sunsky\"><float name=\"sky_scale\" value=\"0\"/>"
        "<vector name=\"sun_direction\" value=\"0.6, 0, 0.8\"/><float name=\"sun_aperture\" value=\"" +
        aperture + "\"/></emitter>");
    return sumOf(render(scene, settingsFor({Precision::floating, SamplerKind::independent, Accel::small}), 64));
  };
  const double expected = brightness("0.5358");
  EXPECT_GT(expected, 0);
  for (const char* aperture : {"0.02", "1e-5"}) {
    EXPECT_NEAR(brightness(aperture), expected, 1e-3 * expected) << aperture;
  }
}

// Path tracing reads a light's texture where a ray meets it and where it was sampled, light tracing where light set
// out.
TEST(DirectLight, ofTexturedLightsIsTheSameHoweverTheyAreSampled) {
  const Scene scene = sceneFile("features/textured-lights", 48, 36);
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.limits.maxDepth = 2;
  settings.method = Method::pt;
  const SeedMeans byPaths = renderSeeds(scene, settings, samples(64, 16));
  settings.method = Method::lt;
  expectSameTruth(byPaths, renderSeeds(scene, settings, samples(64, 16)), "textured lights");
}

}  // namespace
}  // namespace wavecrest
