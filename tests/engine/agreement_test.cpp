// Methods against each other: the same picture but for noise, with each kind of light, material and camera.
//
// pt is the reference wherever it can make all paths of a scene (METHODS 8.1). Images of 16 seeds per method are
// compared tile by tile and as a whole (render_statistics.h). Merging is biased by its radius: where it is part of a
// method the radius is small; where it is all of a method, a few per cent of the image's mean are allowed.
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 32, kHeight = 24;

RenderSettings settingsOf(Method method) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.method = method;
  settings.waveSize = 256;
  settings.radius = 0.01;
  return settings;
}

uint64_t iterations() { return samples(32, 4); }

// Independent of the reference, which begins at another seed.
SeedMeans imagesBy(const Scene& scene, Method method, uint64_t count = iterations()) {
  return renderSeeds(scene, settingsOf(method), count, 5000 + 100 * static_cast<uint64_t>(method));
}
SeedMeans referenceOf(const Scene& scene, uint64_t count = 2 * iterations()) {
  return renderSeeds(scene, settingsOf(Method::pt), count);
}

void expectAgreement(const Scene& scene, std::initializer_list<Method> methods, const std::string& where = "") {
  const SeedMeans reference = referenceOf(scene);
  for (const Method method : methods) {
    expectSameTruth(reference, imagesBy(scene, method), std::string(toString(method)) + where);
  }
  expectSameTruth(reference, imagesBy(scene, Method::gpt), "gpt" + where);
}

// Means of whole images; allowed: relative difference that is no failure.
void expectSameMean(const SeedMeans& a, const SeedMeans& b, double allowed, const std::string& where) {
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> { return a.images[s][i] - b.images[s][i]; };
  double mean = 0;
  for (const double value : a.mean) mean += value / static_cast<double>(a.mean.size());
  const TileStatistics statistics = tileStatistics(a.width, a.mean.size(), difference, allowed * mean);
  EXPECT_LE(statistics.imageT, 4) << where << ": " << statistics.describe();
}

// ---- lights and materials -------------------------------------------------------------------------------------------

class LightAgreementTest : public testing::TestWithParam<RoomLight> {};

TEST_P(LightAgreementTest, onRoughSurfacesWithLeaningNormals) {
  expectAgreement(roomScene({.light = GetParam(),
                             .materials = RoomMaterials::rough,
                             .tiltedNormals = true,
                             .width = kWidth,
                             .height = kHeight}),
                  {Method::lt, Method::bpt, Method::vcm});
}

INSTANTIATE_TEST_SUITE_P(Engine, LightAgreementTest,
                         testing::Values(RoomLight::quad, RoomLight::mesh, RoomLight::sphere, RoomLight::shell,
                                         RoomLight::point, RoomLight::spot, RoomLight::directional, RoomLight::constant,
                                         RoomLight::envmap, RoomLight::slide, RoomLight::projector),
                         [](const auto& instance) {
                           return std::string(kRoomLightNames[static_cast<size_t>(instance.param)]);
                         });

// Mirror, glass and plastic: paths whose events are partly specular, seen directly and by way of each other.
TEST(Agreement, onSpecularSurfacesUnderTheSky) {
  expectAgreement(roomScene({.light = RoomLight::constant,
                             .materials = RoomMaterials::mixed,
                             .tiltedNormals = true,
                             .width = kWidth,
                             .height = kHeight}),
                  {Method::lt, Method::bpt, Method::vcm});
}
TEST(Agreement, onSpecularSurfacesInAShiningShell) {
  expectAgreement(
      roomScene({.light = RoomLight::shell, .materials = RoomMaterials::mixed, .width = kWidth, .height = kHeight}),
      {Method::lt, Method::bpt, Method::vcm});
}

Scene bumpyRoom(double scale) {
  Scene scene =
      roomScene({.light = RoomLight::quad, .materials = RoomMaterials::rough, .width = kWidth, .height = kHeight});
  const uint32_t waves = addWaves(scene);
  for (Material& material : scene.materials) {
    material.bumpTexture = waves;
    material.bumpScale = scale;
    if (auto* diffuse = std::get_if<Diffuse>(&material.kind); diffuse != nullptr && diffuse->reflectance.value[0] > 0) {
      diffuse->reflectance.texture = waves;
    }
  }
  return scene;
}

TEST(Agreement, onBumpsAndTextures) { expectAgreement(bumpyRoom(0.05), {Method::lt, Method::bpt, Method::vcm}); }

// So steep that eye and light often face different normals.
TEST(Agreement, onSteepBumps) { expectAgreement(bumpyRoom(0.5), {Method::lt, Method::bpt, Method::vcm}); }

// ---- camera and film ------------------------------------------------------------------------------------------------

Scene plainRoom(uint32_t width = kWidth, uint32_t height = kHeight) {
  return roomScene({.light = RoomLight::sphere, .width = width, .height = height});
}

TEST(Agreement, underACrop) {
  Scene scene = plainRoom(64, 48);
  scene.film.cropX = 19;
  scene.film.cropY = 7;
  scene.film.cropWidth = 32;
  scene.film.cropHeight = 24;
  SeedMeans reference = referenceOf(scene);
  reference.width = 32;
  for (const Method method : {Method::lt, Method::bpt, Method::vcm}) {
    expectSameTruth(reference, imagesBy(scene, method), std::string(toString(method)));
  }
}
TEST(Agreement, underAZoom) {
  Scene scene = plainRoom();
  scene.sensor.fovX = 12;
  expectAgreement(scene, {Method::lt, Method::bpt, Method::vcm});
}
TEST(Agreement, onAWideFilm) { expectAgreement(plainRoom(56, 16), {Method::lt, Method::bpt, Method::vcm}); }

TEST(Agreement, throughALens) {
  Scene scene = plainRoom();
  scene.sensor.kind = Sensor::Kind::thinlens;
  scene.sensor.apertureRadius = 0.25;
  scene.sensor.focusDistance = 3.4;
  expectAgreement(scene, {Method::lt, Method::bpt, Method::vcm});
}
// Turned, stretched and within the room: some of it lies behind the plane of the film.
TEST(Agreement, underParallelRays) {
  Scene scene = plainRoom();
  scene.sensor.kind = Sensor::Kind::orthographic;
  scene.sensor.toWorld = {{{-0.96, 0, -0.42, 0.4}, {0, 1.1, 0, -0.1}, {0.28, 0, -1.44, 0.9}, {0, 0, 0, 1}}};
  expectAgreement(scene, {Method::lt, Method::bpt, Method::vcm});
  scene.film.filter = ReconstructionFilter::gaussian;
  expectAgreement(scene, {Method::lt}, ", gaussian");
}
TEST(Agreement, underAFilter) {
  for (const double scale : {0.7, 1.0, 1.9}) {
    Scene scene = plainRoom();
    scene.film.filter = ReconstructionFilter::tent;
    scene.film.filterRadius = scale;
    expectAgreement(scene, {Method::lt}, ", tent " + std::to_string(scale));
    scene.film.filter = ReconstructionFilter::gaussian;
    scene.film.gaussianStddev = scale / 2;
    expectAgreement(scene, {Method::lt}, ", gaussian " + std::to_string(scale / 2));
  }
}

// ---- number of light paths ------------------------------------------------------------------------------------------

TEST(Agreement, withFewerAndMoreLightPathsThanPixels) {
  const Scene scene =
      roomScene({.light = RoomLight::constant, .materials = RoomMaterials::mixed, .width = kWidth, .height = kHeight});
  const SeedMeans reference = referenceOf(scene);
  constexpr uint64_t kPixels = kWidth * kHeight;
  for (const uint64_t lightPaths : {kPixels / 3, 3 * kPixels, kPixels - 1, uint64_t{1}}) {
    RenderSettings settings = settingsOf(Method::vcm);
    settings.lightPaths = lightPaths;
    expectSameTruth(reference, renderSeeds(scene, settings, iterations(), 7000),
                    std::to_string(lightPaths) + " light paths");
  }
}

// ---- merging at first vertices --------------------------------------------------------------------------------------

// Mirrors and glass put delta lobes before some first vertices, and behind others.
TEST(Agreement, ofVcmThatMergesAtFirstVerticesAlone) {
  for (const RoomLight light : {RoomLight::quad, RoomLight::sphere, RoomLight::constant}) {
    const Scene scene = roomScene(
        {.light = light, .materials = RoomMaterials::mixed, .tiltedNormals = true, .width = kWidth, .height = kHeight});
    RenderSettings settings = settingsOf(Method::vcm);
    settings.mergeVertices = MergeVertices::first;
    expectSameTruth(referenceOf(scene), renderSeeds(scene, settings, iterations(), 7100),
                    std::string("first merges, ") + kRoomLightNames[static_cast<size_t>(light)]);
  }
}

// A search at every vertex finds more photons than those at first ones, which are all that ppm makes.
TEST(FirstMerges, areThoseOfPpm) {
  const Scene scene =
      roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = kWidth, .height = kHeight});
  const auto merges = [&](Method method, MergeVertices vertices) {
    RenderSettings settings = settingsOf(method);
    settings.mergeVertices = vertices;
    settings.lightPaths = 3000;
    const auto session = Session::create(scene, settings);
    session->renderUntil(8, std::nullopt);
    return session->statistics().counters.merges;
  };
  const auto first = static_cast<double>(merges(Method::vcm, MergeVertices::first));
  EXPECT_GT(static_cast<double>(merges(Method::vcm, MergeVertices::all)), 1.3 * first);
  // Both have the same light paths. Camera paths of vcm choose between the lobes of a surface that has both kinds.
  EXPECT_NEAR(static_cast<double>(merges(Method::ppm, MergeVertices::all)) / first, 1, 0.2);
}

// ---- merging alone --------------------------------------------------------------------------------------------------

TEST(Agreement, ofPhotonMappingInTheMean) {
  for (const RoomLight light : {RoomLight::quad, RoomLight::point, RoomLight::constant}) {
    const Scene scene =
        roomScene({.light = light, .materials = RoomMaterials::rough, .width = kWidth, .height = kHeight});
    const SeedMeans reference = referenceOf(scene);
    for (const Method method : {Method::ppm, Method::bpm}) {
      // A disc loses what lies beyond the edge of its surface: of the order of radius / size of a wall.
      expectSameMean(reference, imagesBy(scene, method, 3 * iterations()), 0.02,
                     std::string(toString(method)) + ", " + kRoomLightNames[static_cast<size_t>(light)]);
    }
  }
}

// With direct light by next event estimation photons make the rest: no path twice, none not at all. Of paths of up to
// two edges, which merging then has no part in, the image is that of path tracing.
TEST(SlowAgreement, photonMappingWithADirectPass) {
  for (const RoomLight light : {RoomLight::quad, RoomLight::sphere, RoomLight::point, RoomLight::constant}) {
    const std::string where = std::string("ppm, direct pass, ") + kRoomLightNames[static_cast<size_t>(light)];
    const Scene scene =
        roomScene({.light = light, .materials = RoomMaterials::mixed, .width = kWidth, .height = kHeight});
    RenderSettings direct = settingsOf(Method::ppm);
    direct.directPass = true;
    const uint64_t count = 3 * iterations();
    // Mirrors and glass under a point: path tracing lacks caustics, photons alone have them.
    const SeedMeans plain = renderSeeds(scene, settingsOf(Method::ppm), count, 7000);
    expectSameMean(plain, renderSeeds(scene, direct, count, 8000), 0.01, where);
    direct.limits.maxDepth = 2;
    RenderSettings paths = settingsOf(Method::pt);
    paths.limits.maxDepth = 2;
    expectSameTruth(renderSeeds(scene, paths, count), renderSeeds(scene, direct, iterations(), 9000),
                    where + ", 2 edges");
  }
}

// ---- known answers --------------------------------------------------------------------------------------------------

class FurnaceTest : public testing::TestWithParam<Method> {
 protected:
  // Merging loses light near edges; the closed scenes below have some.
  static double allowed() { return GetParam() == Method::ppm || GetParam() == Method::bpm ? 0.03 : 2e-6; }
  static void expectMean(const Scene& scene, double radiance, const std::string& where) {
    const SeedMeans seeds = renderSeeds(scene, settingsOf(GetParam()), iterations());
    const auto difference = [&](size_t s, size_t i) -> std::optional<double> { return seeds.images[s][i] - radiance; };
    const TileStatistics statistics = tileStatistics(seeds.width, seeds.mean.size(), difference, allowed() * radiance);
    EXPECT_LE(statistics.imageT, 7) << where << ": " << statistics.describe();
  }
};

TEST_P(FurnaceTest, closedBox) {
  expectMean(sceneFile("validation/closed-box", 16, 16, {{"albedo", "0.5"}}), 2, "box");
}
TEST_P(FurnaceTest, closedSphere) {
  expectMean(sceneFile("validation/closed-sphere", 16, 16, {{"albedo", "0.5"}}), 2, "sphere");
}
TEST_P(FurnaceTest, glassUnderTheSky) { expectMean(sceneFile("validation/furnace-glass", 16, 16), 1, "glass"); }
TEST_P(FurnaceTest, whiteSphereUnderTheSky) {
  expectMean(sceneFile("validation/furnace-sphere", 16, 16, {{"albedo", "1"}}), 1, "white");
}

INSTANTIATE_TEST_SUITE_P(Engine, FurnaceTest,
                         testing::Values(Method::pt, Method::lt, Method::bpt, Method::ppm, Method::bpm, Method::vcm),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// ---- normals that belong to a direction -----------------------------------------------------------------------------

// Next event estimation does not see through the pane, so path tracing meets the lamp by chance.
TEST(Agreement, throughAPaneWithANormalMap) {
  expectAgreement(sceneFile("validation/tilted-pane", 16, 16), {Method::lt, Method::bpt, Method::vcm}, ", tilted pane");
}

// ---- SmallVCM's boxes -----------------------------------------------------------------------------------------------

// With lights that next event estimation or chance can find, all methods make all paths.
TEST(SlowAgreement, inSmallVcmsBoxesOfExtendedLights) {
  for (const char* name : {"validation/smallvcm-1-ceiling", "validation/smallvcm-3-background"}) {
    expectAgreement(sceneFile(name, 32, 32), {Method::lt, Method::bpt, Method::vcm}, std::string(", ") + name);
  }
}

// The t value of the difference between two methods' mean images.
double meanExcess(const SeedMeans& more, const SeedMeans& less) {
  std::vector<double> differences;
  for (size_t s = 0; s < kSeeds; ++s) {
    double sum = 0;
    for (size_t i = 0; i < more.mean.size(); ++i) sum += more.images[s][i] - less.images[s][i];
    differences.push_back(sum);
  }
  double mean = 0, squares = 0;
  for (const double d : differences) mean += d / kSeeds;
  for (const double d : differences) squares += (d - mean) * (d - mean);
  return mean / std::sqrt(squares / (kSeeds - 1) / kSeeds);
}

double relativeExcess(const SeedMeans& more, const SeedMeans& less) {
  double a = 0, b = 0;
  for (size_t s = 0; s < kSeeds; ++s) {
    a += sumOf(more.images[s]);
    b += sumOf(less.images[s]);
  }
  return a / b - 1;
}
// The standard error of the mean image, relative to it.
double noiseOfMean(const SeedMeans& seeds) {
  double mean = 0, squares = 0;
  for (const RgbImage& image : seeds.images) mean += sumOf(image) / kSeeds;
  for (const RgbImage& image : seeds.images) squares += std::pow(sumOf(image) / mean - 1, 2);
  return std::sqrt(squares / (kSeeds - 1) / kSeeds);
}

// Under the sun or a point each of pt, lt, bpt and vcm makes the paths of the one before and some more: caustics, then
// caustics that two diffuse bounces lead into a mirror, then those that one bounce does.
TEST(SlowAgreement, inSmallVcmsBoxesOfDeltaLights) {
  const std::string kSun = "validation/smallvcm-0-sun";
  for (const std::string& name : {kSun, std::string("validation/smallvcm-2-point")}) {
    const Scene scene = sceneFile(name, 32, 32);
    // Under the sun what vcm adds to bpt has to be seen.
    const uint64_t most = (name == kSun ? 12 : 4) * iterations();
    const SeedMeans pt = referenceOf(scene, 4 * iterations()), lt = imagesBy(scene, Method::lt, 4 * iterations()),
                    bpt = imagesBy(scene, Method::bpt, most), vcm = imagesBy(scene, Method::vcm, most);
    EXPECT_GT(meanExcess(lt, pt), 7) << name;
    // What bpt adds to lt, and under the point vcm to bpt, is little beside the noise: neither less, nor much more.
    EXPECT_GT(meanExcess(bpt, lt), -4) << name;
    EXPECT_LT(relativeExcess(bpt, lt), 0.05) << name;
    EXPECT_GT(meanExcess(vcm, bpt), name == kSun ? 4 : -4) << name;
    EXPECT_LT(relativeExcess(vcm, bpt), 0.1) << name;
    EXPECT_LT(noiseOfMean(bpt), 0.01) << name << ": so that less by a twentieth would be seen";
  }
}

}  // namespace
}  // namespace wavecrest
