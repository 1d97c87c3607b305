// Each strategy by itself (METHODS 10.2): for a fixed number of edges every (s, t) and every merge makes the same image
// without weights, and the weighted images of all strategies add up to it.
#include <gtest/gtest.h>

#include <map>

#include "tests/effort.h"
#include "tests/engine/bidirectional_walk.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"
#include "tests/kernels/stage_waves.h"

namespace wavecrest {
namespace {

constexpr uint32_t kLongest = 5;  // edges
constexpr double kRadius = 0.03;  // of merging, relative to the scene's

struct StrategyKey {
  bool merge;
  uint32_t s;  // light vertices, or for merging the index of the merged vertex
  uint32_t k;  // edges
  auto operator<=>(const StrategyKey&) const = default;  // NOLINT(modernize-use-nullptr): it sees the 0 of a < b
};

// Sums up what each strategy adds, pixel by pixel.
class StrategyImages : public WalkVisitor<float> {
 public:
  explicit StrategyImages(BidirectionalWalk<float>& walk) : walk_(walk) {}

  std::map<StrategyKey, RgbImage> images;  // means over the iterations walked

  void run(uint32_t firstIteration, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) walk_.run(firstIteration + i, *this);
    for (auto& [key, image] : images) {
      for (float& value : image) value /= static_cast<float>(count);
    }
  }

  void splats(uint32_t depth, Wave<float>& wave) override {
    walk_.occlude();
    RgbImage& image = imageOf({false, depth + 1, depth + 1});
    const auto paths = static_cast<float>(wave.pathCount);
    for (size_t i = 0; i < wave.splats.size; ++i) {
      float* const pixel = image.data() + 3 * size_t{wave.splats.pixel[i]};
      pixel[0] += wave.splats.red[i] / paths;
      pixel[1] += wave.splats.green[i] / paths;
      pixel[2] += wave.splats.blue[i] / paths;
    }
  }
  void emission(uint32_t depth, Wave<float>& wave) override { add({false, 0, depth}, wave); }
  void nextEvent(uint32_t depth, Wave<float>& wave) override {
    walk_.occlude();
    add({false, 1, depth + 1}, wave);
  }
  void connection(uint32_t lightDepth, uint32_t depth, Wave<float>& wave) override {
    walk_.occlude();
    add({false, lightDepth + 1, lightDepth + depth + 1}, wave);
  }
  void merging(uint32_t depth, Wave<float>& wave, StageContext<float>& context) override {
    if (depth == 1) buildMaps();
    for (uint32_t lightDepth = 1; lightDepth <= maps_.size(); ++lightDepth) {
      if (lightDepth + depth > kLongest) continue;
      context.light.photons = &maps_[lightDepth - 1];
      walk_.stages().merge(context, wave);
      add({true, lightDepth, lightDepth + depth}, wave);
    }
  }

 private:
  RgbImage& imageOf(const StrategyKey& key) {
    RgbImage& image = images[key];
    image.resize(3 * walk_.area().pixels.size());
    return image;
  }
  void add(const StrategyKey& key, Wave<float>& wave) {
    if (key.k > kLongest) return;
    RgbImage& image = imageOf(key);
    for (size_t lane = 0; lane < wave.pathCount; ++lane) {
      const uint32_t pixel = walk_.area().pixels[lane];
      float* const sum = &image[3 * ((pixel >> 16) * walk_.area().width + (pixel & 0xffffu))];
      sum[0] += std::exchange(wave.radiance.red[lane], 0.0f);
      sum[1] += std::exchange(wave.radiance.green[lane], 0.0f);
      sum[2] += std::exchange(wave.radiance.blue[lane], 0.0f);
    }
  }
  // One map for the vertices of each depth, so that merges are known by their length.
  void buildMaps() {
    maps_ = std::vector<PhotonMap<float>>(walk_.light().depths());
    stores_.clear();
    for (uint32_t depth = 1; depth <= walk_.light().depths(); ++depth) {
      LightVertices<float> all = walk_.light().vertices;
      stores_.push_back(std::make_unique<LightStore<float>>(all.size, BidirectionalWalk<float>::kNeeds));
      LightStore<float>& some = *stores_.back();
      some.beginDepth(all.size);
      for (size_t i = walk_.light().firstOf(depth); i < walk_.light().firstOf(depth + 1); ++i) {
        const size_t target = some.vertices.claim(1);
        forEachColumn(all, some.vertices, [&](size_t, auto& from, auto& to) { to[target] = from[i]; });
      }
      LightStore<float>* const stores[1] = {&some};
      maps_[depth - 1].build(stores, walk_.photonGrid(), forEach);
    }
  }

  BidirectionalWalk<float>& walk_;
  std::vector<std::unique_ptr<LightStore<float>>> stores_;
  std::vector<PhotonMap<float>> maps_;
};

struct StrategyCase {
  const char* name;
  RoomLight light;
  bool tiltedNormals = false, lens = false;
  ReconstructionFilter filter = ReconstructionFilter::box;
};

Scene sceneOf(const StrategyCase& c) {
  Scene scene = roomScene({.light = c.light, .tiltedNormals = c.tiltedNormals, .width = 16, .height = 16});
  if (c.lens) {
    scene.sensor.kind = Sensor::Kind::thinlens;
    scene.sensor.apertureRadius = 0.2;
    scene.sensor.focusDistance = 3;
  }
  scene.film.filter = c.filter;
  scene.film.filterRadius = 1;
  return scene;
}

using ImagesOfSeeds = std::map<StrategyKey, std::vector<RgbImage>>;

ImagesOfSeeds walkSeeds(const Scene& scene, const MisSettings& strategies) {
  ImagesOfSeeds out;
  const auto iterations = static_cast<uint32_t>(effort(48, 4));
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    const WalkSettings settings{.lightPaths = 16 * 16,
                                .radius = kRadius,
                                .seed = 100 + seed,
                                .limits = {.maxDepth = kLongest, .rouletteDepth = 64}};
    BidirectionalWalk<float> walk(scene, settings, strategies);
    StrategyImages images(walk);
    images.run(0, iterations);
    for (auto& [key, image] : images.images) out[key].push_back(image);
  }
  return out;
}

// Two lists of images, one per seed: the same mean. allowed: relative difference of the whole images' means that is no
// failure.
void expectSameImages(const std::vector<RgbImage>& a, const std::vector<RgbImage>& b, double allowed,
                      const std::string& where, bool connection = false) {
  ASSERT_EQ(a.size(), kSeeds) << where;
  ASSERT_EQ(b.size(), kSeeds) << where;
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> { return double{a[s][i]} - b[s][i]; };
  double mean = 0;
  for (const RgbImage& image : b) {
    for (const float value : image) mean += value / static_cast<double>(kSeeds * image.size());
  }
  EXPECT_GT(mean, 0) << where;
  // Without a weight, connections of vertices in a corner have no finite variance (1 / d^2): single tiles say nothing.
  if (connection) {
    const TileStatistics statistics = tileStatistics(16, a[0].size(), difference, 2e-6 * mean);
    EXPECT_LE(statistics.imageT, 7) << where << ": " << statistics.describe();
    return;
  }
  if (allowed == 0) {
    expectWithinNoise(tileStatistics(16, a[0].size(), difference, 2e-6 * mean), where);
    return;
  }
  const TileStatistics statistics = tileStatistics(16, a[0].size(), difference, allowed * mean);
  EXPECT_LE(statistics.imageT, 4) << where << ": " << statistics.describe();
}

class StrategyTest : public testing::TestWithParam<StrategyCase> {};

TEST_P(StrategyTest, allMakeTheSameImageAndTheirWeightedSumIsIt) {
  const Scene scene = sceneOf(GetParam());
  const ImagesOfSeeds alone = walkSeeds(scene, kAlone);
  const ImagesOfSeeds weighted =
      walkSeeds(scene, {.emission = true, .nextEvent = true, .connect = true, .camera = true});
  const bool delta = isDelta(GetParam().light);
  for (uint32_t k = 1; k <= kLongest; ++k) {
    const std::string edges = ", k = " + std::to_string(k);
    const uint32_t reference = k == 1 ? 0 : 1;  // next event estimation where there is any
    if (k == 1 && delta) continue;
    const auto& expected = alone.at({false, reference, k});
    std::vector<RgbImage> sum(kSeeds, RgbImage(expected[0].size()));
    for (uint32_t s = 0; s <= (k == 1 ? 0 : k); ++s) {
      const auto& images = alone.at({false, s, k});
      if (s == 0 && delta) {  // a delta light cannot be met
        for (const float value : images[0]) ASSERT_EQ(value, 0.0f);
      } else if (s != reference) {
        expectSameImages(images, expected, 0, "s = " + std::to_string(s) + edges, s >= 2 && s < k);
      }
      for (size_t seed = 0; seed < kSeeds; ++seed) {
        for (size_t i = 0; i < sum[seed].size(); ++i) sum[seed][i] += weighted.at({false, s, k})[seed][i];
      }
    }
    expectSameImages(sum, expected, 0, "weighted sum" + edges);
    // A disc that reaches over the edge of a surface finds too few photons: of the order of radius / size of a wall.
    for (uint32_t i = 1; i < k; ++i) {
      expectSameImages(alone.at({true, i, k}), expected, 0.03, "merge at " + std::to_string(i) + edges);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Engine, StrategyTest,
    testing::Values(StrategyCase{"quad", RoomLight::quad}, StrategyCase{"sphere", RoomLight::sphere},
                    StrategyCase{"shell", RoomLight::shell}, StrategyCase{"point", RoomLight::point},
                    StrategyCase{"spot", RoomLight::spot}, StrategyCase{"directional", RoomLight::directional},
                    StrategyCase{"constant", RoomLight::constant}, StrategyCase{"envmap", RoomLight::envmap},
                    StrategyCase{"projector", RoomLight::projector}, StrategyCase{"tilted", RoomLight::mesh, true},
                    StrategyCase{"lens", RoomLight::quad, false, true},
                    StrategyCase{"tent", RoomLight::quad, false, false, ReconstructionFilter::tent},
                    StrategyCase{"gaussian", RoomLight::quad, false, true, ReconstructionFilter::gaussian}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace wavecrest
