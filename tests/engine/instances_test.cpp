// Instances in a hierarchy of two levels against copies of their groups: the same hits, shadows and surfaces.
#include <gtest/gtest.h>

#include <span>

#include "engine/plan/render_plan.h"
#include "engine/scene/scene_error.h"
#include "engine/tasks/flush_to_zero.h"
#include "tests/effort.h"
#include "tests/engine/instanced_scenes.h"

namespace wavecrest {
namespace {

constexpr size_t kCapacity = 2048;

// A vertex that arrive makes, or nothing where the ray leaves the scene.
struct Arrival {
  bool hit = false;
  Double3 position{}, normal{}, shading{};
  double u = 0, v = 0, tangent = 0, offset = 0;
};

// How rays are walked.
struct WalkKind {
  Isa isa;
  bool packets;
};
std::vector<WalkKind> allWalks() {
  std::vector<WalkKind> walks;
  for (const Isa isa : availableIsas()) {
    walks.push_back({isa, false});
    walks.push_back({isa, true});
  }
  return walks;
}

// Gives the wave these rays and no others.
template <class S>
void putRays(Wave<S>& wave, std::span<const RandomRay> rays) {
  wave.setVertices(0, 0);
  wave.rays.claim(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    wave.rays.originX[i] = static_cast<S>(rays[i].origin[0]);
    wave.rays.originY[i] = static_cast<S>(rays[i].origin[1]);
    wave.rays.originZ[i] = static_cast<S>(rays[i].origin[2]);
    wave.rays.directionX[i] = static_cast<S>(rays[i].direction[0]);
    wave.rays.directionY[i] = static_cast<S>(rays[i].direction[1]);
    wave.rays.directionZ[i] = static_cast<S>(rays[i].direction[2]);
  }
}

template <class S>
class Bench {
 public:
  Bench(const Scene& scene, Instancing instancing)
      : compiled_(compileScene<S>(scene, Accel::bvh, true, instancing)), wave_(kCapacity, {}) {
    context_.scene = &compiled_->view;
    context_.counters = &counters_;
    context_.limits.maxDepth = 100;
  }
  const CompiledScene<S>& scene() const { return *compiled_; }

  std::vector<Arrival> arrivals(const std::vector<RandomRay>& rays, const WalkKind& walk) {
    std::vector<Arrival> out;
    for (size_t first = 0; first < rays.size(); first += kCapacity) {
      const size_t count = std::min(kCapacity, rays.size() - first);
      put(std::span(rays).subspan(first, count));
      context_.depth = walk.packets ? 1 : 2;
      const Stages<S>& stages = stagesOf(walk.isa);
      const Intersector<S> intersector = chooseIntersector(stages, *compiled_);
      intersector.extend(context_, wave_);
      stages.arrive(context_, wave_);
      std::vector<Arrival> part(count);
      for (size_t i = 0; i < wave_.rays.size; ++i) part[wave_.paths.lane[i]] = arrival(i);
      out.insert(out.end(), part.begin(), part.end());
    }
    return out;
  }
  std::vector<bool> blocked(const std::vector<RandomRay>& rays, double distance, Isa isa) {
    std::vector<bool> out;
    for (size_t first = 0; first < rays.size(); first += kCapacity) {
      const size_t count = std::min(kCapacity, rays.size() - first);
      auto& shadow = wave_.shadowRays;
      shadow.size = wave_.radiance.size = 0;
      shadow.claim(count);
      wave_.radiance.claim(count);
      for (size_t i = 0; i < count; ++i) {
        const RandomRay& ray = rays[first + i];
        for (size_t k = 0; k < 3; ++k) {
          const std::array origins{&shadow.originX, &shadow.originY, &shadow.originZ};
          const std::array directions{&shadow.directionX, &shadow.directionY, &shadow.directionZ};
          (*origins[k])[i] = static_cast<float>(ray.origin[k]);
          (*directions[k])[i] = static_cast<float>(ray.direction[k] * distance);
        }
        shadow.red[i] = shadow.green[i] = shadow.blue[i] = 1;
        shadow.target[i] = static_cast<uint32_t>(i);
        wave_.radiance.red[i] = wave_.radiance.green[i] = wave_.radiance.blue[i] = 0;
      }
      chooseIntersector(stagesOf(isa), *compiled_).occlude(context_, wave_);
      for (size_t i = 0; i < count; ++i) out.push_back(wave_.radiance.red[i] == 0);
    }
    return out;
  }

  static const Stages<S>& stagesOf(Isa isa) {
    constexpr Precision kPrecision = sizeof(S) == sizeof(double) ? Precision::doubled : Precision::floating;
    return findStages<S>(isa, kPrecision, Specialization::complete);
  }

 private:
  void put(std::span<const RandomRay> rays) {
    putRays(wave_, rays);
    wave_.paths.claim(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      wave_.paths.throughputR[i] = wave_.paths.throughputG[i] = wave_.paths.throughputB[i] = 1;
      wave_.paths.dVCM[i] = wave_.paths.dVC[i] = wave_.paths.rouletteScale[i] = 1;
      wave_.paths.lane[i] = static_cast<uint32_t>(i);
    }
  }
  Arrival arrival(size_t i) const {
    const auto& surfaces = wave_.surfaces;
    return {.hit = true,
            .position = {wave_.rays.originX[i], wave_.rays.originY[i], wave_.rays.originZ[i]},
            .normal = {surfaces.normalX[i], surfaces.normalY[i], surfaces.normalZ[i]},
            .shading = {surfaces.shadingX[i], surfaces.shadingY[i], surfaces.shadingZ[i]},
            .u = surfaces.uvU[i],
            .v = surfaces.uvV[i],
            .tangent = surfaces.tangent[i],
            .offset = surfaces.offset[i]};
  }

  std::unique_ptr<CompiledScene<S>> compiled_;
  Wave<S> wave_;
  StageCounters counters_;
  StageContext<S> context_;
};

// Rounding of coordinates of the scene's size, 10, and of normals between vertices 0.2 apart.
constexpr double kPositionError = 2e-5, kNormalError = 2e-4, kUvError = 2e-4;

double turned(double angle) { return std::abs(std::remainder(angle, 2 * 3.14159265358979)); }

// What differs between two vertices, or nothing.
std::string difference(const Arrival& a, const Arrival& b) {
  if (a.hit != b.hit) return "hit";
  if (!a.hit) return {};
  if (length(a.position - b.position) > kPositionError) return "position";
  if (length(a.normal - b.normal) > kNormalError) return "normal";
  if (length(a.shading - b.shading) > kNormalError) return "shading normal";
  if (std::abs(a.u - b.u) > kUvError || std::abs(a.v - b.v) > kUvError) return "texture coordinates";
  if (turned(a.tangent - b.tangent) > 1e-2) return "tangent";
  return {};
}

template <class S>
void expectSameArrivals(bool spheres) {
  std::vector<Matrix4> places = allKindsOfPlaces();
  if (spheres) places.resize(3);  // those that leave spheres round
  const Scene scene = placedScene(places, spheres);
  Bench<S> kept(scene, Instancing::kept), copied(scene, Instancing::expanded);
  ASSERT_NE(kept.scene().view.instances, nullptr);
  ASSERT_EQ(copied.scene().view.instances, nullptr);
  const std::vector<RandomRay> rays = randomRays(effort(100'000, 4'000), 6, 1);
  const std::vector<Arrival> expected = copied.arrivals(rays, {bestIsa(), false});
  for (const WalkKind& walk : allWalks()) {
    const std::vector<Arrival> got = kept.arrivals(rays, walk);
    std::map<std::string, size_t> differences;
    size_t hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      hits += got[i].hit ? 1 : 0;
      if (const std::string what = difference(got[i], expected[i]); !what.empty()) ++differences[what];
    }
    EXPECT_GT(hits, rays.size() / 4);
    // Rays that pass an edge within the rounding of its place, and texture coordinates that jump there.
    size_t all = 0;
    std::string text;
    for (const auto& [what, count] : differences) {
      all += count;
      text += " " + std::to_string(count) + " " + what;
    }
    EXPECT_LE(all, rays.size() / 2000) << toString(walk.isa) << (walk.packets ? " packets:" : " rays:") << text;
  }
}

TEST(Instances, areMetWhereCopiesAre) { expectSameArrivals<float>(false); }
TEST(Instances, areMetWhereCopiesAreInDouble) { expectSameArrivals<double>(false); }
TEST(Instances, ofSpheresAreMetWhereCopiesAre) { expectSameArrivals<float>(true); }
TEST(Instances, ofSpheresAreMetWhereCopiesAreInDouble) { expectSameArrivals<double>(true); }

// In the group the product of the squares of the direction's length and of the radius is below what float holds.
TEST(Instances, ofTinySpheresAreMetAtTheirSurface) {
  constexpr double kScale = 1e12, kWorldRadius = 1e-8 * kScale;
  const Scene scene = tinySphere(kScale);
  const auto compiled = compileScene<float>(scene, Accel::bvh, true, Instancing::kept);
  Wave<float> wave(kCapacity, {});
  StageCounters counters;
  StageContext<float> context;
  context.scene = &compiled->view;
  context.counters = &counters;
  // Towards points within half a radius of the centre.
  std::vector<RandomRay> rays = randomRays(kCapacity, 1, 5);
  for (RandomRay& ray : rays) {
    const Double3 target = ray.origin * (0.25 * kWorldRadius);
    ray.origin = target - ray.direction * (3 * kWorldRadius);
    for (double& c : ray.origin) c = static_cast<float>(c);
  }
  const FlushToZero flushToZero;
  for (const WalkKind& walk : allWalks()) {
    putRays(wave, rays);
    context.depth = walk.packets ? 1 : 2;
    Bench<float>::stagesOf(walk.isa).extendInstances(context, wave);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(wave.hits.primitive[i], 0u) << toString(walk.isa) << " ray " << i;
      const Double3 &o = rays[i].origin, &d = rays[i].direction;
      const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - kWorldRadius * kWorldRadius;
      const double distance = (-b - std::sqrt(b * b - a * c)) / a;
      ASSERT_NEAR(static_cast<double>(wave.hits.u[i]), distance, 1e-4 * kWorldRadius) << toString(walk.isa);
    }
  }
}

TEST(Instances, blockWhatCopiesBlock) {
  const Scene scene = placedScene(allKindsOfPlaces(), false);
  Bench<float> kept(scene, Instancing::kept), copied(scene, Instancing::expanded);
  const std::vector<RandomRay> rays = randomRays(effort(100'000, 4'000), 6, 2);
  for (const Isa isa : availableIsas()) {
    for (const double distance : {2.0, 9.0}) {
      const std::vector<bool> expected = copied.blocked(rays, distance, bestIsa()),
                              got = kept.blocked(rays, distance, isa);
      size_t differences = 0, blocked = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        differences += got[i] != expected[i] ? 1 : 0;
        blocked += got[i] ? 1 : 0;
      }
      EXPECT_GT(blocked, rays.size() / 20);
      EXPECT_LE(differences, rays.size() / 5000) << toString(isa) << ", distance " << distance;
    }
  }
}

// Which of two instances in the same place a ray meets does not depend on the order in which it visits them.
TEST(Instances, inTheSamePlaceAreTakenInTheirOrder) {
  const Matrix4 place = allKindsOfPlaces()[4];
  const Scene scene = placedScene({place, place, place}, false);
  const auto compiled = compileScene<float>(scene, Accel::bvh, true, Instancing::kept);
  Wave<float> wave(kCapacity, {});
  StageCounters counters;
  StageContext<float> context;
  context.scene = &compiled->view;
  context.counters = &counters;
  const std::vector<RandomRay> rays = randomRays(kCapacity, 6, 3);
  for (const WalkKind& walk : allWalks()) {
    putRays(wave, rays);
    context.depth = walk.packets ? 1 : 2;
    Bench<float>::stagesOf(walk.isa).extendInstances(context, wave);
    size_t first = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (wave.hits.primitive[i] == kMiss || wave.hits.instance[i] == kNoIndex) continue;
      EXPECT_EQ(wave.hits.instance[i], 0u);
      ++first;
    }
    EXPECT_GT(first, rays.size() / 50);
  }
}

// ---- closed meshes --------------------------------------------------------------------------------------------------

struct Setting {
  const char* name;
  double distance, size;  // of the instance from the world's origin, and its scale
};
constexpr Setting kSettings[] = {{"near", 4, 1}, {"far", 1000, 1}, {"tinyAndFar", 10, 1e-3}, {"large", 4e4, 1e4}};

// Two balls on either side of the world's origin, which keeps it there.
Scene ballAt(const Matrix4& turn, const Setting& setting) {
  Scene scene;
  scene.groups.push_back({.id = "ball", .source = {}});
  const uint32_t white = addMaterial(scene, Diffuse{{{1, 1, 1}}}, true);
  Mesh ball = ballMesh(kGroupCenter, 1, 24);
  ball.normals.clear();
  addShape(scene, ball, white).group = 0;
  Double3 columns[3];
  for (size_t j = 0; j < 3; ++j) columns[j] = Double3{turn[0][j], turn[1][j], turn[2][j]} * setting.size;
  for (const double side : {1.0, -1.0}) {
    addInstance(scene, 0, placedAt(Double3{0.6, -0.5, 0.62} * (side * setting.distance), columns, kGroupCenter));
  }
  setCamera(scene, {0, 0, 20}, 60, 32, 24);
  return scene;
}
Double3 centerOf(const Scene& scene) { return transformPoint(scene.instances[0].toWorld, kGroupCenter); }

class ClosedInstanceTest : public testing::TestWithParam<Setting> {};

// Rays from within find the mesh, those that have just left a face find another one, and all of them stay inside.
template <class S>
void bounceWithin(const Setting& setting) {
  constexpr size_t kPaths = 1024;
  for (const Matrix4& turn : allKindsOfPlaces()) {
    const Scene scene = ballAt(turn, setting);
    const auto compiled = compileScene<S>(scene, Accel::bvh, true, Instancing::kept);
    for (const Isa isa : availableIsas()) {
      const Stages<S>& stages = Bench<S>::stagesOf(isa);
      Wave<S> wave(kPaths, {});
      StageCounters counters;
      StageContext<S> context;
      context.scene = &compiled->view;
      context.counters = &counters;
      context.limits = {.maxDepth = 1000, .rouletteDepth = 1000};
      wave.pathCount = kPaths;
      wave.setVertices(0, 0);
      wave.rays.claim(kPaths);
      wave.paths.claim(kPaths);
      const std::vector<RandomRay> rays = randomRays(kPaths, 1, 4);
      for (size_t i = 0; i < kPaths; ++i) {
        const Double3 from = centerOf(scene) - compiled->origin;
        wave.rays.originX[i] = static_cast<S>(from[0]);
        wave.rays.originY[i] = static_cast<S>(from[1]);
        wave.rays.originZ[i] = static_cast<S>(from[2]);
        wave.rays.directionX[i] = static_cast<S>(rays[i].direction[0]);
        wave.rays.directionY[i] = static_cast<S>(rays[i].direction[1]);
        wave.rays.directionZ[i] = static_cast<S>(rays[i].direction[2]);
        wave.paths.throughputR[i] = wave.paths.throughputG[i] = wave.paths.throughputB[i] = 1;
        wave.paths.dVCM[i] = wave.paths.dVC[i] = wave.paths.rouletteScale[i] = 1;
        wave.paths.lane[i] = static_cast<uint32_t>(i);
      }
      std::vector<uint32_t> previous(kPaths, kMiss);
      for (context.depth = 1; context.depth <= effort(24, 6); ++context.depth) {
        stages.extendInstances(context, wave);
        for (size_t i = 0; i < wave.rays.size; ++i) {
          const uint32_t now = wave.hits.primitive[i];
          uint32_t& before = previous[wave.paths.lane[i]];
          ASSERT_NE(now, kMiss) << toString(isa) << ", depth " << context.depth << " item " << i;
          ASSERT_EQ(wave.hits.instance[i], 0u) << toString(isa) << ", depth " << context.depth << " item " << i;
          ASSERT_NE(now, before) << toString(isa) << ", depth " << context.depth << " item " << i;
          before = now;
        }
        stages.arrive(context, wave);
        stages.scatter(context, wave);
      }
      ASSERT_EQ(wave.rays.size, kPaths) << "paths were lost";
    }
  }
}

TEST_P(ClosedInstanceTest, keepsItsPaths) { bounceWithin<float>(GetParam()); }
TEST_P(ClosedInstanceTest, keepsItsPathsInDouble) { bounceWithin<double>(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Engine, ClosedInstanceTest, testing::ValuesIn(kSettings),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace wavecrest
