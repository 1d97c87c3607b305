// Leaks: no ray that starts inside a closed room may find a way out, through any intersector.
//
// With all samples (tests/effort.h) the slow test sends 10^8 rays through the shell of the Cornell box, the other 10^7;
// edges and corners, where neighbouring walls meet and rounding decides, are also aimed at on purpose.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

size_t randomRayLeaks(const Intersector& intersector, const ClosedBody& body, size_t rays, uint64_t seed = 23) {
  const StageScene<float> scene(body.walls);
  RandomPoints random(seed);
  RayBatch batch;
  size_t leaks = 0;
  for (size_t sent = 0; sent < rays; sent += RayBatch::kCapacity) {
    for (batch.clear(); !batch.full();) {
      batch.push(roundedRay(body.center + random.inCube(body.reach), random.direction()));
    }
    leaks += batch.extend(intersector, scene.view);
  }
  return leaks;
}

// From random points inside towards points of every edge, and towards every corner.
size_t aimedRayLeaks(const Intersector& intersector, const ClosedBody& body, size_t raysPerEdge) {
  const StageScene<float> scene(body.walls);
  RandomPoints random(24);
  RayBatch batch;
  size_t leaks = 0;
  const auto aim = [&](const Point& target) {
    if (batch.full()) {
      leaks += batch.extend(intersector, scene.view);
      batch.clear();
    }
    batch.push(aimedRay(body.center + random.inCube(body.reach), target));
  };
  for (const auto& edge : body.edges) {
    const Point &a = body.corners[edge[0]], &b = body.corners[edge[1]];
    for (size_t i = 0; i < raysPerEdge; ++i) aim(a + (b - a) * random.uniform(0, 1));
  }
  for (const Point& corner : body.corners) {
    for (size_t i = 0; i < raysPerEdge; ++i) aim(corner);
  }
  return leaks + batch.extend(intersector, scene.view);
}

// Along the faces: from just above one towards a point of an edge or diagonal. The error of a plane's equation moves
// the hit of such a ray along the ray, so that two faces that meet at almost 180 degrees can both miss it.
size_t grazingRayLeaks(const Intersector& intersector, const ClosedBody& body, size_t raysPerEdge) {
  const StageScene<float> scene(body.walls);
  RandomPoints random(25);
  RayBatch batch;
  size_t leaks = 0;
  for (const auto& edge : body.edges) {
    const Point &a = body.corners[edge[0]], &b = body.corners[edge[1]];
    for (size_t i = 0; i < raysPerEdge; ++i) {
      if (batch.full()) {
        leaks += batch.extend(intersector, scene.view);
        batch.clear();
      }
      const Point target = a + (b - a) * random.uniform(0.02, 0.98);
      const Point& corner =
          body.corners[static_cast<size_t>(random.uniform(0, static_cast<double>(body.corners.size())))];
      const Point beside = target + (corner - target) * std::exp2(random.uniform(-12, -0.1));
      const double height = body.size * std::exp2(random.uniform(-15, -6));
      batch.push(aimedRay(beside + normalized(body.center - target) * height, target));
    }
  }
  return leaks + batch.extend(intersector, scene.view);
}

class LeakTest : public testing::TestWithParam<Intersector> {};
class SlowLeakTest : public testing::TestWithParam<Intersector> {};

TEST_P(LeakTest, noRayLeavesTheCornellShell) {
  EXPECT_EQ(randomRayLeaks(GetParam(), cornellShell(), samples(10'000'000, 200'000)), 0u);
}

// Other rays than those of LeakTest.
TEST_P(SlowLeakTest, noRayLeavesTheCornellShell) {
  EXPECT_EQ(randomRayLeaks(GetParam(), cornellShell(), samples(100'000'000, 1'000'000), 26), 0u);
}

TEST_P(LeakTest, noRayAimedAtAnEdgeOrCornerGetsThrough) {
  const size_t rays = effort(20'000, 1'000);
  EXPECT_EQ(aimedRayLeaks(GetParam(), cornellShell(), rays), 0u);
  EXPECT_EQ(aimedRayLeaks(GetParam(), turnedCube(1, {0, 0, 0}, false), rays), 0u);
  EXPECT_EQ(aimedRayLeaks(GetParam(), turnedCube(1, {0, 0, 0}, true), rays), 0u);
}

TEST_P(LeakTest, noRayThatGrazesTheWallsSlipsBetweenThem) {
  EXPECT_EQ(grazingRayLeaks(GetParam(), cornellShell(), effort(200'000, 10'000)), 0u);
}

TEST_P(LeakTest, roomsOfEverySizeAreTight) {
  const size_t rays = effort(200'000, 10'000);
  for (const double scale : {1e-4, 1.0, 1e4, 1e6}) {
    for (const bool triangles : {false, true}) {
      const ClosedBody cube = turnedCube(scale, {0.1 * scale, -0.2 * scale, 0.3 * scale}, triangles);
      EXPECT_EQ(randomRayLeaks(GetParam(), cube, rays), 0u) << scale;
      EXPECT_EQ(aimedRayLeaks(GetParam(), cube, rays / 100), 0u) << scale;
    }
    EXPECT_EQ(randomRayLeaks(GetParam(), hollowSphere(scale, {0.1 * scale, 0, 0}), rays), 0u) << scale;
  }
}

// Triangles, because corners that are rounded that much form no parallelogram: engine/compile leaves them apart.
TEST_P(LeakTest, roomsFarFromTheOriginAreTight) {
  const size_t rays = effort(200'000, 10'000);
  for (const double distance : {1e2, 1e3, 1e4}) {
    const Point center = Point{0.6, -0.5, 0.62} * distance;
    const ClosedBody cube = turnedCube(1, center, true);
    EXPECT_EQ(randomRayLeaks(GetParam(), cube, rays), 0u) << distance;
    EXPECT_EQ(aimedRayLeaks(GetParam(), cube, rays / 100), 0u) << distance;
    EXPECT_EQ(randomRayLeaks(GetParam(), hollowSphere(1, center), rays), 0u) << distance;
  }
}

const auto kNameOf = [](const auto& instance) { return instance.param.name; };
INSTANTIATE_TEST_SUITE_P(Kernels, LeakTest, testing::ValuesIn(allIntersectors()), kNameOf);
INSTANTIATE_TEST_SUITE_P(Slow, SlowLeakTest, testing::ValuesIn(fastestIntersectors()), kNameOf);

}  // namespace
}  // namespace wavecrest
