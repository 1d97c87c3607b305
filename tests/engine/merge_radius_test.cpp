// --radius auto: the first radius of merges follows from the view, from the photons where camera paths first merge and
// from the number of light paths, and from nothing that differs between renders of one image.
#include "engine/pilot/merge_radius.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/pilot/finished_plan.h"
#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

RenderSettings automatic(Method method = Method::ppm) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.radius.reset();
  return settings;
}

MergeRadius radiusOf(const Scene& scene, const RenderSettings& settings = automatic()) {
  return planWithoutSession(scene, settings).mergeRadius.value();
}

// A floor of side 8 seen from above, so that each pixel covers a square of it. scale: of everything.
constexpr double kRadiusHeight = 5, kFov = 20;
constexpr uint32_t kRadiusWidth = 64;
Scene floorFromAbove(double scale = 1, uint32_t width = kRadiusWidth) {
  Scene scene;
  Mesh floor;
  const auto half = static_cast<float>(4 * scale);
  floor.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  addShape(scene, floor, addDiffuse(scene, 0.5, 0.5, 0.5));
  Emitter point;
  point.kind = PointEmitter{.position = {0, 0, 1.5 * scale}, .intensity = {1, 1, 1}};
  scene.emitters.push_back(point);
  setCamera(scene, {0, 0, kRadiusHeight * scale}, kFov, width, width);
  return scene;
}
double pixelOfFloor(double distance = kRadiusHeight, uint32_t width = kRadiusWidth) {
  return 2 * distance * std::tan(kFov / 2 * std::numbers::pi / 180) / width;
}

// Rays to the corners of the film are longer and slant by up to 14 degrees: less than 5 % in the median.
constexpr double kSlant = 0.05;

TEST(AutoRadius, isAMultipleOfThePixel) {
  const MergeRadius radius = radiusOf(floorFromAbove());
  EXPECT_NEAR(radius.pixel / pixelOfFloor(), 1, kSlant);
  EXPECT_GT(radius.inPixels(), 0.5);
  EXPECT_LT(radius.inPixels(), 8) << "or the other tests see the limit alone";
}

// Eight steps of the positions' lattice and more, also where it is coarser than the scene's size says.
TEST(MergeRadius, isAtLeastWhatPositionsFarFromTheOriginResolve) {
  Scene scene;
  addShape(scene, Rectangle{{7, 7, 0}, {2, 0, 0}, {0, 2, 0}}, addDiffuse(scene, 0.5, 0.5, 0.5));
  Emitter point;
  point.kind = PointEmitter{.position = {8, 8, 1}, .intensity = {1, 1, 1}};
  scene.emitters.push_back(point);
  setCamera(scene, {8, 8, 3}, kFov, kRadiusWidth, kRadiusWidth);
  RenderSettings settings = automatic();
  settings.radius = 1e-6;
  EXPECT_GE(radiusOf(scene, settings).at(0), 8 * 0x1p-20);
  settings.radius = 0.01;
  EXPECT_NEAR(radiusOf(scene, settings).at(0), 0.01 * std::numbers::sqrt2, 1e-5);
}

// METHODS 6.5: one and eight light paths a pixel.
TEST(AutoRadius, isThatOfEquallyManyLightPaths) {
  for (const double alpha : {0.0, 0.75, 1.0}) {
    RenderSettings settings = automatic();
    settings.radiusAlpha = alpha;
    settings.lightPaths = 64 * 64;
    const MergeRadius few = radiusOf(floorFromAbove(), settings);
    settings.lightPaths = 8 * 64 * 64;
    const MergeRadius many = radiusOf(floorFromAbove(), settings);
    EXPECT_NEAR(few.at(7) / many.at(0), 1, 0.01) << "but for the rounding to three digits";
    EXPECT_NEAR(many.photonsPerArea / few.photonsPerArea, 8, 1e-6);
  }
}

// bpm searches photons at every vertex, which dominates its cost.
TEST(AutoRadius, ofBpmIsSmallerWhereAnIterationHasManyLightPaths) {
  RenderSettings settings = automatic(Method::bpm);
  settings.lightPaths = 64 * 64;
  const MergeRadius few = radiusOf(floorFromAbove(), settings);
  settings.lightPaths = 16 * 64 * 64;
  const MergeRadius many = radiusOf(floorFromAbove(), settings);
  EXPECT_NEAR(few.at(15) / many.at(0), 2, 0.02);
}

// METHODS 6.5: photons from all sides of a cosine-power lobe, (n + 1) / 2 pi cos^n a, seen along its axis, have
// (n + 1)^2 / 4 n times the variance of those on a diffuse surface. Only ppm takes all of the lobe from photons.
TEST(AutoRadius, ofPpmIsLargerOnGlossySurfaces) {
  constexpr double kExponent = 100;
  Scene glossy = floorFromAbove();
  glossy.materials[0].kind = Phong{.diffuseReflectance = {{0, 0, 0}}, .exponent = kExponent};
  const double more = std::pow((kExponent + 1) * (kExponent + 1) / (4 * kExponent), 1.0 / 6);
  for (const Method method : {Method::ppm, Method::bpm}) {
    const double ratio =
        radiusOf(glossy, automatic(method)).first / radiusOf(floorFromAbove(), automatic(method)).first;
    EXPECT_NEAR(ratio / (method == Method::ppm ? more : 1), 1, 0.05) << toString(method);
  }
  RenderSettings first = automatic(Method::vcm);
  first.mergeVertices = MergeVertices::first;
  EXPECT_NEAR(radiusOf(glossy, first).first / radiusOf(floorFromAbove(), first).first, 1, 0.05);
}

// A smooth coat makes no noise of photons: its delta lobe is followed.
TEST(AutoRadius, ofPpmIsThatOfTheDiffuseLobeUnderADeltaLobe) {
  Scene coated = floorFromAbove();
  coated.materials[0].kind = Plastic{};
  EXPECT_NEAR(radiusOf(coated).first / radiusOf(floorFromAbove()).first, 1, 0.05);
}

TEST(AutoRadius, scalesWithTheScene) {
  const MergeRadius one = radiusOf(floorFromAbove(1)), large = radiusOf(floorFromAbove(1024));
  EXPECT_NEAR(large.at(0) / one.at(0), 1024, 1024 * 1e-4);
  EXPECT_NEAR(large.first / one.first, 1, 1e-4);
}

// Four times the light paths, one for each pixel, and the place alike.
TEST(AutoRadius, isThatOfEquallyManyLightPathsOnAnyFilm) {
  const MergeRadius small = radiusOf(floorFromAbove()), large = radiusOf(floorFromAbove(1, 2 * kRadiusWidth));
  EXPECT_NEAR(small.at(3) / large.at(0), 1, 0.03);
}

// Rays begin at the near clip, and distances at the lens.
TEST(AutoRadius, doesNotDependOnTheNearClip) {
  Scene clipped = floorFromAbove();
  clipped.sensor.nearClip = 0.9 * kRadiusHeight;
  EXPECT_NEAR(radiusOf(clipped).pixel / radiusOf(floorFromAbove()).pixel, 1, 1e-3);
}

// Paths of one pixel are different ones.
TEST(MergePlaces, ofSmallFilmsAreAsManyAsOfLargeOnes) {
  RenderSettings settings = automatic();
  settings.radius = 0.01;
  const Scene scene = sceneFile("cornell-diffuse", 1, 1);
  const std::vector<MergePlace> places = findMergePlaces<float>(planRender<float>(scene, settings), settings);
  std::set<std::array<float, 3>> positions;
  for (const MergePlace& place : places) positions.insert(place.position);
  EXPECT_GT(positions.size(), 900U) << "of 1024";
}

TEST(AutoRadius, isAtLeastHalfAPixel) { EXPECT_NEAR(radiusOf(floorFromAbove(1, 4)).inPixels(), 0.5, 0.01); }

// What a camera does not see changes the scene's sphere, and no radius in units of the scene. So it makes no difference
// whether the sphere contains the camera.
TEST(AutoRadius, doesNotDependOnWhatIsOutOfView) {
  const MergeRadius alone = radiusOf(floorFromAbove());
  Scene scene = floorFromAbove();
  addShape(
      scene,
      Sphere{.center = {0, 0, 60}, .radius = 1, .toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}},
      0);
  const MergeRadius within = radiusOf(scene);
  EXPECT_GT(within.scene, 4 * alone.scene);
  EXPECT_NEAR(within.at(0) / alone.at(0), 1, 0.01) << "but for the rounding to three digits";
  EXPECT_LT(within.first, alone.first / 4);
}

TEST(AutoRadius, isThatOfTheWholeFilmUnderACrop) {
  Scene scene = sceneFile("cornell-diffuse", 64, 48);
  const MergeRadius whole = radiusOf(scene);
  scene.film.cropX = 40;
  scene.film.cropY = 8;
  scene.film.cropWidth = 16;
  scene.film.cropHeight = 12;
  EXPECT_EQ(radiusOf(scene).first, whole.first);
}

// The image of the floor in a mirror above the camera: as large as pixels on all of the way.
TEST(AutoRadius, followsMirrorsToTheFirstVertexThatMerges) {
  Scene scene = floorFromAbove();
  Material mirror;
  mirror.kind = Conductor{.perfectMirror = true};
  scene.materials.push_back(mirror);
  Mesh ceiling;
  ceiling.positions = {{-4, -4, 7}, {4, -4, 7}, {4, 4, 7}, {-4, 4, 7}};
  ceiling.triangles = {{0, 2, 1}, {0, 3, 2}};
  addShape(scene, ceiling, static_cast<uint32_t>(scene.materials.size() - 1));
  scene.sensor.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, kRadiusHeight}, {0, 0, 0, 1}}};
  EXPECT_NEAR(radiusOf(scene).pixel / pixelOfFloor(2 + 7), 1, kSlant);
}

TEST(AutoRadius, isTheFixedOneWhereNothingCanMerge) {
  Scene scene = floorFromAbove();
  scene.sensor.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, kRadiusHeight}, {0, 0, 0, 1}}};  // up, past the floor
  const MergeRadius radius = radiusOf(scene);
  EXPECT_EQ(radius.first, kFixedRadius);
  EXPECT_EQ(radius.inPixels(), 0);
}

TEST(AutoRadius, isTheSameForAllSeedsThreadsAndWaves) {
  const Scene scene = sceneFile("cornell-spheres", 40, 30);
  const double first = radiusOf(scene).first;
  for (const uint64_t seed : {1u, 77u}) {
    for (const uint32_t threads : {1u, 3u}) {
      RenderSettings settings = automatic();
      settings.seed = seed;
      settings.threads = threads;
      settings.waveSize = threads == 1 ? 64 : 1000;
      EXPECT_EQ(radiusOf(scene, settings).first, first) << seed << ", " << threads;
    }
  }
}

TEST(AutoRadius, leavesAFixedOneAlone) {
  RenderSettings settings = automatic();
  settings.radius = 0.0123;
  const MergeRadius radius = radiusOf(sceneFile("cornell-diffuse", 40, 30), settings);
  EXPECT_EQ(radius.first, 0.0123);
  EXPECT_GT(radius.photonsPerSearch(), 0) << "is told of fixed ones as well";
}

// Its weights take photons that share a camera path for independent ones.
TEST(AutoRadius, ofVcmThatMergesEverywhereIsNeverMoreThanTheFixedOne) {
  EXPECT_EQ(radiusOf(sceneFile("cornell-diffuse", 40, 30), automatic(Method::vcm)).first, kFixedRadius);
  RenderSettings shrinking = automatic(Method::vcm);
  shrinking.radiusAlpha = 0;
  EXPECT_LT(radiusOf(sceneFile("cornell-diffuse", 4000, 3000), shrinking).first, kFixedRadius);
}
// Connections do most where photons are many: a search of vcm has the same number of them wherever no limit is reached.
TEST(AutoRadius, ofVcmThatMergesAtFirstVerticesHasFivePhotonsInASearch) {
  std::vector<std::string> names{"cornell-diffuse"};
  if (kFullSpeed) names.emplace_back("lafortune-room");
  for (const std::string& name : names) {
    const Scene scene = sceneFile(name, 256, 192);
    RenderSettings first = automatic(Method::vcm);
    first.mergeVertices = MergeVertices::first;
    EXPECT_NEAR(radiusOf(scene, first).photonsPerSearch(), 5, 0.1) << name;
    EXPECT_GT(radiusOf(scene, automatic(Method::ppm)).photonsPerSearch(), 6) << name;
  }
}

// Where photons are few, light through a gap: as the cube root gives too few.
TEST(AutoRadius, hasAtLeastSomePhotonsInASearch) {
  const Scene door = sceneFile("veach-door", 256, 192);
  if (kFullSpeed) {
    EXPECT_GE(radiusOf(door, automatic(Method::ppm)).photonsPerSearch(), 4.9);
  }
  EXPECT_NEAR(radiusOf(door, automatic(Method::bpm)).photonsPerSearch(), 3.5, 0.1);
}

TEST(PhotonDensity, isThatOfEvenPhotons) {
  // 64 x 64 positions on a unit square, each for three photons; places in its middle.
  std::vector<std::array<float, 3>> positions;
  positions.reserve(size_t{64} * 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      positions.push_back({(static_cast<float>(x) + 0.5f) / 64, (static_cast<float>(y) + 0.5f) / 64, 0});
    }
  }
  const std::vector<MergePlace> places(5, MergePlace{.position = {0.51f, 0.52f, 0}, .pixel = 1});
  // Positions on a grid: the eighth is off the even density's radius by up to half a step of three.
  EXPECT_NEAR(photonDensity(places, positions, 3).perArea / (3 * 64 * 64), 1, 0.4);
  EXPECT_EQ(photonDensity({}, positions, 3).perArea, 0);
  EXPECT_EQ(photonDensity(places, {}, 3).perArea, 0);
}

// The square of the distance to the eighth nearest of the positions.
float eighthSquare(const std::array<float, 3>& here, const std::vector<std::array<float, 3>>& positions) {
  std::vector<float> squares;
  for (const std::array<float, 3>& there : positions) {
    const float x = there[0] - here[0], y = there[1] - here[1], z = there[2] - here[2];
    const float square = x * x + y * y + z * z;
    if (std::isfinite(square)) squares.push_back(square);
  }
  std::ranges::nth_element(squares, squares.begin() + 7);
  return squares[7];
}

// A search that visits all positions. Some positions are on a wall x = 0.25, some places are outside of all positions.
TEST(PhotonDensity, isThatOfASearchThroughAllPositions) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto point = [&](bool onWall) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    return std::array<float, 3>{onWall ? 0.25f : x, y, z};
  };
  std::vector<std::array<float, 3>> positions;
  for (size_t i = 0; i < 20'000; ++i) positions.push_back(point(i % 4 == 0));
  constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  for (const float bad : kBad) {
    positions.push_back({bad, 0, 0});
    positions.push_back({0, bad, 0});
  }
  std::vector<MergePlace> places;
  for (size_t i = 0; i < 40; ++i) {
    places.push_back({.position = point(i % 4 == 0), .lobes = 1.0 + static_cast<double>(i)});
  }
  for (const float x : {-3.0f, 3.0f}) places.push_back({.position = {x, 0, 0}, .lobes = 7});
  double areas = 0, lobeAreas = 0;
  for (const MergePlace& place : places) {
    const double area = std::numbers::pi * eighthSquare(place.position, positions);
    areas += area;
    lobeAreas += area * place.lobes;
  }
  const PhotonDensity density = photonDensity(places, positions, 3);
  EXPECT_EQ(density.perArea, 8 * 3.0 * static_cast<double>(places.size()) / areas);
  EXPECT_EQ(density.lobes, lobeAreas / areas);
}

TEST(PhotonDensity, isUnknownWithFewerThanEightFinitePositions) {
  std::vector<std::array<float, 3>> positions(7, std::array<float, 3>{});
  positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  const std::vector<MergePlace> places(1, MergePlace{.position = {0, 0, 1}, .pixel = 1});
  EXPECT_EQ(photonDensity(places, positions, 3).lobes, 1);
  positions.back() = {0, 0, 0};
  EXPECT_GT(photonDensity(places, positions, 3).perArea, 0);
}

// ---- renders --------------------------------------------------------------------------------------------------------

TEST(AutoRadius, givesTheImageOfOneThreadOnThree) {
  const Scene scene = sceneFile("cornell-mirror", 40, 30);
  for (const Method method : {Method::ppm, Method::bpm, Method::vcm}) {
    RenderSettings settings = automatic(method);
    settings.waveSize = 256;
    settings.piecesForThreads = 1;  // photons are summed in the order of waves
    const RgbImage one = render(scene, settings, 3);
    settings.threads = 3;
    EXPECT_EQ(render(scene, settings, 3), one) << toString(method);
  }
}

TEST(AutoRadius, goesOnFromASavedState) {
  const Scene scene = sceneFile("cornell-mirror", 40, 30);
  const RenderSettings settings = automatic();
  const auto whole = Session::create(scene, settings), part = Session::create(scene, settings),
             rest = Session::create(scene, settings);
  whole->renderUntil(5, std::nullopt);
  part->renderUntil(2, std::nullopt);
  restoreState(*rest, savedState(*part));
  rest->renderUntil(5, std::nullopt);
  EXPECT_EQ(rest->film().resolve(), whole->film().resolve());
  ASSERT_TRUE(rest->statistics().mergeRadius);
  EXPECT_EQ(rest->statistics().mergeRadius->first, whole->statistics().mergeRadius->first);
}

// Density estimation loses light at edges, in proportion to its radius: with the radius it goes.
TEST(AutoRadius, agreesWithPathTracingAsItShrinks) {
  if (!kFullSpeed) GTEST_SKIP() << "8,000 iterations, for a mean alone";
  const Scene scene = sceneFile("cornell-diffuse", 32, 24);
  RenderSettings settings = automatic();
  settings.radiusAlpha = 0;  // r_i = r_1 / sqrt(i)
  const auto meanOf = [&](Method method, uint64_t first, uint64_t iterations) {
    settings.method = method;
    settings.firstIteration = first;
    double sum = 0;
    for (const float value : render(scene, settings, iterations)) sum += value;
    return sum;
  };
  const double truth = meanOf(Method::pt, 0, 4096);
  // Some 80,000 photons are merged: a standard error of 0.4 %.
  const double late = meanOf(Method::ppm, 400, 4096) / truth - 1;
  EXPECT_LT(std::abs(late), 0.012);
}

}  // namespace
}  // namespace wavecrest
