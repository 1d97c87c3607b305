// The integers of light paths, connections and merges: what goes into each stage and comes out (METHODS 9.9).
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>
#include <set>

#include "tests/engine/bidirectional_walk.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr MisSettings kVcm{.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true};

bool isDiffuse(const SceneView<float>& scene, uint32_t primitive) {
  const MaterialRecord& material = scene.materials[scene.primitives[primitive].material];
  return static_cast<BsdfKind>(material.kind) == BsdfKind::diffuse && (material.flags & kHasDelta) == 0;
}
bool hasFiniteLobe(const SceneView<float>& scene, uint32_t primitive) {
  return (scene.materials[scene.primitives[primitive].material].flags & kHasFinite) != 0;
}

// Counts again, item by item, what the stages have counted and stored.
class Recount : public WalkVisitor<float> {
 public:
  explicit Recount(BidirectionalWalk<float>& walk) : walk_(walk) {}

  size_t splatRays = 0, connections = 0, merges = 0, stored = 0;

  void leaving(Walk kind, uint32_t depth, const Wave<float>& wave) override {
    if (kind == Walk::light && depth == 1) {
      EXPECT_EQ(wave.rays.size, wave.pathCount);  // 1
    }
    EXPECT_EQ(wave.rays.size, depth == 1 ? wave.pathCount : survivors_);  // 2
    rays_ = wave.rays.size;
    misses_ = walk_.counters.misses;
    rayOfLane_.clear();
    for (size_t i = 0; i < rays_; ++i) rayOfLane_[wave.paths.lane[i]] = i;
  }

  void arrived(Walk kind, uint32_t depth, const Wave<float>& wave) override {
    const size_t missed = walk_.counters.misses - misses_;
    const bool last = depth == walk_.limits().maxDepth;
    EXPECT_EQ(wave.rays.size, last ? 0 : rays_ - missed) << "depth " << depth;  // 1: every ray hits or misses
    expectOrder(wave);
    if (kind == Walk::light) {
      expectedStored_.clear();
      for (size_t i = 0; i < wave.rays.size; ++i) {
        if (hasFiniteLobe(walk_.scene(), wave.hits.primitive[i])) expectedStored_.push_back(wave.paths.lane[i]);
      }
    }
  }

  void splats(uint32_t depth, Wave<float>& wave) override {
    // 5: a vertex is stored iff it has more than delta lobes; in the order of the wave.
    const LightStore<float>& light = walk_.light();
    std::vector<uint32_t> lanes;
    for (size_t i = light.firstOf(depth); i < light.firstOf(depth + 1); ++i) {
      lanes.push_back(light.vertices.lane[i]);
      EXPECT_EQ(edgesOf(light.vertices.row[i]), depth);
    }
    EXPECT_EQ(lanes, expectedStored_) << "depth " << depth;
    stored += lanes.size();
    // 6: at most one splat for each of them, and each on the film.
    EXPECT_LE(wave.shadowRays.size, lanes.size());
    for (size_t i = 0; i < wave.shadowRays.size; ++i) {
      EXPECT_LT(wave.shadowRays.target[i], walk_.area().pixels.size());
    }
    splatRays += wave.shadowRays.size;
  }

  void scattered(Walk, uint32_t depth, const Wave<float>& wave) override {
    EXPECT_LE(wave.rays.size, rays_) << "depth " << depth;
    survivors_ = wave.rays.size;
  }

  void nextEvent(uint32_t, Wave<float>& wave) override {
    size_t candidates = 0;  // 4
    for (size_t i = 0; i < wave.rays.size; ++i) {
      candidates += hasFiniteLobe(walk_.scene(), wave.hits.primitive[i]) ? 1 : 0;
    }
    EXPECT_LE(wave.shadowRays.size, candidates);
  }

  void connection(uint32_t lightDepth, uint32_t depth, Wave<float>& wave) override {
    // 7: every stored vertex of the same lane, if the path is not too long and more than delta lobes meet there.
    size_t pairs = 0;
    const LightStore<float>& light = walk_.light();
    if (lightDepth + depth + 1 <= walk_.limits().maxDepth) {
      std::set<uint32_t> lanes;
      for (size_t i = 0; i < wave.rays.size; ++i) {
        if (hasFiniteLobe(walk_.scene(), wave.hits.primitive[i])) lanes.insert(wave.paths.lane[i]);
      }
      for (size_t i = light.firstOf(lightDepth); i < light.firstOf(lightDepth + 1); ++i) {
        pairs += lanes.count(light.vertices.lane[i]);
      }
    }
    EXPECT_EQ(walk_.counters.connections, connections + pairs) << "light depth " << lightDepth << ", depth " << depth;
    EXPECT_LE(wave.shadowRays.size, pairs);
    connections += pairs;
  }

  void merging(uint32_t depth, Wave<float>& wave, StageContext<float>& context) override {
    if (depth == 1) {
      checkPlaces();
      buildMap();
    }
    context.light.photons = &map_;
    walk_.stages().merge(context, wave);
    const size_t expected = depth + 1 > walk_.limits().maxDepth ? 0 : bruteForceMerges(depth, wave);
    EXPECT_EQ(walk_.counters.merges, merges + expected) << "depth " << depth;
    merges += expected;
  }

 private:
  // 15: opaque diffuse vertices, others with more than delta lobes, the rest; in the order of their rays among
  // themselves.
  void expectOrder(const Wave<float>& wave) {
    size_t joinable = 0, diffuse = 0;
    std::pair<int, size_t> previous;
    for (size_t i = 0; i < wave.rays.size; ++i) {
      const uint32_t primitive = wave.hits.primitive[i];
      const bool finite = hasFiniteLobe(walk_.scene(), primitive);
      joinable += finite ? 1 : 0;
      diffuse += isDiffuse(walk_.scene(), primitive) ? 1 : 0;
      const std::pair<int, size_t> place{isDiffuse(walk_.scene(), primitive) ? 0
                                         : finite                            ? 1
                                                                             : 2,
                                         rayOfLane_.at(wave.paths.lane[i])};
      EXPECT_TRUE(i == 0 || previous < place) << "vertex " << i;
      previous = place;
    }
    EXPECT_EQ(wave.joinable, joinable);
    EXPECT_EQ(wave.diffuse, diffuse);
  }

  void buildMap() {
    LightStore<float>* const stores[1] = {const_cast<LightStore<float>*>(&walk_.light())};
    map_.build(stores, walk_.photonGrid(), forEach);
    // 8: buckets hold all photons, each in its own.
    const uint32_t buckets = map_.bucketMask + 1;
    ASSERT_EQ(map_.size, walk_.light().vertices.size);
    EXPECT_EQ(map_.bucketStart[0], 0u);
    EXPECT_EQ(map_.bucketStart[buckets], map_.size);
    const auto& vertices = walk_.light().vertices;
    std::set<uint32_t> sorted;
    for (uint32_t bucket = 0; bucket < buckets; ++bucket) {
      for (uint32_t i = map_.bucketStart[bucket]; i < map_.bucketStart[bucket + 1]; ++i) {
        const uint32_t photon = map_.keys[i].photon;
        ASSERT_LT(photon, vertices.size);
        EXPECT_EQ(vertices.cell[photon] & map_.bucketMask, bucket);
        EXPECT_EQ(vertices.place[photon], map_.keys[i].place);
        EXPECT_EQ(&map_.rowOf(photon), &vertices.row[photon]);
        sorted.insert(photon);
      }
    }
    EXPECT_EQ(sorted.size(), vertices.size);
  }

  static uint32_t edgesOf(const VertexRow<float>& row) { return std::bit_cast<uint32_t>(row.tag) >> kMaterialBits; }

  // The places that kernels have stored are those of the rows.
  void checkPlaces() {
    const auto& v = walk_.light().vertices;
    for (size_t i = 0; i < v.size; ++i) {
      const VertexRow<float>& row = v.row[i];
      const auto expected = walk_.photonGrid().at(row.position);
      EXPECT_EQ(v.cell[i], expected.cell);
      EXPECT_EQ(v.place[i], expected.place);
      EXPECT_LT(std::bit_cast<uint32_t>(row.tag) % kMaxMaterials, walk_.scene().materialCount);
    }
  }

  // 9: every pair of a camera vertex and a photon is looked at.
  size_t bruteForceMerges(uint32_t depth, const Wave<float>& wave) const {
    const auto& v = walk_.light().vertices;
    const auto radius = static_cast<float>(walk_.mis().radius);
    size_t count = 0;
    for (size_t i = 0; i < wave.rays.size; ++i) {
      if (!hasFiniteLobe(walk_.scene(), wave.hits.primitive[i])) continue;
      for (size_t k = 0; k < v.size; ++k) {
        if (edgesOf(v.row[k]) + depth > walk_.limits().maxDepth) continue;
        const auto& p = v.row[k].position;
        const float x = p[0] - wave.rays.originX[i], y = p[1] - wave.rays.originY[i], z = p[2] - wave.rays.originZ[i];
        const float nx = wave.surfaces.normalX[i], ny = wave.surfaces.normalY[i], nz = wave.surfaces.normalZ[i];
        const bool near = x * x + y * y + z * z <= radius * radius;
        const auto& n = v.row[k].normal;
        const bool alike = nx * n[0] + ny * n[1] + nz * n[2] > 0.1f;
        const bool flat = std::abs(x * nx + y * ny + z * nz) <= 0.5f * radius;
        count += near && alike && flat ? 1 : 0;
      }
    }
    return count;
  }

  BidirectionalWalk<float>& walk_;
  PhotonMap<float> map_;
  std::map<uint32_t, size_t> rayOfLane_;
  size_t rays_ = 0, survivors_ = 0;
  uint64_t misses_ = 0;
  std::vector<uint32_t> expectedStored_;
};

TEST(LightInvariants, holdFromStageToStage) {
  for (const RoomLight light : {RoomLight::quad, RoomLight::constant}) {
    for (const RoomMaterials materials : {RoomMaterials::diffuse, RoomMaterials::mixed}) {
      const Scene scene = roomScene({.light = light, .materials = materials, .width = 32, .height = 24});
      const WalkSettings settings{.lightPaths = 768, .radius = 0.1, .limits = {.maxDepth = 7, .rouletteDepth = 3}};
      BidirectionalWalk<float> walk(scene, settings, kVcm);
      Recount recount(walk);
      walk.run(0, recount);
      EXPECT_EQ(walk.counters.lightVertices, recount.stored);
      EXPECT_EQ(walk.light().vertices.size, recount.stored);
      EXPECT_EQ(walk.counters.nonFinite, 0u);  // 14
      EXPECT_GT(recount.splatRays, 50u);
      EXPECT_GT(recount.connections, 500u);
      EXPECT_GT(recount.merges, 1000u);
    }
  }
}

// What connections of each depth of light vertices by itself push, and those of all of them together.
class ConnectionsTogether : public WalkVisitor<float> {
 public:
  explicit ConnectionsTogether(BidirectionalWalk<float>& walk) : walk_(walk) {}

  void connection(uint32_t, uint32_t, Wave<float>& wave) override { note(wave, oneByOne_); }
  void merging(uint32_t depth, Wave<float>& wave, StageContext<float>& context) override {
    std::multiset<Segment> together;
    context.light.depths = {};
    context.light.repetition = 0;
    do {
      walk_.stages().connectVertices(context, wave);
      note(wave, together);
      ++context.light.repetition;
    } while (wave.openPairs != 0);
    EXPECT_EQ(together, oneByOne_) << "depth " << depth;
    segments += together.size();
    repetitions = std::max(repetitions, context.light.repetition);
    oneByOne_.clear();
  }
  size_t segments = 0;
  uint32_t repetitions = 0;

 private:
  using Segment = std::array<float, 7>;  // target, direction, contribution
  static void note(const Wave<float>& wave, std::multiset<Segment>& segments) {
    const auto& s = wave.shadowRays;
    for (size_t i = 0; i < s.size; ++i) {
      segments.insert({static_cast<float>(s.target[i]), s.directionX[i], s.directionY[i], s.directionZ[i], s.red[i],
                       s.green[i], s.blue[i]});
    }
  }

  BidirectionalWalk<float>& walk_;
  std::multiset<Segment> oneByOne_;
};

TEST(LightInvariants, connectionsOfAllDepthsAreThoseOfEachDepth) {
  for (const uint32_t longest : {4u, 9u}) {  // the shorter paths leave out vertices that there are
    const Scene scene =
        roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = 32, .height = 24});
    const WalkSettings settings{.lightPaths = 768, .radius = 0.1, .limits = {.maxDepth = longest, .rouletteDepth = 6}};
    BidirectionalWalk<float> walk(scene, settings, kVcm);
    ConnectionsTogether connections(walk);
    walk.run(0, connections);
    EXPECT_GT(connections.segments, 800u);
    EXPECT_GT(connections.repetitions, 1u) << "more pairs than there is room for at once";
  }
}

// Where photons are few for the radius the cells of the map are wider than a search.
TEST(LightInvariants, holdForMergesOfASmallRadius) {
  const Scene scene = roomScene({.light = RoomLight::quad, .width = 64, .height = 48});
  const WalkSettings settings{.lightPaths = 3072, .radius = 0.01, .limits = {.maxDepth = 7, .rouletteDepth = 3}};
  BidirectionalWalk<float> walk(scene, settings, kVcm);
  Recount recount(walk);
  walk.run(0, recount);
  EXPECT_GT(recount.merges, 300u);
}

uint64_t itemsOf(const RenderStatistics& statistics, const std::string& name) {
  for (const auto& row : statistics.stages) {
    if (row.name == name) return row.items;
  }
  ADD_FAILURE() << "no stage " << name;
  return 0;
}

RenderStatistics statisticsOf(const Scene& scene, Method method) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.method = method;
  settings.measureStages = true;
  settings.waveSize = 100;
  const auto session = Session::create(scene, settings);
  session->renderUntil(3, std::nullopt);
  return session->statistics();
}

// 10: in a room without delta lobes a camera path of ppm ends where it merges, and lt's camera pass at its first
// vertex.
TEST(LightInvariants, cameraPathsThatGoOnByDeltaLobesAloneEndAtTheFirstOtherVertex) {
  const Scene scene = roomScene({.light = RoomLight::quad, .width = 40, .height = 27});
  const RenderStatistics ppm = statisticsOf(scene, Method::ppm);
  EXPECT_EQ(itemsOf(ppm, "extend"), 3u * 40 * 27);
  EXPECT_LE(itemsOf(ppm, "merge"), 3u * 40 * 27);
  const RenderStatistics lt = statisticsOf(scene, Method::lt);
  EXPECT_EQ(itemsOf(lt, "extend first"), 3u * 40 * 27);
  EXPECT_EQ(itemsOf(lt, "extend"), 0u);
  const Scene mixed =
      roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = 40, .height = 27});
  EXPECT_GT(itemsOf(statisticsOf(mixed, Method::lt), "extend"), 100u);
  EXPECT_GT(itemsOf(statisticsOf(mixed, Method::ppm), "extend"), 3u * 40 * 27 + 100);
}

// The session's statistics of light passes add up.
TEST(LightInvariants, statisticsAddUp) {
  const Scene scene = roomScene({.light = RoomLight::quad, .width = 40, .height = 27});
  for (const Method method : {Method::bpt, Method::vcm}) {
    const RenderStatistics s = statisticsOf(scene, method);
    EXPECT_EQ(s.lightPaths, 3u * 40 * 27);
    EXPECT_EQ(itemsOf(s, "generate light"), s.lightPaths);
    EXPECT_EQ(itemsOf(s, "extend light") + itemsOf(s, "extend"), s.counters.raysClosest);
    EXPECT_EQ(itemsOf(s, "store"), itemsOf(s, "connect to camera"));
    EXPECT_EQ(itemsOf(s, "store"), s.counters.lightVertices) << "all surfaces are diffuse";
    EXPECT_EQ(itemsOf(s, "occlude light") + itemsOf(s, "occlude") + itemsOf(s, "occlude connection"),
              s.counters.raysShadow);
    EXPECT_LE(itemsOf(s, "occlude connection"), s.counters.connections);
    EXPECT_EQ(s.counters.nonFinite, 0u);
  }
}

}  // namespace
}  // namespace wavecrest
