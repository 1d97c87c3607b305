// Scenes far from their origin: where a scene lies changes neither its image nor what is said about it, and no path
// meets the wall it has just left, although float at that distance cannot tell the wall from what is behind it.
#include <gtest/gtest.h>

#include <bit>

#include "engine/inspect/inspection.h"
#include "engine/scene/vector_math.h"
#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// Everything that has a place, moved by what float can represent.
Scene moved(Scene scene, const Double3& by) {
  struct Mover {
    const Double3& by;
    void operator()(Mesh& mesh) const {
      for (Float3& p : mesh.positions) {
        for (size_t i = 0; i < 3; ++i) p[i] += static_cast<float>(by[i]);
      }
    }
    void operator()(Rectangle& r) const { r.corner = r.corner + by; }
    void operator()(Disk& disk) const { disk.center = disk.center + by; }
    void operator()(Sphere& sphere) const { sphere.center = sphere.center + by; }
    void operator()(Cylinder& cylinder) const {
      cylinder.p0 = cylinder.p0 + by;
      cylinder.p1 = cylinder.p1 + by;
    }
    void operator()(PointEmitter& point) const { point.position = point.position + by; }
    void operator()(SpotEmitter& spot) const { spot.position = spot.position + by; }
    void operator()(ProjectorEmitter& projector) const {
      for (size_t i = 0; i < 3; ++i) projector.toWorld[i][3] += by[i];
    }
    void operator()(AreaEmitter&) const {}
    void operator()(DirectionalEmitter&) const {}
    void operator()(ConstantEmitter&) const {}
    void operator()(EnvmapEmitter&) const {}
    void operator()(SunskyEmitter&) const {}
  };
  for (Shape& shape : scene.shapes) std::visit(Mover{by}, shape.kind);
  for (Emitter& emitter : scene.emitters) std::visit(Mover{by}, emitter.kind);
  for (size_t i = 0; i < 3; ++i) scene.sensor.toWorld[i][3] += by[i];
  return scene;
}

void addEmitter(Scene& scene, decltype(Emitter::kind) kind) { scene.emitters.emplace_back().kind = std::move(kind); }

// A square wall through `center`, whose normal is along u x v.
Rectangle wall(const Double3& center, const Double3& u, const Double3& v) {
  return {.corner = center - u - v, .edgeU = u * 2, .edgeV = v * 2};
}

// Each kind of shape, light and sensor that has a place, in a room around the origin without a front wall. Coordinates
// are multiples of 1/64.
Scene crowdedRoom(Sensor::Kind sensor) {
  Scene scene;
  const uint32_t grey = addDiffuse(scene, 0.7, 0.6, 0.5);
  addShape(scene, wall({0, -1, 0}, {0, 0, 1}, {1, 0, 0}), grey);
  addShape(scene, wall({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), grey);
  addShape(scene, wall({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), grey);
  addShape(scene, wall({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}), grey);
  addShape(scene, wall({1, 0, 0}, {0, 0, 1}, {0, 1, 0}), grey);
  addShape(scene, wall({0, 0.984375, 0}, {0.25, 0, 0}, {0, 0, 0.25}), grey);
  makeLight(scene, {4, 4, 4});
  constexpr Matrix4 kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  addShape(scene, Sphere{.center = {0.5, -0.75, 0}, .radius = 0.25, .toWorld = kIdentity}, grey);
  addShape(scene, Sphere{.center = {-0.5, 0.25, -0.5}, .radius = 0.25, .toWorld = kIdentity}, grey);
  makeLight(scene, {1, 2, 1});
  addShape(scene, Disk{.center = {0.5, 0.25, -0.75}, .axisU = {0.25, 0, 0}, .axisV = {0, 0.25, 0}}, grey);
  addShape(scene, Cylinder{.p0 = {-0.5, -1, 0.25}, .p1 = {-0.5, -0.5, 0.25}, .radius = 0.25, .phi90 = {0, 0, 1}}, grey);
  Mesh tent;
  tent.positions = {{-0.25f, -1, -0.5f}, {0.25f, -1, -0.5f}, {0, -0.5f, -0.75f}, {0, -1, -0.25f}};
  tent.triangles = {{0, 1, 2}, {0, 3, 2}, {3, 1, 2}};
  addShape(scene, tent, grey);
  addEmitter(scene, PointEmitter{{0.75, 0.5, 0.5}, {0.5, 0.25, 0.25}});
  addEmitter(scene, SpotEmitter{.position = {-0.75, 0.75, 0.5}, .direction = {0, -1, 0}, .intensity = {1, 1, 2}});
  setCamera(scene, {0.015625, 0, sensor == Sensor::Kind::orthographic ? 1.5 : 2.75}, 60, 24, 18);
  scene.sensor.kind = sensor;
  return scene;
}

struct Far {
  Method method;
  Sensor::Kind sensor;
  Precision precision;
  Accel accel;
};

class FarSceneTest : public testing::TestWithParam<Far> {
 protected:
  RenderSettings settings() const {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.method = GetParam().method;
    settings.precision = GetParam().precision;
    settings.accel = GetParam().accel;
    settings.radius = 0.05;  // so that merging finds photons
    settings.seed = 3;
    return settings;
  }
};

TEST_P(FarSceneTest, hasTheImageOfTheSameSceneAtTheOrigin) {
  const Scene scene = crowdedRoom(GetParam().sensor);
  const RgbImage near = render(scene, settings(), 2);
  double sum = 0;
  for (const float value : near) sum += static_cast<double>(value);
  ASSERT_GT(sum, 0);
  const RgbImage far = render(moved(scene, {0x1p14, -0x1.8p13, 0x1p12}), settings(), 2);
  size_t different = 0;
  for (size_t i = 0; i < near.size(); ++i)
    different += std::bit_cast<uint32_t>(near[i]) != std::bit_cast<uint32_t>(far[i]) ? 1 : 0;
  EXPECT_EQ(different, 0u) << "of " << near.size();
}

constexpr auto kPinhole = Sensor::Kind::perspective;
constexpr Far kFar[] = {{Method::pt, kPinhole, Precision::floating, Accel::small},
                        {Method::pt, kPinhole, Precision::doubled, Accel::small},
                        {Method::pt, kPinhole, Precision::floating, Accel::embree},
                        {Method::pt, Sensor::Kind::orthographic, Precision::doubled, Accel::embree},
                        {Method::vcm, kPinhole, Precision::floating, Accel::small},
                        {Method::vcm, kPinhole, Precision::doubled, Accel::embree}};
INSTANTIATE_TEST_SUITE_P(Engine, FarSceneTest, testing::ValuesIn(kFar), [](const auto& instance) {
  const Far& far = instance.param;
  return std::string(toString(far.method)) + (far.sensor == kPinhole ? "_perspective_" : "_orthographic_") +
         std::string(kPrecisionNames[static_cast<size_t>(far.precision)]) + "_" +
         std::string(kAccelNames[static_cast<size_t>(far.accel)]);
});

TEST(FarScene, isReportedWhereItIs) {
  const Double3 by{0x1p14, 0, -0x1p12};
  RenderSettings settings;
  settings.isa = bestIsa();
  const BoundingSphere near = inspectScene(crowdedRoom(kPinhole), settings).bounds;
  const BoundingSphere far = inspectScene(moved(crowdedRoom(kPinhole), by), settings).bounds;
  EXPECT_EQ(far.radius, near.radius);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(far.center[i], near.center[i] + by[i]);
    EXPECT_EQ(far.low[i], near.low[i] + by[i]);
    EXPECT_EQ(far.high[i], near.high[i] + by[i]);
  }
}

// Axes along which a scene is near keep the coordinates it was written in.
TEST(FarScene, isMovedOnlyAlongAxesOnWhichItIsFar) {
  const auto originAt = [](const Double3& by) {
    return compileScene<float>(moved(crowdedRoom(kPinhole), by), Accel::small)->origin;
  };
  RenderSettings settings;
  settings.isa = bestIsa();
  const double radius = inspectScene(crowdedRoom(kPinhole), settings).bounds.radius;
  EXPECT_EQ(originAt({std::floor(8 * radius), 0, 0}), (Double3{0, 0, 0}));
  EXPECT_EQ(originAt({std::ceil(8 * radius), 0, -1024}), (Double3{std::ceil(8 * radius), 0, -1024}));
}

// Vertices of copies are rounded to float relative to the kernels' origin, where they are close to it.
TEST(FarScene, copiesHaveTheirSize) {
  for (const Double3& at : {Double3{5'400'000, 0, 0}, Double3{5'400'000, -7'000'000, 6'000'000}}) {
    Scene scene;
    scene.groups.push_back({.id = "cube", .source = {}});
    Mesh cube;
    for (uint32_t i = 0; i < 8; ++i) {
      cube.positions.push_back({(i & 1) != 0 ? 0.1f : -0.1f, (i & 2) != 0 ? 0.1f : -0.1f, (i & 4) != 0 ? 0.1f : -0.1f});
    }
    cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    addShape(scene, cube, addDiffuse(scene, 0.5, 0.5, 0.5)).group = 0;
    scene.instances.push_back({.id = {},
                               .group = 0,
                               .toWorld = {{{1, 0, 0, at[0]}, {0, 1, 0, at[1]}, {0, 0, 1, at[2]}, {0, 0, 0, 1}}},
                               .source = {}});
    setCamera(scene, at + Double3{0, 0, 1}, 60, 8, 8);
    for (const Instancing instancing : {Instancing::kept, Instancing::expanded}) {
      const auto compiled = compileScene<float>(scene, Accel::bvh, true, instancing);
      EXPECT_EQ(compiled->origin, at);
      for (size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(compiled->bounds.low[axis], -0.1, 1e-6) << kInstancingNames[static_cast<size_t>(instancing)];
        EXPECT_NEAR(compiled->bounds.high[axis], 0.1, 1e-6) << kInstancingNames[static_cast<size_t>(instancing)];
      }
    }
  }
}

// ---- walls that paths have just left --------------------------------------------------------------------------------

struct Placement {
  const char* name;
  double scale, distance;  // half an edge, and from the origin to the centre in units of it
};

// Cubes of six rectangles, whose corners are exact, and of twelve triangles, whose vertices are rounded to float where
// they are: a wall is then two triangles which may see each other, unless rounding has left them a parallelogram.
class FarCubeTest : public testing::TestWithParam<std::tuple<Placement, Accel>> {
 protected:
  double scale() const { return std::get<0>(GetParam()).scale; }
  Double3 center() const { return Double3{0.6, -0.5, 0.62} * (scale() * std::get<0>(GetParam()).distance); }

  Scene cube(bool triangles) const {
    // An orthonormal frame along no axis of the scene.
    const Double3 x = normalized({0.7, 0.3, -0.6}), y = normalized(cross(x, {0.2, 1, 0.1})), z = cross(x, y);
    Scene scene;
    const uint32_t white = addDiffuse(scene, 1, 1, 1);
    for (const std::array<Double3, 3>& axes : {std::array{x, y, z}, std::array{y, z, x}, std::array{z, x, y}}) {
      for (const double side : {-1.0, 1.0}) {  // normals inward
        const Rectangle face =
            wall(center() + axes[0] * (side * scale()), axes[1] * (-side * scale()), axes[2] * scale());
        if (!triangles) {
          addShape(scene, face, white);
          continue;
        }
        Mesh mesh;
        for (const auto& [u, v] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
          const Double3 p = face.corner + face.edgeU * u + face.edgeV * v;
          mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
        }
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        addShape(scene, mesh, white);
      }
    }
    setCamera(scene, center(), 100, 32, 32);
    return scene;
  }

  template <class S>
  void bounce(bool triangles) {
    constexpr Precision kPrecision = sizeof(S) == sizeof(double) ? Precision::doubled : Precision::floating;
    constexpr size_t kPaths = 1024;
    const auto compiled = compileScene<S>(cube(triangles), std::get<1>(GetParam()));
    if (!triangles) {
      ASSERT_EQ(compiled->primitives.records.size(), 6u);
    }
    const auto& stages = findStages<S>(bestIsa(), kPrecision, chooseSpecialization(0, kPrecision));
    const Stage<S> extend = compiled->small != nullptr ? stages.extendSmall : extendEmbree<S>;
    const FilmArea area = FilmArea::make(0, 0, 32, 32);
    StageCounters counters;
    StageContext<S> context;
    context.scene = &compiled->view;
    context.pixels = area.pixels.data();
    context.limits = {.maxDepth = 1000, .rouletteDepth = 1000};
    context.counters = &counters;
    Wave<S> wave{kPaths, {.shadingNormals = true, .textures = true, .rouletteScale = true, .connections = true}};
    wave.pathCount = kPaths;
    for (uint32_t iteration = 0; iteration < effort(8, 1); ++iteration) {
      context.sampler.iteration = iteration;
      context.depth = 0;
      stages.generateCameraPaths(context, wave);
      std::vector<uint32_t> previous(kPaths, kMiss);
      for (context.depth = 1; context.depth <= 24; ++context.depth) {
        extend(context, wave);
        for (size_t i = 0; i < wave.rays.size; ++i) {
          const uint32_t now = wave.hits.primitive[i];
          uint32_t& before = previous[wave.paths.lane[i]];
          ASSERT_NE(now, kMiss) << "depth " << context.depth << " item " << i;
          ASSERT_NE(now, before) << "depth " << context.depth << " item " << i;
          before = now;
        }
        stages.arrive(context, wave);
        stages.scatter(context, wave);
      }
      ASSERT_EQ(wave.rays.size, kPaths) << "paths were lost";
    }
  }
};

TEST_P(FarCubeTest, ofRectanglesKeepsItsPaths) { bounce<float>(false); }
TEST_P(FarCubeTest, ofTrianglesKeepsItsPaths) { bounce<float>(true); }
TEST_P(FarCubeTest, ofRectanglesKeepsItsPathsInDouble) { bounce<double>(false); }
TEST_P(FarCubeTest, ofTrianglesKeepsItsPathsInDouble) { bounce<double>(true); }

constexpr Placement kPlacements[] = {{"far", 1, 100}, {"farther", 1, 1e4}, {"tinyAndFar", 1e-4, 1e3}};
INSTANTIATE_TEST_SUITE_P(Engine, FarCubeTest,
                         testing::Combine(testing::ValuesIn(kPlacements), testing::Values(Accel::small, Accel::embree)),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param).name) + "_" +
                                  std::string(kAccelNames[static_cast<size_t>(std::get<1>(instance.param))]);
                         });

}  // namespace
}  // namespace wavecrest
