// No path meets the surface it has just left, at any scale of the scene and far from its origin. Cubes that are so far
// away that float cannot tell their corners apart run as scenes: tests/engine/far_scene_test.cpp.
//
// Paths bounce inside a cube, whose flat walls cannot see themselves, and a hollow sphere, whose chords have a known
// length; and they leave solid cubes and spheres, which cannot be met again.
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

constexpr size_t kRayCount = 1024;

// Where a room is and how large.
struct Placement {
  const char* name;
  double scale, distance;  // of the centre from the origin, in units of the scale
};

template <class S>
struct Fixture {
  Fixture(std::vector<PrimitiveRecord<double>> primitives, const CameraView& camera, const Intersector& chosen)
      : scene(std::move(primitives)),
        stages(findStages<S>(bestIsa(), precision(), chooseSpecialization(kCurvedShapes, precision()))) {
    std::fill_n(scene.materials[0].reflectance, 3, 1.0f);
    scene.materials[0].opacity = 1;
    scene.view.materials = scene.materials.data();
    scene.setCamera(camera);
    if constexpr (sizeof(S) == sizeof(double)) {
      extend = chosen.extendPrecise;
    } else {
      extend = chosen.extend;
    }
    context.scene = &scene.view;
    context.pixels = scene.pixels.data();
    context.limits = {.maxDepth = 1000, .rouletteDepth = 1000};
    context.counters = &counters;
    wave.pathCount = kRayCount;
  }
  static constexpr Precision precision() {
    return sizeof(S) == sizeof(double) ? Precision::doubled : Precision::floating;
  }

  void begin(uint32_t iteration) {
    context.sampler.iteration = iteration;
    context.depth = 0;
    stages.generateCameraPaths(context, wave);
  }

  StageScene<S> scene;
  const Stages<S>& stages;
  Stage<S> extend = nullptr;
  StageCounters counters;
  StageContext<S> context;
  Wave<S> wave{kRayCount, {}};
};

// A camera that looks along z.
CameraView cameraAt(const Point& eye, double spread) {
  return pinholeCamera(eye, Point{-0.5, 0.5, 0.7} * spread, {spread / 32, 0, 0}, {0, -spread / 32, 0}, 32);
}

class SelfIntersectionTest : public testing::TestWithParam<std::tuple<Intersector, Placement>> {
 protected:
  const Intersector& intersector() const { return std::get<0>(GetParam()); }
  double scale() const { return std::get<1>(GetParam()).scale; }
  Point center() const { return Point{0.6, -0.5, 0.62} * (scale() * std::get<1>(GetParam()).distance); }

  CameraView below() const { return cameraAt(center() - Point{0, 0, 3 * scale()}, 0.5); }

  // The cube of bounceInCube() with its normals outward.
  std::vector<PrimitiveRecord<double>> solidCube() const {
    std::vector<PrimitiveRecord<double>> faces = turnedCube(scale(), center(), false).walls;
    for (auto& face : faces) face = quadPrimitive(corner(face, 0, 0), corner(face, 0, 1), corner(face, 1, 0));
    return faces;
  }

  template <class S>
  void bounceInCube(bool triangles) {
    Fixture<S> f(turnedCube(scale(), center(), triangles).walls, cameraAt(center(), 1), intersector());
    const auto wallOf = [&](uint32_t primitive) {  // the two triangles of a wall count as one
      const auto& n = f.scene.precise[primitive].normal;
      return std::array{std::lround(n[0] * 1000), std::lround(n[1] * 1000), std::lround(n[2] * 1000)};
    };
    for (uint32_t iteration = 0; iteration < effort(8, 1); ++iteration) {
      f.begin(iteration);
      std::vector<uint32_t> previous(kRayCount, kMiss);
      for (f.context.depth = 1; f.context.depth <= 24; ++f.context.depth) {
        f.extend(f.context, f.wave);
        for (size_t i = 0; i < f.wave.rays.size; ++i) {
          const uint32_t now = f.wave.hits.primitive[i];
          uint32_t& before = previous[f.wave.paths.lane[i]];
          ASSERT_NE(now, kMiss) << "depth " << f.context.depth << " item " << i;
          if (before != kMiss) {
            ASSERT_NE(wallOf(now), wallOf(before)) << "depth " << f.context.depth << " item " << i;
          }
          before = now;
        }
        f.stages.arrive(f.context, f.wave);
        f.stages.scatter(f.context, f.wave);
      }
      ASSERT_EQ(f.wave.rays.size, kRayCount) << "paths were lost";
      ASSERT_EQ(f.counters.misses, 0u);
    }
  }

  // A chord that leaves a sphere at angle theta to the normal has length 2 R cos(theta).
  template <class S>
  void bounceInSphere() {
    Fixture<S> f(hollowSphere(scale(), center()).walls, cameraAt(center(), 1), intersector());
    const double radius = f.scene.records[0].e1[0];
    // Two ends, each off by the offset and by the rounding of coordinates of the size of the centre's.
    const double error = 64 * 0x1p-24 * (length(center()) + radius);
    f.begin(0);
    for (f.context.depth = 1; f.context.depth <= 24; ++f.context.depth) {
      std::vector<double> chords(kRayCount, -1);
      for (size_t i = 0; f.context.depth > 1 && i < kRayCount; ++i) {
        const Point d{f.wave.rays.directionX[i], f.wave.rays.directionY[i], f.wave.rays.directionZ[i]};
        const Point n{f.wave.surfaces.normalX[i], f.wave.surfaces.normalY[i], f.wave.surfaces.normalZ[i]};
        chords[i] = 2 * radius * dot(d, n);
      }
      f.extend(f.context, f.wave);
      for (size_t i = 0; i < kRayCount; ++i) {
        ASSERT_EQ(f.wave.hits.primitive[i], 0u) << "depth " << f.context.depth << " item " << i;
        const double t = f.wave.hits.u[i];
        // Grazing chords are ill-conditioned: an end off by `error` moves the other by error / cos(theta).
        const double cosine = std::max(chords[i] / (2 * radius), 0x1p-12);
        if (chords[i] > 0) {
          ASSERT_NEAR(t, chords[i], error / cosine) << "depth " << f.context.depth << " item " << i;
        }
      }
      f.stages.arrive(f.context, f.wave);
      f.stages.scatter(f.context, f.wave);
      ASSERT_EQ(f.wave.rays.size, kRayCount);
    }
  }

  // A convex body cannot be met again from outside.
  template <class S>
  void leaveSolidBody(const std::vector<PrimitiveRecord<double>>& body, const CameraView& camera) {
    Fixture<S> f(body, camera, intersector());
    for (uint32_t iteration = 0; iteration < effort(16, 2); ++iteration) {
      f.begin(iteration);
      f.context.depth = 1;
      f.extend(f.context, f.wave);
      f.stages.arrive(f.context, f.wave);
      ASSERT_GT(f.wave.rays.size, kRayCount / 8);
      f.stages.scatter(f.context, f.wave);
      f.context.depth = 2;
      f.extend(f.context, f.wave);
      for (size_t i = 0; i < f.wave.rays.size; ++i) ASSERT_EQ(f.wave.hits.primitive[i], kMiss) << "item " << i;
    }
  }
};

// Its foot lies close to a plane through the origin, where offsets are small, and its other end is far away: a margin
// in proportion to the walls would reach below the foot.
class SelfIntersectionOfTowersTest : public SelfIntersectionTest {};
TEST_P(SelfIntersectionOfTowersTest, outside) {
  const double s = scale(), foot = 0.1 * s, height = 1000 * s;
  std::vector<PrimitiveRecord<double>> faces{quadPrimitive({-s, -s, foot}, {-s, s, foot}, {s, -s, foot}),
                                             quadPrimitive({-s, -s, height}, {s, -s, height}, {-s, s, height})};
  for (const double side : {-s, s}) {
    faces.push_back(quadPrimitive({side, -s, foot}, {side, s, foot}, {side, -s, height}));
    faces.push_back(quadPrimitive({-s, side, foot}, {s, side, foot}, {-s, side, height}));
  }
  leaveSolidBody<float>(faces, cameraAt({0, 0, -3 * s}, 0.5));
}

// Each half of a long quad has two long edges that are almost parallel.
class SelfIntersectionOfStripsTest : public SelfIntersectionTest {};
TEST_P(SelfIntersectionOfStripsTest, fromEitherHalf) {
  const Point along = turned({2, 0, 0}) * scale(), across = turned({0, 0.005, 0}) * scale();
  const Point above = normalized(cross(along, across)) * scale();
  leaveSolidBody<float>({facePrimitive(PrimitiveKind::quad, center() - along * 0.5 - across * 0.5, along, across)},
                        pinholeCamera(center() + above, along * -0.5 - across * 0.5 - above, along * (1.0 / 32),
                                      across * (1.0 / 32), 32));
}

class SelfIntersectionOfQuadsTest : public SelfIntersectionTest {};
class SelfIntersectionOfTrianglesTest : public SelfIntersectionTest {};

TEST_P(SelfIntersectionOfQuadsTest, wallsOfACube) { bounceInCube<float>(false); }
TEST_P(SelfIntersectionOfQuadsTest, outsideOfACube) { leaveSolidBody<float>(solidCube(), below()); }
TEST_P(SelfIntersectionOfQuadsTest, outsideOfACubeOnTheGround) {
  std::vector<PrimitiveRecord<double>> faces = solidCube();
  faces.pop_back();  // five are a box that is open below
  leaveSolidBody<float>(faces, below());
}
TEST_P(SelfIntersectionOfTrianglesTest, wallsOfACube) { bounceInCube<float>(true); }
TEST_P(SelfIntersectionOfTrianglesTest, wallsOfACubeInDouble) { bounceInCube<double>(true); }
TEST_P(SelfIntersectionTest, insideOfASphere) { bounceInSphere<float>(); }
TEST_P(SelfIntersectionTest, insideOfASphereInDouble) { bounceInSphere<double>(); }
TEST_P(SelfIntersectionTest, outsideOfASphere) { leaveSolidBody<float>({spherePrimitive(center(), scale())}, below()); }
TEST_P(SelfIntersectionTest, outsideOfASphereInDouble) {
  leaveSolidBody<double>({spherePrimitive(center(), scale())}, below());
}

// Sorted by distance. Rounded corners of the first four form parallelograms, those of the first five close.
constexpr std::array<Placement, 7> kPlacements{{{"tiny", 1e-4, 0.1},
                                                {"unit", 1, 0.1},
                                                {"large", 1e4, 0.1},
                                                {"huge", 1e6, 0.1},
                                                {"far", 1, 100},
                                                {"tinyAndFar", 1e-4, 1e3},
                                                {"farther", 1, 1e4}}};

auto placements(size_t count) {
  const std::vector<Placement> first(kPlacements.begin(), kPlacements.begin() + count);
  return testing::Combine(testing::ValuesIn(fastestIntersectors()), testing::ValuesIn(first));
}
std::string nameOfPlacement(const testing::TestParamInfo<std::tuple<Intersector, Placement>>& instance) {
  return std::get<0>(instance.param).name + "_" + std::get<1>(instance.param).name;
}

INSTANTIATE_TEST_SUITE_P(Kernels, SelfIntersectionOfQuadsTest, placements(4), nameOfPlacement);
INSTANTIATE_TEST_SUITE_P(Kernels, SelfIntersectionOfStripsTest, placements(4), nameOfPlacement);
INSTANTIATE_TEST_SUITE_P(Kernels, SelfIntersectionOfTrianglesTest, placements(5), nameOfPlacement);
INSTANTIATE_TEST_SUITE_P(Kernels, SelfIntersectionTest, placements(7), nameOfPlacement);
INSTANTIATE_TEST_SUITE_P(Kernels, SelfIntersectionOfTowersTest, placements(7), nameOfPlacement);

}  // namespace
}  // namespace wavecrest
