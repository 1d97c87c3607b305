// Every cached MIS weight against one computed from scratch (METHODS 10.3).
//
// A wave is walked twice on the same random numbers: with the strategies of a method, and with each strategy alone,
// whose weight is 1. The quotient of the two contributions is the weight that the kernels used. The reference takes the
// recorded path, computes the density of each strategy that could have made it as a plain product, and divides by their
// sum; so all reference weights of a path sum to 1, and the kernels' do as far as they agree with them.
#include <gtest/gtest.h>

#include "tests/engine/light_scenes.h"
#include "tests/engine/path_recorder.h"

namespace wavecrest {
namespace {

struct Strategies {
  const char* name;
  MisSettings mis;
};
constexpr Strategies kBptStrategies{"bpt", {.emission = true, .nextEvent = true, .connect = true, .camera = true}};
constexpr Strategies kVcmStrategies{
    "vcm", {.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true}};
constexpr Strategies kFirstMerges{
    "vcm_first",
    {.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true, .firstMerges = true}};
constexpr Strategies kPt{"pt", {.emission = true, .nextEvent = true}};
constexpr Strategies kBpm{"bpm", {.emission = false, .nextEvent = false, .merge = true}};

bool isPartOf(const Contribution& c, const MisSettings& mis) {
  if (c.merge) return mis.merge && (!mis.firstMerges || isFirstMerge(c.path, c.strategy));
  if (c.strategy == 0) return mis.emission;
  if (c.strategy == 1) return mis.nextEvent;
  return c.strategy == c.path.edges() ? mis.camera : mis.connect;
}

// What was compared: contributions by kind, and how far weights were apart.
struct Comparison {
  size_t emission = 0, nextEvent = 0, connection = 0, camera = 0, merge = 0;
  size_t apart = 0;
  double largest = 0, meanSum = 0;
  void count(const Contribution& c) {
    if (c.merge) {
      ++merge;
    } else if (c.strategy == 0) {
      ++emission;
    } else if (c.strategy == 1) {
      ++nextEvent;
    } else if (c.strategy == c.path.edges()) {
      ++camera;
    } else {
      ++connection;
    }
  }
  size_t total() const { return emission + nextEvent + connection + camera + merge; }
};

std::string describe(const Contribution& c) {
  std::string text = c.merge ? "merge at " : "s = ";
  text += std::to_string(c.strategy) + ", k = " + std::to_string(c.path.edges()) + ", materials";
  for (size_t i = 1; i < c.path.edges(); ++i) {
    text += " " + std::to_string(c.path.x[i].material) + (c.path.x[i].specular ? "s" : "");
  }
  return text;
}

template <class S>
Comparison compareWeights(const Scene& scene, const WalkSettings& settings, const MisSettings& strategies,
                          double tolerance) {
  BidirectionalWalk<S> weighted(scene, settings, strategies), alone(scene, settings, kAlone);
  PathRecorder<S> cached(weighted), whole(alone);
  weighted.run(0, cached);
  alone.run(0, whole);
  const auto others = [&](const Contribution& c) { return !isPartOf(c, strategies); };
  std::erase_if(cached.contributions, others);
  std::erase_if(whole.contributions, others);
  EXPECT_EQ(cached.contributions.size(), whole.contributions.size());
  const PathDensity<S> reference(weighted.scene(), weighted.mis());
  Comparison comparison;
  for (size_t i = 0; i < std::min(cached.contributions.size(), whole.contributions.size()); ++i) {
    const Contribution &c = cached.contributions[i], &one = whole.contributions[i];
    if (c.strategy != one.strategy || c.path.edges() != one.path.edges()) {
      ADD_FAILURE() << "the walks differ at " << i << ": " << describe(c) << " / " << describe(one);
      break;
    }
    const StrategyDensities densities = reference.of(c.path);
    const double expected = (c.merge ? densities.merge : densities.connect)[c.strategy] / densities.sum();
    const double error = std::abs(c.value / one.value - expected);
    comparison.count(c);
    comparison.largest = std::max(comparison.largest, error);
    if (error <= tolerance) continue;
    if (++comparison.apart <= 5) {
      ADD_FAILURE() << describe(c) << ": weight " << c.value / one.value << ", from scratch " << expected;
    }
  }
  return comparison;
}

struct WeightCase {
  Room room;
  Strategies strategies;
};

std::string nameOf(const WeightCase& c) {
  return std::string(kRoomLightNames[static_cast<size_t>(c.room.light)]) +
         (c.room.materials == RoomMaterials::mixed ? "_mixed" : "_diffuse") +
         (c.room.tiltedNormals ? "_tilted_" : "_") + c.strategies.name;
}

std::vector<WeightCase> weightCases() {
  std::vector<WeightCase> cases;
  for (size_t light = 0; light < kRoomLightNames.size(); ++light) {
    Room room{.light = static_cast<RoomLight>(light), .width = 32, .height = 24};
    cases.push_back({room, kBptStrategies});
    room.materials = RoomMaterials::mixed;
    room.tiltedNormals = true;
    cases.push_back({room, kVcmStrategies});
    cases.push_back({room, kFirstMerges});
  }
  const Room mixed{
      .light = RoomLight::quad, .materials = RoomMaterials::mixed, .tiltedNormals = true, .width = 32, .height = 24};
  cases.push_back({mixed, kPt});
  cases.push_back({mixed, kBpm});
  return cases;
}

class MisWeightTest : public testing::TestWithParam<WeightCase> {
 protected:
  // Enough of each strategy was seen for the comparison to mean something.
  static void expectAllKinds(const Comparison& c) {
    const MisSettings& mis = GetParam().strategies.mis;
    const bool delta = isDelta(GetParam().room.light);
    if (mis.emission && !delta) {
      EXPECT_GT(c.emission, 10u);
    }
    if (mis.nextEvent) {
      EXPECT_GT(c.nextEvent, 100u);
    }
    if (mis.connect) {
      EXPECT_GT(c.connection, 50u);
    }
    if (mis.camera) {
      EXPECT_GT(c.camera, 30u);
    }
    if (mis.merge) {
      EXPECT_GT(c.merge, 10u);
    }
  }
};

TEST_P(MisWeightTest, isTheOneComputedFromScratch) {
  const Scene scene = roomScene(GetParam().room);
  WalkSettings settings{.lightPaths = 3000, .radius = 0.06};
  const Comparison single = compareWeights<float>(scene, settings, GetParam().strategies.mis, 1e-4);
  expectAllKinds(single);
  settings.precision = Precision::doubled;
  // Largest: 1.5e-5 under the constant light, the same in float. It is the 1e-5 that light paths from the scene's
  // sphere had, times what their density is larger by since they start on its box. All others are at most 1e-5.
  const double tolerance = GetParam().room.light == RoomLight::constant ? 2e-5 : 1e-5;
  const Comparison doubled = compareWeights<double>(scene, settings, GetParam().strategies.mis, tolerance);
  expectAllKinds(doubled);
  RecordProperty("weights", static_cast<int>(single.total() + doubled.total()));
  RecordProperty("largest_float", std::to_string(single.largest));
  RecordProperty("largest_double", std::to_string(doubled.largest));
}

TEST(MisWeight, underParallelRaysIsTheOneComputedFromScratch) {
  Scene scene = roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = 32, .height = 24});
  scene.sensor.kind = Sensor::Kind::orthographic;
  WalkSettings settings{.lightPaths = 3000, .radius = 0.06};
  const Comparison single = compareWeights<float>(scene, settings, kVcmStrategies.mis, 1e-4);
  EXPECT_GT(std::min({single.nextEvent, single.connection, single.camera, single.merge}), 30u);
  settings.precision = Precision::doubled;
  EXPECT_GT(compareWeights<double>(scene, settings, kVcmStrategies.mis, 1e-5).camera, 30u);
}

INSTANTIATE_TEST_SUITE_P(Engine, MisWeightTest, testing::ValuesIn(weightCases()),
                         [](const auto& instance) { return nameOf(instance.param); });

}  // namespace
}  // namespace wavecrest
