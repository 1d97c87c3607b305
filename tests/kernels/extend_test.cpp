// Every intersector against a brute-force reference in double, on random quads, triangles and spheres.
//
// A ray is compared only where rounding cannot decide: away from edges, silhouettes, grazing incidence and near ties.
// Everything else must agree exactly in the primitive, and in the point to a few units of rounding.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/effort.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

constexpr double kNear = 1e-3;        // closer than this to a decision, in units of the scene, is not compared
constexpr double kPointError = 2e-5;  // in the same units: 300 units of rounding, for rays that graze by up to kNear

// How many rays a random scene meets depends on the scene, so that less work means fewer rays in as many scenes.
constexpr size_t kScenes = 20;
constexpr size_t kRaysPerScene = effort(RayBatch::kCapacity, 100);

struct Crossing {
  double t;
  Point point;
  bool clear;  // rounding cannot turn it into a miss
};

struct Crossings {
  std::array<Crossing, 2> list{};
  size_t count = 0;
  const Crossing* begin() const { return list.data(); }
  const Crossing* end() const { return list.data() + count; }
};

// Where the ray's line crosses the primitive, near misses included.
Crossings crossings(const PrimitiveRecord<double>& r, const TestRay& ray) {
  const Point p0{r.p0[0], r.p0[1], r.p0[2]};
  const auto at = [&](double t) { return ray.origin + ray.direction * t; };
  if (static_cast<PrimitiveKind>(r.kind) == PrimitiveKind::sphere) {
    const Point o = ray.origin - p0;
    const double a = dot(ray.direction, ray.direction), b = dot(o, ray.direction), radius2 = r.e1[0] * r.e1[0];
    const double discriminant = b * b - a * (dot(o, o) - radius2);
    if (discriminant < -kNear * radius2) return {};
    const double root = std::sqrt(std::max(discriminant, 0.0));
    const bool clear = discriminant > kNear * radius2;
    const double first = (-b - root) / a, second = (-b + root) / a;
    return {.list = {Crossing{first, at(first), clear}, Crossing{second, at(second), clear}}, .count = 2};
  }
  const Point e1{r.e1[0], r.e1[1], r.e1[2]}, e2{r.e2[0], r.e2[1], r.e2[2]}, n = cross(e1, e2);
  const double speed = dot(n, ray.direction);
  if (speed == 0) return {};
  const double t = dot(n, p0 - ray.origin) / speed;
  const Point q = at(t) - p0;
  const double u = dot(cross(q, e2), n) / dot(n, n), v = dot(cross(e1, q), n) / dot(n, n);
  const bool quad = static_cast<PrimitiveKind>(r.kind) == PrimitiveKind::quad;
  const double inside = quad ? std::min(std::min(u, 1 - u), std::min(v, 1 - v)) : std::min(std::min(u, v), 1 - u - v);
  if (inside < -kNear) return {};
  return {.list = {Crossing{t, at(t), inside > kNear && std::abs(speed) > 0.02 * length(n)}}, .count = 1};
}

struct Reference {
  uint32_t primitive = kMiss;
  Point point{};
  bool certain = true;
};

// The closest crossing at t > 0; certain if no other choice lies within rounding.
Reference closest(const std::vector<PrimitiveRecord<double>>& records, const TestRay& ray) {
  std::vector<Crossings> crossed;
  crossed.reserve(records.size());
  for (const PrimitiveRecord<double>& record : records) crossed.push_back(crossings(record, ray));
  Reference best;
  double bestT = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < records.size(); ++i) {
    for (const Crossing& c : crossed[i]) {
      if (c.t > 0 && c.clear && c.t < bestT) {
        bestT = c.t;
        best.primitive = i;
        best.point = c.point;
      }
    }
  }
  for (uint32_t i = 0; i < records.size(); ++i) {
    for (const Crossing& c : crossed[i]) {
      const bool itself = i == best.primitive && c.t == bestT;
      const bool tooNear = std::abs(c.t) < kNear || std::abs(c.t - bestT) < kNear;
      const bool doubtful = !c.clear && c.t > -kNear && c.t < bestT + kNear;
      if (!itself && (tooNear || doubtful)) best.certain = false;
    }
  }
  return best;
}

// Whether something blocks t in (0, 1) times length; nothing where rounding decides.
std::optional<bool> blockedBefore(const std::vector<PrimitiveRecord<double>>& records, const TestRay& ray, double end) {
  bool blocked = false, certain = true;
  for (const auto& record : records) {
    for (const Crossing& c : crossings(record, ray)) {
      if (c.clear && c.t > kNear && c.t < end - kNear) blocked = true;
      if (std::abs(c.t) <= kNear || std::abs(c.t - end) <= kNear || (!c.clear && c.t > 0 && c.t < end)) certain = false;
    }
  }
  if (!blocked && !certain) return std::nullopt;
  return blocked;
}

// The point that (u, v) of a hit means.
Point hitPoint(const PrimitiveRecord<double>& r, const TestRay& ray, float u, float v) {
  if (static_cast<PrimitiveKind>(r.kind) == PrimitiveKind::sphere) return ray.origin + ray.direction * double{u};
  return corner(r, u, v);
}

struct Mix {
  const char* name;
  size_t quads, triangles, spheres;
  size_t boxes = 0, openBoxes = 0;  // of six and of five more quads
};

// Faces of a sheared box, the last of six left out if it is open.
void addBox(bool open, RandomPoints& random, std::vector<PrimitiveRecord<double>>& list) {
  const Point center = random.inCube(1);
  Point edge[3];
  for (Point& e : edge) e = random.direction() * random.uniform(0.2, 1);
  for (size_t face = 0; face < (open ? 5u : 6u); ++face) {
    const Point u = edge[(face / 2 + 1) % 3], v = edge[(face / 2 + 2) % 3];
    const Point middle = center + edge[face / 2] * (face % 2 == 0 ? -0.5 : 0.5);
    list.push_back(facePrimitive(PrimitiveKind::quad, middle - (u + v) * 0.5, u, v));
  }
}

std::vector<PrimitiveRecord<double>> randomPrimitives(const Mix& mix, RandomPoints& random) {
  std::vector<PrimitiveRecord<double>> list;
  const auto face = [&](PrimitiveKind kind) {
    const Point p = random.inCube(1), e1 = random.direction() * random.uniform(0.2, 1);
    const Point across = normalized(cross(e1, random.direction()));
    return facePrimitive(kind, p, e1, across * random.uniform(0.2, 1) + e1 * random.uniform(-0.5, 0.5));
  };
  for (size_t i = 0; i < mix.quads; ++i) list.push_back(face(PrimitiveKind::quad));
  for (size_t i = 0; i < mix.boxes; ++i) addBox(false, random, list);
  for (size_t i = 0; i < mix.openBoxes; ++i) addBox(true, random, list);
  for (size_t i = 0; i < mix.triangles; ++i) list.push_back(face(PrimitiveKind::triangle));
  for (size_t i = 0; i < mix.spheres; ++i) list.push_back(spherePrimitive(random.inCube(1), random.uniform(0.1, 0.5)));
  // The reference sees what the float records hold; of boxes that would move faces out of their planes.
  for (auto& r : list) {
    if (mix.boxes + mix.openBoxes > 0) break;
    for (auto* field : {&r.p0, &r.e1, &r.e2}) {
      for (double& x : *field) x = static_cast<float>(x);
    }
  }
  return list;
}

// The same rays through every intersector, because their references take longer.
class ExtendTest : public testing::TestWithParam<Mix> {};

TEST_P(ExtendTest, closestHitEqualsBruteForce) {
  const std::vector<Intersector> intersectors = allIntersectors();
  RandomPoints random(7);
  size_t compared = 0, hits = 0, rays = 0;
  RayBatch batch;
  for (size_t round = 0; round < kScenes; ++round) {
    const StageScene<float> scene(randomPrimitives(GetParam(), random));
    std::vector<TestRay> list;
    std::vector<Reference> wanted;
    for (batch.clear(); list.size() < kRaysPerScene; batch.push(list.back())) {
      list.push_back(aimedRay(random.inCube(2), random.inCube(1)));
      const Reference& want = wanted.emplace_back(closest(scene.precise, list.back()));
      ++rays;
      compared += want.certain ? 1 : 0;
      hits += want.certain && want.primitive != kMiss ? 1 : 0;
    }
    for (const Intersector& intersector : intersectors) {
      SCOPED_TRACE(intersector.name);
      batch.extend(intersector, scene.view);
      for (size_t i = 0; i < list.size(); ++i) {
        if (!wanted[i].certain) continue;
        const uint32_t got = batch.wave.hits.primitive[i];
        ASSERT_EQ(got, wanted[i].primitive) << "ray " << i << " of round " << round;
        if (got == kMiss) continue;
        const Point point = hitPoint(scene.precise[got], list[i], batch.wave.hits.u[i], batch.wave.hits.v[i]);
        ASSERT_LT(length(point - wanted[i].point), kPointError) << "ray " << i << " of round " << round;
      }
    }
  }
  EXPECT_GT(compared, rays * 8 / 10);
  EXPECT_GT(hits, rays / 10);
}

TEST_P(ExtendTest, occlusionEqualsBruteForce) {
  const std::vector<Intersector> intersectors = allIntersectors();
  RandomPoints random(8);
  size_t compared = 0, blocked = 0, rays = 0;
  RayBatch batch;
  for (size_t round = 0; round < kScenes; ++round) {
    const StageScene<float> scene(randomPrimitives(GetParam(), random));
    const float distance = 0.5f + 0.2f * static_cast<float>(round % 8);
    std::vector<std::optional<bool>> wanted;
    for (batch.clear(); wanted.size() < kRaysPerScene;) {
      const TestRay ray = aimedRay(random.inCube(2), random.inCube(1));
      batch.push(ray);
      const std::optional<bool> want = wanted.emplace_back(blockedBefore(scene.precise, ray, distance));
      ++rays;
      compared += want.has_value() ? 1 : 0;
      blocked += want.value_or(false) ? 1 : 0;
    }
    for (const Intersector& intersector : intersectors) {
      SCOPED_TRACE(intersector.name);
      const std::vector<bool> got = batch.occluded(intersector, scene.view, distance);
      for (size_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) continue;
        ASSERT_EQ(got[i], *wanted[i]) << "ray " << i << " of round " << round;
      }
    }
  }
  EXPECT_GT(compared, rays * 8 / 10);
  EXPECT_GT(blocked, rays / 50);
  EXPECT_LT(blocked, compared);
}

INSTANTIATE_TEST_SUITE_P(Kernels, ExtendTest,
                         testing::Values(Mix{"quads", 8, 0, 0}, Mix{"triangles", 0, 8, 0}, Mix{"spheres", 0, 0, 6},
                                         Mix{"all", 5, 5, 4}, Mix{"crowded", 60, 60, 40}, Mix{"boxes", 0, 0, 0, 3, 0},
                                         Mix{"openBoxes", 0, 0, 0, 0, 3}, Mix{"boxesAndAll", 2, 2, 2, 2, 2}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// A cube of side 2 around the origin: x = -1, x = 1, y = -1, y = 1, z = -1, z = 1.
std::vector<PrimitiveRecord<double>> cubeFaces() {
  std::vector<PrimitiveRecord<double>> faces;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Point p{-1, -1, -1}, u = p, v = p;
      p[axis] = u[axis] = v[axis] = side;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = 1;
      faces.push_back(quadPrimitive(p, u, v));
    }
  }
  return faces;
}

// Rays that run within or parallel to the planes of axis-aligned faces have zeros and infinities in every formula.
class AxisAlignedTest : public testing::TestWithParam<Intersector> {};

TEST_P(AxisAlignedTest, raysAlongTheAxesHitTheFacesTheyMeet) {
  const StageScene<float> scene(cubeFaces());
  RayBatch batch;
  std::vector<uint32_t> expected;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (const double zero : {0.0, -0.0}) {
        Point direction{zero, zero, zero};
        direction[axis] = side;
        batch.push({{0.3, -0.25, 0.5}, direction});
        expected.push_back(2 * axis + (side > 0 ? 1 : 0));
      }
    }
  }
  batch.push({{0.3, 2, 0.5}, {1, 0, 0}});  // parallel to y = 1 and outside
  expected.push_back(kMiss);
  batch.push({{0.3, 2, 0.5}, {0, 1, 0}});  // leaves the cube behind
  expected.push_back(kMiss);
  batch.push({{0.3, 2, 2}, {1, 0, 0}});  // parallel to two pairs of faces, beside both
  expected.push_back(kMiss);
  batch.push({{-3, 0.5, 0.25}, {1, 0, 0}});  // from outside
  expected.push_back(0);
  batch.push({{-3, 2, 0.25}, {1, 0, 0}});
  expected.push_back(kMiss);
  batch.extend(GetParam(), scene.view);
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(batch.wave.hits.primitive[i], expected[i]) << i;
}

// A ray within the plane of a face meets that face nowhere, and the face at the other end, whose edge it is aimed at,
// or nothing: never the faces behind it.
TEST_P(AxisAlignedTest, raysInThePlaneOfAFaceMeetNothingButItsNeighbour) {
  const StageScene<float> scene(cubeFaces());
  RayBatch batch;
  std::vector<uint32_t> ahead;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (const double plane : {-1.0, 1.0}) {
        for (const double start : {-3.0, 0.25, 3.0}) {
          Point origin{0.5, 0.5, 0.5}, direction{0, 0, 0};
          origin[(axis + 1) % 3] = plane;
          origin[axis] = start;
          direction[axis] = side;
          batch.push({origin, direction});
          const bool inside = std::abs(start) < 1, towards = start * side < 0;
          ahead.push_back(inside ? 2 * axis + (side > 0 ? 1 : 0) : towards ? 2 * axis + (side > 0 ? 0 : 1) : kMiss);
        }
      }
    }
  }
  batch.extend(GetParam(), scene.view);
  for (size_t i = 0; i < ahead.size(); ++i) {
    const uint32_t hit = batch.wave.hits.primitive[i];
    EXPECT_TRUE(hit == kMiss || hit == ahead[i]) << i << " hits " << hit;
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, AxisAlignedTest, testing::ValuesIn(allIntersectors()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace wavecrest
