// Rays in the hierarchy of large scenes: none leaves a closed mesh of many triangles, and a hit depends on nothing but
// the ray.
//
// That its hits are the right ones is tested beside the other intersectors (extend_test, leak_test).
#include "kernels/extend/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

// ---- what a hit depends on ------------------------------------------------------------------------------------------

class BvhRays : public testing::Test {
 protected:
  // The hits of all rays, in their order.
  struct Found {
    uint32_t primitive;
    float u, v;
    bool operator==(const Found& other) const {  // u and v of a miss say nothing
      return primitive == other.primitive && (primitive == kMiss || (u == other.u && v == other.v));
    }
  };
  static std::vector<Found> hits(const Intersector& intersector, const StageScene<float>& scene,
                                 const std::vector<TestRay>& rays) {
    std::vector<Found> list;
    RayBatch batch;
    for (size_t first = 0; first < rays.size(); first += RayBatch::kCapacity) {
      batch.clear();
      for (size_t i = first; i < std::min(rays.size(), first + RayBatch::kCapacity); ++i) batch.push(rays[i]);
      batch.extend(intersector, scene.view);
      for (size_t i = 0; i < batch.wave.hits.size; ++i) {
        list.push_back({batch.wave.hits.primitive[i], batch.wave.hits.u[i], batch.wave.hits.v[i]});
      }
    }
    return list;
  }
  static Intersector named(const std::string& name, Isa isa) {
    for (const Intersector& one : allIntersectors()) {
      if (one.name == name + "_" + std::string(toString(isa))) return one;
    }
    throw std::logic_error("no intersector of that name");
  }
};

class BvhRaysTest : public BvhRays, public testing::WithParamInterface<Isa> {
 protected:
  Intersector named(const std::string& name) const { return BvhRays::named(name, GetParam()); }
  // Half from one point in directions that differ little, as from a camera; half from anywhere; some along the axes.
  static std::vector<TestRay> manyRays(size_t count) {
    RandomPoints random(31);
    std::vector<TestRay> rays;
    while (rays.size() < count) {
      switch (rays.size() / 64 % 3) {
        case 0:
          rays.push_back(aimedRay({0.1, 0.2, -3}, random.inCube(0.05) + Point{0.3, 0, 0}));
          break;
        case 1:
          rays.push_back(aimedRay(random.inCube(2), random.inCube(1)));
          break;
        default:
          rays.push_back({roundedToFloat(random.inCube(1)), {rays.size() % 2 == 0 ? 1.0 : -1.0, 0, 0}});
      }
    }
    return rays;
  }
};
INSTANTIATE_TEST_SUITE_P(Kernels, BvhRaysTest, testing::ValuesIn(availableIsas()),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

TEST_P(BvhRaysTest, packetsFindWhatSingleRaysFind) {
  const StageScene<float> scene(crowd(effort(3000, 600)));
  const auto rays = manyRays(effort(50'003, 3'003));  // no whole packet at the end
  const auto single = hits(named("bvh"), scene, rays), packets = hits(named("packets"), scene, rays);
  size_t found = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    found += single[i].primitive != kMiss ? 1 : 0;
    ASSERT_EQ(single[i], packets[i]) << "ray " << i;
  }
  EXPECT_GT(found, rays.size() / 4);
  EXPECT_LT(found, rays.size());
}

TEST_P(BvhRaysTest, hitsDoNotDependOnTheOtherRays) {
  const StageScene<float> scene(crowd(effort(3000, 600)));
  const auto rays = manyRays(effort(20'000, 2'000));
  std::vector<size_t> order(rays.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  std::vector<TestRay> shuffled;
  shuffled.reserve(rays.size());
  for (const size_t i : order) shuffled.push_back(rays[i]);
  for (const char* name : {"bvh", "packets"}) {
    const auto straight = hits(named(name), scene, rays), mixed = hits(named(name), scene, shuffled);
    for (size_t i = 0; i < order.size(); ++i) ASSERT_EQ(mixed[i], straight[order[i]]) << name << " ray " << order[i];
  }
}

// Many faces in one place cannot be told apart by boxes; the first of them is hit.
TEST_P(BvhRaysTest, ofEqualFacesTheFirstIsHit) {
  std::vector<PrimitiveRecord<double>> list(1000, trianglePrimitive({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}));
  const StageScene<float> scene(list);
  const std::vector<TestRay> rays(40, aimedRay({0.1, 0.1, -2}, {0.01, -0.02, 0}));
  for (const char* name : {"bvh", "packets"}) {
    for (const Found& found : hits(named(name), scene, rays)) ASSERT_EQ(found.primitive, 0u) << name;
  }
}

// Splitting two groups of faces moves those of one leaf out of their order.
TEST_P(BvhRaysTest, ofEqualFacesInALeafTheFirstIsHit) {
  const auto across = [](double x) { return trianglePrimitive({x, -1, -1}, {x, 1, -1}, {x, 0, 1}); };
  const StageScene<float> scene({across(10), across(10), across(-10), across(-10), across(-10)});
  const std::vector<TestRay> rays(40, aimedRay({0, 0, 0}, {10, 0.1, -0.2}));
  for (const char* name : {"bvh", "packets"}) {
    for (const Found& found : hits(named(name), scene, rays)) ASSERT_EQ(found.primitive, 0u) << name;
  }
}

// Of sixteen parallel rays one is no ray, and another alone meets a face, far away from all others.
TEST_P(BvhRaysTest, raysThatAreNoRaysHideNoOtherFromItsPacket) {
  constexpr size_t kRays = 16;
  for (const double far : {-1000.0, 1000.0}) {
    std::vector<PrimitiveRecord<double>> list{trianglePrimitive({far - 9, -9, 10}, {far + 9, -9, 10}, {far, 19, 10})};
    for (size_t i = 0; i < 8; ++i) {
      const double z = -10 - static_cast<double>(i);
      list.push_back(trianglePrimitive({-1, -1, z}, {1, -1, z}, {0, 1, z}));
    }
    std::vector<TestRay> rays;
    std::vector<bool> meets;
    for (size_t broken = 0; broken < kRays; ++broken) {
      for (size_t lonely = 0; lonely < kRays; ++lonely) {
        if (lonely == broken) continue;
        for (size_t i = 0; i < kRays; ++i) {
          const double x = i == broken ? std::numeric_limits<double>::quiet_NaN() : i == lonely ? far : 0;
          rays.push_back(roundedRay({x, 0, 0}, normalized({0.1, 0.2, 1})));
          meets.push_back(i == lonely);
        }
      }
    }
    const StageScene<float> scene(list);
    const auto found = hits(named("packets"), scene, rays);
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(found[i].primitive != kMiss, meets[i]) << far << " ray " << i;
  }
}

TEST_P(BvhRaysTest, raysThatAreNoRaysMissAndHarmNoOther) {
  const StageScene<float> scene(crowd(300));
  auto rays = manyRays(2'000);
  const auto want = hits(named("bvh"), scene, rays);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const TestRay broken[] = {
      {{nan, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {nan, nan, nan}}, {{0, 0, 0}, {0, 0, 0}}, {{infinite, 0, 0}, {-1, 0, 0}}};
  for (size_t i = 0; i < 100; ++i) rays[i * 20] = broken[i % std::size(broken)];
  for (const char* name : {"bvh", "packets"}) {
    const auto got = hits(named(name), scene, rays);
    for (size_t i = 0; i < rays.size(); ++i) {
      if (i % 20 == 0 && i < 2000) {
        ASSERT_EQ(got[i].primitive, kMiss) << name << " ray " << i;
      } else {
        ASSERT_EQ(got[i], want[i]) << name << " ray " << i;
      }
    }
  }
}

// A cube that is smaller than what a corner of the ground welds (corner_weld.h).
TEST_P(BvhRaysTest, smallBodiesAtTheCornerOfALargeQuadAreHit) {
  constexpr double kLow = 2e-4, kHigh = 1.2e-3;
  std::vector<PrimitiveRecord<double>> list{quadPrimitive({0, 0, 0}, {0, 0, 1e4}, {1e4, 0, 0})};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {kLow, kHigh}) {
      Point p{kLow, kLow, kLow}, alongU{}, alongV{};
      p[axis] = side;
      alongU[(axis + 1) % 3] = alongV[(axis + 2) % 3] = kHigh - kLow;
      list.push_back(facePrimitive(PrimitiveKind::quad, p, alongU, alongV));
    }
  }
  const StageScene<float> scene(list);
  RandomPoints random(32);
  std::vector<TestRay> rays;
  const auto beside = [&] { return random.uniform(1.05 * kLow, 0.99 * kHigh); };
  for (size_t i = 0; i < 200; ++i) rays.push_back(roundedRay({beside(), 1, beside()}, {0, -1, 0}));
  for (const char* name : {"bvh", "packets"}) {
    for (const Found& found : hits(named(name), scene, rays)) {
      ASSERT_NE(found.primitive, kMiss) << name;
      ASSERT_NE(found.primitive, 0u) << name;
    }
  }
}

// ---- shadow rays ----------------------------------------------------------------------------------------------------

// Segments to a few lights, most of them behind something: from one place in packets, from anywhere, and along the
// axes; among them some that are no rays. scattered: from anywhere to anywhere, which packets are given up for.
RayBatch shadowRays(size_t count, bool scattered, RandomPoints& random) {
  const Point lights[] = {{2, 0, 0}, {-2, 0.1, 0.2}, {0, 0, 3}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RayBatch batch;
  for (size_t i = 0; i < count; ++i) {
    const bool fromOnePlace = !scattered && i / 64 % 2 == 0;
    const Point end = scattered ? random.inCube(1.5) : lights[i / 32 % 3] + random.inCube(0.02);
    const Point start = fromOnePlace ? Point{0.1, 1.2, 0.3} + random.inCube(0.01) : random.inCube(1.2);
    if (i % 50 == 17) {
      batch.push({roundedToFloat(start), {nan, 1, 0}});
    } else if (i % 50 == 18) {
      batch.push({roundedToFloat(start), {i % 4 < 2 ? 3.0 : -3.0, 0, 0}});
    } else {
      batch.push(roundedRay(start, end - start));
    }
  }
  return batch;
}

// Neither packets nor what blocked the ray before changes what a ray sees.
TEST_P(BvhRaysTest, shadowRaysSeeWhatTheyWouldSeeAlone) {
  RandomPoints random(35);
  auto list = crowd(300);
  for (const double side : {-1.5, 1.5}) {  // a wall in front of a light
    list.push_back(facePrimitive(PrimitiveKind::quad, {side, -0.8, -2}, {0, 1.6, 0}, {0, 0, 4}));
  }
  const StageScene<float> scene(list);
  const auto compare = [&](size_t count, bool scattered) {
    RayBatch batch = shadowRays(count, scattered, random);
    std::vector<bool> want, sure;
    batch.extend(named("bvh"), scene.view);
    for (size_t i = 0; i < count; ++i) {
      const Hits& hits = batch.wave.hits;
      if (hits.primitive[i] == kMiss) {
        want.push_back(false);
        sure.push_back(true);
        continue;
      }
      const auto& hit = scene.precise[hits.primitive[i]];
      const Rays<float>& rays = batch.wave.rays;
      const Point start{rays.originX[i], rays.originY[i], rays.originZ[i]};
      const Point segment{rays.directionX[i], rays.directionY[i], rays.directionZ[i]};
      const bool sphere = hit.kind == static_cast<uint32_t>(PrimitiveKind::sphere);
      const double t =
          sphere ? double{hits.u[i]} : dot(corner(hit, hits.u[i], hits.v[i]) - start, segment) / dot(segment, segment);
      want.push_back(t < 1);
      sure.push_back(std::abs(t - 1) > 1e-4);
    }
    const std::vector<bool> got = batch.occluded(named("bvh"), scene.view, 1);
    for (size_t i = 0; i < count; ++i) {
      if (sure[i]) {
        ASSERT_EQ(got[i], want[i]) << "ray " << i << " of " << count;
      }
    }
    const auto blocked = static_cast<size_t>(std::count(want.begin(), want.end(), true));
    if (count < 200 || scattered) return;
    EXPECT_GT(blocked, count / 3);
    EXPECT_LT(blocked, count - count / 10);
  };
  for (const size_t count : {size_t{1}, size_t{7}, size_t{255}, size_t{257}, RayBatch::kCapacity}) {
    compare(count, false);
    compare(count, true);
  }
}

// The square of the length of a segment times that of such a radius is more than float holds.
TEST_P(BvhRaysTest, largeSpheresBlockLongShadowRays) {
  RandomPoints random(36);
  const StageScene<float> scene({spherePrimitive({0, 0, 0}, 3e9)});
  RayBatch batch;
  for (size_t i = 0; i < 300; ++i) batch.push(aimedRay(random.direction() * 1e10, random.inCube(1e9)));
  for (const auto& [length, blocks] : {std::pair{2e10f, true}, std::pair{6e9f, false}}) {
    const std::vector<bool> blocked = batch.occluded(named("bvh"), scene.view, length);
    EXPECT_EQ(std::ranges::count(blocked, blocks), 300) << length;
  }
}

// ---- watertightness -------------------------------------------------------------------------------------------------
// All instruction sets in one test, as large scenes take longer to build than to trace.

TEST_F(BvhRays, noRayLeavesAClosedMesh) {
  RandomPoints random(41);
  for (const double bumps : {0.0, 0.05}) {
    const ClosedBody body = bumpySphere(effort(100, 20), bumps);
    const StageScene<float> scene(body.walls);
    std::vector<TestRay> rays;
    const auto start = [&] { return body.center + random.inCube(body.reach); };
    for (const Point& corner : body.corners) rays.push_back(aimedRay(start(), corner));
    for (const auto& edge : body.edges) {
      const Point &a = body.corners[edge[0]], &b = body.corners[edge[1]];
      rays.push_back(aimedRay(start(), a + (b - a) * random.uniform(0, 1)));
    }
    while (rays.size() < samples(1'000'000, 50'000)) rays.push_back(roundedRay(start(), random.direction()));
    for (const Isa isa : availableIsas()) {
      for (const char* name : {"bvh", "packets"}) {
        size_t leaks = 0;
        for (const Found& found : hits(named(name, isa), scene, rays)) leaks += found.primitive == kMiss ? 1 : 0;
        EXPECT_EQ(leaks, 0u) << name << " on " << toString(isa) << ", bumps " << bumps;
      }
    }
  }
}

// As the rays of a lamp would: the margins of boxes have to know how far away it is.
TEST_F(BvhRays, noRayFromAfarEntersAClosedMesh) {
  RandomPoints random(42);
  const ClosedBody body = bumpySphere(effort(100, 20), 0);
  for (const double distance : {300.0, 30'000.0}) {
    const Point towardsLamp = normalized(turned({1, 0.7, 0.5})), lamp = body.center + towardsLamp * distance;
    const StageScene<float> scene(body.walls, boxAt({lamp[0], lamp[1], lamp[2]}));
    // At edges of the near side whose faces all lie there.
    std::vector<TestRay> rays;
    for (const auto& edge : body.edges) {
      const Point &a = body.corners[edge[0]], &b = body.corners[edge[1]];
      if (dot(a - body.center, towardsLamp) < 0.5) continue;
      for (size_t i = 0; i < 10; ++i) rays.push_back(aimedRay(lamp, a + (b - a) * random.uniform(0, 1)));
    }
    for (const Isa isa : availableIsas()) {
      size_t leaks = 0;
      for (const Found& found : hits(named("bvh", isa), scene, rays)) {
        // On the near side a face lies towards the lamp.
        const bool leaked =
            found.primitive == kMiss || dot(corner(body.walls[found.primitive], 0, 0) - body.center, towardsLamp) < 0;
        leaks += leaked ? 1 : 0;
      }
      EXPECT_EQ(leaks, 0u) << toString(isa) << ", distance " << distance;
    }
  }
}

}  // namespace
}  // namespace wavecrest
