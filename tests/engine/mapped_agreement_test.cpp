// Methods against path tracing under bump and normal maps: each kind of BSDF under both, each kind of light among them,
// every method. A light walk draws one of a map's two normals (METHODS 1.2), a camera walk has one only.
//
// 16 seeds, 16 x 12 pixels. About 200 comparisons, each with a false-alarm rate of 5e-6 (render_statistics.h). Merging
// alone may differ by a few per cent of the mean, its bias by the radius.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kMappedWidth = 16, kMappedHeight = 12;

enum class MapKind { bump, normal };

struct MappedCase {
  const char* name;
  decltype(Material::kind) kind;
  bool twoSided = false, masked = false;
  bool smooth = false;  // delta lobes: path tracing needs a light that is met by chance
};

std::vector<MappedCase> mappedCases() {
  const auto metal = [](double alpha, Distribution distribution, std::optional<TexturedFloat> alphaV = {}) {
    return Conductor{.eta = {1.657, 0.88, 0.521},
                     .k = {9.224, 6.27, 4.837},
                     .alpha = {alpha},
                     .distribution = distribution,
                     .alphaV = alphaV};
  };
  const auto glass = [](double alpha, Distribution distribution, std::optional<TexturedFloat> alphaV = {}) {
    return Dielectric{.intIor = 1.5, .extIor = 1, .alpha = {alpha}, .distribution = distribution, .alphaV = alphaV};
  };
  const auto plastic = [](double alpha, Distribution distribution) {
    return Plastic{.intIor = 1.5, .extIor = 1, .alpha = {alpha}, .distribution = distribution};
  };
  using enum Distribution;
  const TexturedFloat across{0.8};
  return {
      {"diffuse", Diffuse{{{0.7, 0.6, 0.5}}}},
      {"ggxMetal", metal(0.8, ggx)},
      {"beckmannMetal", metal(0.6, beckmann)},
      {"anisotropicMetal", metal(0.3, ggx, across)},
      {"anisotropicBeckmannMetal", metal(0.3, beckmann, across)},
      {"ggxGlass", glass(0.6, ggx)},
      {"beckmannGlass", glass(0.5, beckmann)},
      {"anisotropicGlass", glass(0.3, ggx, across)},
      {"anisotropicBeckmannGlass", glass(0.3, beckmann, across)},
      {"ggxPlastic", plastic(0.6, ggx)},
      {"beckmannPlastic", plastic(0.5, beckmann)},
      {"phong", Phong{.exponent = 6}},
      {"principled", Principled{.roughness = {0.7}, .specTrans = {0.4}, .metallic = {0.4}, .clearcoat = {0.5}}},
      {"principledThin", Principled{.thin = true, .roughness = {0.6}, .specTrans = {0.4}, .diffTrans = {0.8}}},
      {"blend", Blend{}},
      {"twoSidedMetal", metal(0.8, ggx), true},
      {"maskedMetal", metal(0.8, ggx), false, true},
      {"mirror", metal(0, ggx), false, false, true},
      {"glass", glass(0, ggx), false, false, true},
      {"pane", Dielectric{.intIor = 1.5, .extIor = 1, .thin = true}, false, false, true},
      {"plastic", plastic(0, ggx), false, false, true},
      {"blendOfAPane", Blend{}, false, false, true},
  };
}

uint32_t addNormalMap(Scene& scene) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = bitmap->height = 16;
  for (uint32_t i = 0; i < 16 * 16; ++i) {
    const float x = 0.9f * (waveHeight(i % 16, i / 16) - 0.5f), y = 0.9f * (waveHeight(i / 16, i % 16) - 0.5f);
    for (const float value : {x, y, std::sqrt(1 - x * x - y * y)}) bitmap->pixels.push_back(0.5f + 0.5f * value);
  }
  scene.textures.push_back(
      {.kind = BitmapTexture{.bitmap = bitmap}, .toUv = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

// A white ball over a wide floor of the material: half of the ball is lit by what the floor scatters, much of it at
// grazing angles, where light walks draw the wrong normal most often.
Scene mappedFloor(const MappedCase& mapped, MapKind map, RoomLight light) {
  Scene scene;
  scene.name = "floor";
  Material material;
  material.kind = mapped.kind;
  if (std::holds_alternative<Blend>(mapped.kind)) {
    const uint32_t first = mapped.smooth
                               ? addMaterial(scene, Dielectric{.intIor = 1.5, .extIor = 1, .thin = true})
                               : addMaterial(scene, Conductor{.eta = {1.6, 0.9, 0.5}, .k = {9, 6, 5}, .alpha = {0.8}});
    material.kind = Blend{.materials = {first, addDiffuse(scene, 0.6, 0.5, 0.4)}, .weights = {0.7, 0.3}};
  }
  material.twoSided = mapped.twoSided;
  if (mapped.masked) material.opacity = TexturedFloat{0.6};
  if (map == MapKind::bump) {
    material.bumpTexture = addWaves(scene);
    material.bumpScale = 0.4;
  } else {
    material.normalTexture = addNormalMap(scene);
  }
  scene.materials.push_back(material);
  constexpr double kRepeats = 3;
  scene.textures.back().toUv[0][0] = scene.textures.back().toUv[1][1] = kRepeats;
  const auto floor = static_cast<uint32_t>(scene.materials.size() - 1);
  addShape(scene, Rectangle{{-3, -1, 3}, {6, 0, 0}, {0, 0, -6}}, floor);
  addShape(scene, Sphere{.center = {0, -0.5, 0}, .radius = 0.4}, addDiffuse(scene, 0.8, 0.8, 0.8));
  addRoomLight(scene, light);
  setCamera(scene, {0, -0.6, 3.2}, 18, kMappedWidth, kMappedHeight);
  return scene;
}

RenderSettings mappedSettings(Method method, MetropolisVariant variant = MetropolisVariant::pssmlt) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.method = method;
  settings.waveSize = 256;
  settings.radius = 0.01;
  settings.metropolis.variant = variant;
  settings.metropolis.chains = 256;
  settings.metropolis.bootstrapSamples = 8192;
  return settings;
}

uint64_t mappedIterations() { return samples(48, 2); }

// Mean of merging alone against the reference. Allowed: what discs lose at edges.
void expectMappedMean(const SeedMeans& reference, const SeedMeans& found, double allowed, const std::string& where) {
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> {
    return found.images[s][i] - reference.images[s][i];
  };
  double mean = 0;
  for (const double value : reference.mean) mean += value / static_cast<double>(reference.mean.size());
  const TileStatistics statistics = tileStatistics(reference.width, reference.mean.size(), difference, allowed * mean);
  EXPECT_LE(statistics.imageT, 4) << where << ": " << statistics.describe();
}

class MappedAgreementTest : public testing::TestWithParam<size_t> {
 protected:
  static RoomLight lightOf(const MappedCase& mapped, size_t turn) {
    if (mapped.smooth) return turn % 2 == 0 ? RoomLight::shell : RoomLight::constant;
    return static_cast<RoomLight>(turn % kRoomLightNames.size());
  }
};

TEST_P(MappedAgreementTest, everyMethod) {
  const MappedCase mapped = mappedCases()[GetParam()];
  for (const MapKind map : {MapKind::bump, MapKind::normal}) {
    const RoomLight light = lightOf(mapped, 2 * GetParam() + (map == MapKind::bump ? 0 : 1));
    const Scene scene = mappedFloor(mapped, map, light);
    const SeedMeans reference = renderSeeds(scene, mappedSettings(Method::pt), 6 * mappedIterations());
    const auto where = [&](const char* method) {
      return std::string(method) + (map == MapKind::bump ? ", bump map, " : ", normal map, ") +
             kRoomLightNames[static_cast<size_t>(light)];
    };
    for (const Method method : {Method::gpt, Method::lt, Method::bpt, Method::vcm}) {
      // From a mirror to the lens, lt has nothing.
      if (mapped.smooth && method == Method::lt) continue;
      // Of lt the light walks are all that there is.
      const uint64_t count = (method == Method::lt ? 8 : 1) * mappedIterations();
      expectSameTruth(reference, renderSeeds(scene, mappedSettings(method), count, 5000),
                      where(std::string(toString(method)).c_str()));
    }
    for (const Method method : {Method::ppm, Method::bpm}) {
      expectMappedMean(reference, renderSeeds(scene, mappedSettings(method), 2 * mappedIterations(), 6000), 0.02,
                       where(std::string(toString(method)).c_str()));
    }
    for (const MetropolisVariant variant : {MetropolisVariant::mmlt, MetropolisVariant::pathspace}) {
      // Mutations of paths are refused where a blend has delta lobes.
      const bool refused = mapped.smooth && std::holds_alternative<Blend>(mapped.kind);
      if (refused && variant == MetropolisVariant::pathspace) continue;
      expectSameTruth(reference, renderSeeds(scene, mappedSettings(Method::mlt, variant), mappedIterations(), 7000),
                      where(variant == MetropolisVariant::mmlt ? "mlt of numbers" : "mlt of paths"));
    }
  }
}

// A mirror whose map turns its normal by 40 degrees towards the camera: what it sends to the ball in front of it comes
// by the mirror image of that normal, which a walk from the lamp draws now and then, and is a reflection all the same.
TEST(MappedAgreement, reflectionsByTheOtherNormal) {
  const std::vector<MappedCase> cases = mappedCases();
  const auto mirror = std::ranges::find(cases, std::string("mirror"), [](const MappedCase& c) { return c.name; });
  Scene scene = mappedFloor(*mirror, MapKind::normal, RoomLight::quad);
  auto tilted = std::make_shared<Bitmap>();
  tilted->width = tilted->height = 1;
  for (const float value : {0.0f, -0.6428f, 0.766f}) tilted->pixels.push_back(0.5f + 0.5f * value);
  for (Texture& texture : scene.textures) texture.kind = BitmapTexture{.bitmap = tilted};
  const SeedMeans reference = renderSeeds(scene, mappedSettings(Method::bpt), 8 * mappedIterations());
  const RenderSettings ofPaths = mappedSettings(Method::mlt, MetropolisVariant::pathspace);
  expectSameTruth(reference, renderSeeds(scene, ofPaths, 4 * mappedIterations(), 7000), "mlt of paths");
}

// The colour (0.5, 0.5, 0.5) stands for a vector of zero, (0.5, 0.5, 1) for the surface's own normal.
TEST(MappedAgreement, aMapWithoutNormalsChangesNothing) {
  double sums[2]{};
  for (const bool upright : {false, true}) {
    Scene scene = mappedFloor(mappedCases()[0], MapKind::normal, RoomLight::quad);
    auto flat = std::make_shared<Bitmap>();
    flat->width = flat->height = 1;
    for (const float value : {0.5f, 0.5f, upright ? 1.0f : 0.5f}) flat->pixels.push_back(value);
    for (Texture& texture : scene.textures) texture.kind = BitmapTexture{.bitmap = flat};
    sums[upright ? 1 : 0] = sumOf(render(scene, mappedSettings(Method::pt), 4));
  }
  EXPECT_GT(sums[1], 0);
  EXPECT_NEAR(sums[0], sums[1], 1e-3 * sums[1]);
}

// A bumped square wall with sides of 2 `scale`, lit obliquely.
RgbImage bumpyWall(double scale) {
  Scene scene;
  Material material;
  material.kind = Diffuse{{{0.7, 0.7, 0.7}}};
  material.bumpTexture = addWaves(scene);
  material.bumpScale = 0.4 * scale;
  scene.materials.push_back(material);
  addShape(scene, Rectangle{{-scale, -scale, -scale}, {2 * scale, 0, 0}, {0, 2 * scale, 0}}, 0);
  addEmitter(scene, DirectionalEmitter{.direction = {0.6, 0, -0.8}, .irradiance = {1, 1, 1}});
  setCamera(scene, {0, 0, 0}, 50, kMappedWidth, kMappedHeight);
  return render(scene, mappedSettings(Method::pt), 4);
}

TEST(MappedAgreement, bumpsAreThoseOfEveryScale) {
  const RgbImage expected = bumpyWall(1);
  const auto [least, most] = std::ranges::minmax(expected);
  EXPECT_GT(most - least, 0.02f) << "bumps are seen";
  for (const double scale : {1e10, 1e-7}) {
    const RgbImage image = bumpyWall(scale);
    for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(image[i], expected[i], 1e-4f) << scale << ", value " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, MappedAgreementTest, testing::Range<size_t>(0, 22),
                         [](const auto& instance) { return std::string(mappedCases()[instance.param].name); });

}  // namespace
}  // namespace wavecrest
