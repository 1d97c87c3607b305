// Guided path tracing: the image of path tracing, block by block and whatever the guide; the same bits however a render
// is cut; and a guide that learns.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "engine/learn/alias_table.h"
#include "engine/learn/blocks.h"
#include "engine/learn/cell_tree.h"
#include "engine/plan/render_plan.h"
#include "engine/plan/survival.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"
#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/sphere_integral.h"

namespace wavecrest {
namespace {

RenderSettings guideSettings(Method method = Method::gpt) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::automatic});
  settings.method = method;
  settings.roulette = Roulette::efficiency;
  settings.waveSize = 256;
  return settings;
}

// ---- guides that are wrong on purpose -------------------------------------------------------------------------------

struct WrongGuide {
  float bsdfShare;
  std::array<double, kGuideBins> weights;
  bool decidesSurvival =
      false;  // as if light came to every third cell alone, in the eyes of every second run of pixels
};

// One histogram for all cells: a guide that no render would learn.
struct FixedGuide {
  FixedGuide(const SceneView<float>& view, const WrongGuide& wrong, size_t pixels)
      : tree(view.center, view.halfExtent, kCellRoots), share(kCellRoots, wrong.bsdfShare) {
    std::array<uint32_t, kGuideBins> words{};
    makeAliasTable(unitsOf(wrong.weights), words.data());
    for (uint32_t cell = 0; cell < kCellRoots; ++cell) {
      bins.insert(bins.end(), words.begin(), words.end());
      roots.push_back(cell % 3 == 0 ? 4.0f : 0.2f);
    }
    for (size_t run = 0; run * kWorthRun < pixels; ++run) perBrightness.push_back(run % 2 == 0 ? 1.0f : 0.25f);
    guide = {.share = share.data(), .bins = bins.data()};
    if (!wrong.decidesSurvival) return;
    guide.roots = roots.data();
    guide.perBrightness = perBrightness.data();
    guide.decidesSurvival = true;
  }

  void addTo(StageContext<float>& context) const {
    context.learned.cells = &tree.view();
    context.learned.guide = &guide;
  }

  CellTree tree;
  std::vector<float> share, roots, perBrightness;
  std::vector<uint32_t> bins;
  GuideView guide;
};

std::array<double, kGuideBins> histogram(const std::function<double(size_t)>& weight) {
  std::array<double, kGuideBins> weights{};
  for (size_t bin = 0; bin < kGuideBins; ++bin) weights[bin] = weight(bin);
  return weights;
}

// For the camera pass of the plan's page, without a guide.
StageContext<float> contextOf(const RenderPlan<float>& plan, const RenderSettings& settings,
                              const std::optional<SurvivalRule>& rule, const FilmArea& area, StageCounters& counters) {
  StageContext<float> context;
  context.scene = &plan.view;
  context.pixels = area.pixels.data();
  context.limits = settings.limits;
  context.survival = pointerTo(rule);
  context.mis = plan.pipeline.cameraPass().strategies;
  context.counters = &counters;
  context.film = area.window();
  return context;
}

// At each vertex a guide that is wrong makes some samples ten times as bright. A few edges keep the variance finite.
constexpr uint32_t kWrongDepth = 4;

// Images by the page of gpt with this guide in place of a learned one; without one: by path tracing's page.
SeedMeans imagesWith(const Scene& scene, const std::optional<WrongGuide>& wrong, uint64_t iterations,
                     uint64_t firstSeed) {
  const FlushToZero flushToZero;
  RenderSettings settings = guideSettings();
  settings.limits.maxDepth = kWrongDepth;
  if (wrong && wrong->decidesSurvival) settings.limits.rouletteDepth = 1;
  RenderPlan<float> plan = planRender<float>(scene, settings);
  std::optional<FixedGuide> guide;
  if (wrong) guide.emplace(plan.view, *wrong, size_t{scene.film.width} * scene.film.height);
  SeedMeans out;
  out.width = scene.film.width;
  const std::optional<SurvivalRule> rule = survivalRule(settings, Walk::camera);
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    Film film(filmArea(scene.film));
    const size_t pixels = film.area().pixels.size();
    Wave<float> wave(pixels, plan.needs);
    StageCounters counters;
    StageContext<float> context = contextOf(plan, settings, rule, film.area(), counters);
    if (guide) guide->addTo(context);
    for (uint64_t i = 0; i < iterations; ++i) {
      context.sampler = {SamplerKind::independent, firstSeed + seed, i};
      wave.firstPath = 0;
      wave.pathCount = pixels;
      runPass<float>(plan.pipeline.cameraPass(), context, wave, nullptr);
      film.add(wave);
    }
    EXPECT_EQ(counters.nonFinite, 0u);
    out.images.push_back(film.resolve());
  }
  out.mean.assign(out.images[0].size(), 0);
  for (const RgbImage& image : out.images) {
    for (size_t i = 0; i < image.size(); ++i) out.mean[i] += static_cast<double>(image[i]) / kSeeds;
  }
  return out;
}

void expectAnyGuideIsRight(const Scene& scene, const std::string& where) {
  const uint64_t iterations = samples(64, 4);
  const SeedMeans truth = imagesWith(scene, std::nullopt, 2 * iterations, 100);
  const auto check = [&](const WrongGuide& wrong, const char* name) {
    // The less the BSDF draws, the rarer and brighter are its samples, and the more of them a mean takes to be normal.
    // The same is true of survivors.
    const auto more = wrong.decidesSurvival ? 4 : static_cast<uint64_t>(0.5f / wrong.bsdfShare);
    expectSameTruth(truth, imagesWith(scene, wrong, std::max<uint64_t>(more, 1) * iterations, 5000),
                    where + ", " + name);
  };
  const auto uniform = histogram([](size_t) { return 1.0; });
  check({0.5f, uniform}, "uniform");
  check({kLeastBsdfShare, histogram([](size_t bin) { return 1.0 + static_cast<double>(bin * 7919 % 64); })}, "random");
  check({0.9f, histogram([](size_t bin) { return bin == 0 ? 1.0 : 0.0; })}, "one bin");
  check({0.5f, histogram([](size_t bin) { return bin % 2 == 0 ? 0.0 : 1.0; })}, "gaps");
  check({0.5f, uniform, true}, "survival");
}

// A path whose first vertex is worth w < 1 goes on with the probability w: of two edges, so many have second rays.
TEST(Guide, letsPathsGoOnByWhatTheyAreWorth) {
  const FlushToZero flushToZero;
  const Scene scene = roomScene({.light = RoomLight::quad, .width = 64, .height = 64});
  for (const Isa isa : availableIsas()) {
    RenderSettings settings = guideSettings();
    settings.isa = isa;
    settings.limits = {.maxDepth = 2, .rouletteDepth = 1};
    const RenderPlan<float> plan = planRender<float>(scene, settings);
    const WrongGuide wrong{.bsdfShare = 1, .weights = histogram([](size_t) { return 1.0; }), .decidesSurvival = true};
    FixedGuide guide(plan.view, wrong, size_t{scene.film.width} * scene.film.height);
    std::fill(guide.roots.begin(), guide.roots.end(), 2.0f);
    const std::optional<SurvivalRule> rule = survivalRule(settings, Walk::camera);
    const FilmArea area = filmArea(scene.film);
    const size_t pixels = area.pixels.size();
    const auto raysWith = [&](float first, float second) {
      // The first run of pixels, and all others.
      for (size_t run = 0; run < guide.perBrightness.size(); ++run)
        guide.perBrightness[run] = run == 0 ? first : second;
      Wave<float> wave(pixels, plan.needs);
      StageCounters counters;
      StageContext<float> context = contextOf(plan, settings, rule, area, counters);
      guide.addTo(context);
      context.sampler = {SamplerKind::independent, 5, 0};
      wave.pathCount = pixels;
      runPass<float>(plan.pipeline.cameraPass(), context, wave, nullptr);
      return static_cast<double>(counters.raysClosest) - static_cast<double>(pixels);
    };
    const double all = raysWith(100, 100) / 0.95;
    const auto expected = [&](double first, double second) {
      const double runs = static_cast<double>(pixels) / kWorthRun;
      return all * (first / runs + second * (1 - 1 / runs));
    };
    const double slack = 5 * std::sqrt(static_cast<double>(pixels)) / 2;
    EXPECT_NEAR(raysWith(0.2f, 0.2f), expected(0.4, 0.4), slack) << toString(isa);
    EXPECT_NEAR(raysWith(0.4f, 0.05f), expected(0.8, 0.1), slack) << toString(isa);
    EXPECT_NEAR(raysWith(1e-6f, 1e-6f), expected(0.05, 0.05), slack) << toString(isa);
  }
}

TEST(Guide, givesTheRightMeanHoweverWrongItIs) {
  expectAnyGuideIsRight(sceneFile("validation/quad-over-plane", 16, 16), "a lamp over a plane");
  expectAnyGuideIsRight(sceneFile("cornell-spheres", 24, 24), "mirror and glass");
  for (const RoomLight light : {RoomLight::envmap, RoomLight::spot, RoomLight::sphere}) {
    expectAnyGuideIsRight(
        roomScene(
            {.light = light, .materials = RoomMaterials::rough, .tiltedNormals = true, .width = 24, .height = 16}),
        std::string("rough surfaces under ") + std::string(kRoomLightNames[static_cast<size_t>(light)]));
  }
  expectAnyGuideIsRight(
      roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = 24, .height = 16}),
      "mirror, glass and plastic");
}

TEST(Guide, givesTheRightMeanOnFeatures) {
  for (const char* const name : {"roughdielectric", "roughplastic", "plastic", "mask", "principled", "thindielectric",
                                 "blendbsdf", "normalmap", "instance", "thinlens", "envmap"}) {
    expectAnyGuideIsRight(sceneFile(std::string("features/") + name, 16, 16), name);
  }
}

// ---- renders --------------------------------------------------------------------------------------------------------

// The sum of samples of a film: the image times its iterations.
std::vector<double> sumOf(const Session& session) {
  std::vector<double> sum;
  const auto iterations = static_cast<double>(session.statistics().iterations);
  for (const float value : session.film().resolve()) sum.push_back(iterations * static_cast<double>(value));
  return sum;
}

// Every block by itself: sums at its end less those at its beginning.
void expectRightBlocks(const Scene& scene, GuideTarget target, const std::string& where) {
  constexpr std::array<uint64_t, 7> kEnds{0, 4, 8, 16, 32, 64, 128};
  const size_t blocks = effort(kEnds.size() - 2, 3);
  const SeedMeans truth = renderSeeds(scene, guideSettings(Method::pt), 2 * kEnds[blocks], 100);
  std::vector<SeedMeans> images(blocks, {.width = scene.film.width, .mean = {}, .error = {}, .images = {}});
  for (size_t seed = 0; seed < kSeeds; ++seed) {
    RenderSettings settings = guideSettings();
    settings.guide = target;
    settings.seed = 7000 + seed;
    const auto session = Session::create(scene, settings);
    std::vector<double> before(size_t{3} * scene.film.width * scene.film.height, 0);
    for (size_t block = 0; block < blocks; ++block) {
      session->renderUntil(kEnds[block + 1], std::nullopt);
      const std::vector<double> after = sumOf(*session);
      RgbImage image;
      for (size_t i = 0; i < after.size(); ++i) {
        image.push_back(
            static_cast<float>((after[i] - before[i]) / static_cast<double>(kEnds[block + 1] - kEnds[block])));
      }
      images[block].images.push_back(image);
      before = after;
    }
  }
  for (size_t block = 0; block < blocks; ++block) {
    images[block].mean.assign(images[block].images[0].size(), 1);
    expectSameTruth(truth, images[block], where + ", up to iteration " + std::to_string(kEnds[block + 1]));
  }
}

TEST(Guide, everyBlockOfARenderIsRight) {
  for (const GuideTarget target : {GuideTarget::radiance, GuideTarget::variance}) {
    const std::string name(kGuideTargetNames[static_cast<size_t>(target)]);
    expectRightBlocks(sceneFile("veach-door", 24, 16), target, "veach-door by " + name);
    expectRightBlocks(sceneFile("cornell-glossy", 24, 24), target, "cornell-glossy by " + name);
    expectRightBlocks(roomScene({.light = RoomLight::quad,
                                 .materials = RoomMaterials::rough,
                                 .tiltedNormals = true,
                                 .width = 24,
                                 .height = 16}),
                      target, "rough surfaces by " + name);
  }
}

// Points of a run complement each other: were a guide learned from some of them, the others would not be free of it.
TEST(Guide, blocksHaveSobolScramblesOfTheirOwn) {
  RenderSettings settings = guideSettings();
  for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent}) {
    settings.sampler = kind;
    std::map<uint64_t, uint64_t> blockOfSeed;
    std::set<uint64_t> blocks;
    for (uint64_t iteration = 0; iteration < 2 * kSobolRun; ++iteration) {
      const uint64_t seed = ownOfBlock(samplerOf(settings, iteration), iteration).seed;
      const uint64_t block = kind == SamplerKind::sobol ? beginOfBlock(iteration) : 0;
      EXPECT_EQ(blockOfSeed.emplace(seed, block).first->second, block) << iteration;
      blocks.insert(block);
    }
    EXPECT_EQ(blockOfSeed.size(), blocks.size()) << "one seed to a block";
  }
}

RgbImage guidedImage(const Scene& scene, uint32_t threads, uint32_t waveSize, uint64_t iterations,
                     SamplerKind sampler = SamplerKind::independent) {
  RenderSettings settings = guideSettings();
  settings.sampler = sampler;
  settings.threads = threads;
  settings.waveSize = waveSize;
  return render(scene, settings, iterations);
}

TEST(Guide, imagesDependOnNeitherThreadsNorWaves) {
  const Scene scene = sceneFile("cornell-glossy", 40, 27);
  const uint64_t iterations = effort(70, 9);
  const RgbImage image = guidedImage(scene, 1, 2048, iterations);
  for (const uint32_t threads : {2u, 7u}) EXPECT_EQ(guidedImage(scene, threads, 2048, iterations), image) << threads;
  for (const uint32_t waveSize : {512u, 1024u, 8192u}) {
    EXPECT_EQ(guidedImage(scene, 2, waveSize, iterations), image) << waveSize;
  }
  EXPECT_EQ(guidedImage(scene, 1, 2048, 9, SamplerKind::sobol), guidedImage(scene, 2, 512, 9, SamplerKind::sobol));
}

TEST(Guide, goesOnInTheMiddleOfABlock) {
  const Scene scene = sceneFile("cornell-glossy", 40, 27);
  const RgbImage image = guidedImage(scene, 2, 512, 29);
  for (const uint64_t stop : {1u, 11u, 16u, 23u}) {
    RenderSettings settings = guideSettings();
    const auto first = Session::create(scene, settings);
    first->renderUntil(stop, std::nullopt);
    settings.threads = 3;
    settings.waveSize = 1000;
    const auto second = Session::create(scene, settings);
    restoreState(*second, savedState(*first));
    EXPECT_EQ(savedState(*second).size(), savedState(*first).size());
    second->renderUntil(29, std::nullopt);
    EXPECT_EQ(second->film().resolve(), image) << stop;
  }
}

// The worth of paths is learned, and saved in checkpoints, only if Russian roulette uses it.
TEST(Guide, learnsNoWorthWhereRouletteGoesByAlbedo) {
  const Scene scene = sceneFile("cornell-glossy", 40, 27);
  const auto stateSize = [&](Roulette roulette) {
    RenderSettings settings = guideSettings();
    settings.roulette = roulette;
    return savedState(*Session::create(scene, settings)).size();
  };
  EXPECT_LT(stateSize(Roulette::albedo), stateSize(Roulette::efficiency));
  EXPECT_EQ(stateSize(Roulette::albedo), stateSize(Roulette::throughput));
}

TEST(Guide, thatIsOffLeavesPathTracing) {
  const Scene scene = sceneFile("cornell-glossy", 40, 27);
  RenderSettings settings = guideSettings(), plain = guideSettings(Method::pt);
  settings.guide = GuideTarget::off;
  settings.sampler = bestSampler(settings);
  plain.sampler = bestSampler(plain);
  EXPECT_EQ(render(scene, settings, 20), render(scene, plain, 20));
  const auto session = Session::create(scene, settings);
  EXPECT_FALSE(session->statistics().guide);
  EXPECT_EQ(session->memoryPlan().use.learned, 0u);
}

TEST(Guide, learnsWithinItsMemory) {
  const Scene scene = sceneFile("veach-door", 40, 30);
  RenderSettings settings = guideSettings();
  settings.guideBytes = 100'000;
  const auto session = Session::create(scene, settings);
  session->renderUntil(effort(100, 40), std::nullopt);
  const GuideStatistics guide = *session->statistics().guide;
  EXPECT_GT(guide.folds, 4u);
  EXPECT_GT(guide.cells, kCellRoots);
  EXPECT_GT(guide.taught, 0u);
  EXPECT_GT(guide.guidedShare, 0.05);
  EXPECT_EQ(guide.saturated, 0u);
  EXPECT_LE(guide.bytes, settings.guideBytes);
  EXPECT_EQ(guide.bytes, session->memoryPlan().use.learned);
}

// The pixel looks at the back wall, which is lit from the front.
TEST(Guide, tellsWhatItHasLearnedWhereAPixelLooks) {
  const Scene scene = roomScene({.light = RoomLight::quad, .width = 24, .height = 16});
  const auto session = Session::create(scene, guideSettings());
  EXPECT_EQ(session->learnedDirections(12, 8)->guidedShare, 0) << "before there are paths";
  session->renderUntil(effort(256, 64), std::nullopt);
  const std::optional<LearnedDirections> learned = session->learnedDirections(12, 8);
  ASSERT_TRUE(learned);
  EXPECT_GT(learned->guidedShare, 0);
  EXPECT_LT(learned->cell, learned->cells);
  constexpr int kRows = 64;
  const auto inFront = [&](const auto& direction) { return direction[2] > 0 ? learned->density(direction) : 0; };
  const double whole = sphereIntegral(kRows, [&](const auto& direction) { return learned->density(direction); });
  const double front = sphereIntegral(kRows, inFront);
  EXPECT_NEAR(whole, 1, 0.02);
  EXPECT_GT(front, 0.9);
  // Methods that learn nothing have nothing to tell.
  EXPECT_FALSE(Session::create(scene, guideSettings(Method::pt))->learnedDirections(12, 8));
}

TEST(Guide, tellsWhereAPixelLooksAlsoIfMostOfItsPathsSeeNothing) {
  Scene scene = roomScene({.light = RoomLight::quad, .width = 8, .height = 8});
  for (Material& material : scene.materials) material.opacity = TexturedFloat{0.3};
  const auto session = Session::create(scene, guideSettings());
  for (uint32_t y = 0; y < 8; ++y) {
    for (uint32_t x = 0; x < 8; ++x) EXPECT_TRUE(session->learnedDirections(x, y)) << x << ',' << y;
  }
}

TEST(Guide, rendersWhereNothingCanBeLearned) {
  // One pixel, delta lobes alone, and no light at all.
  const Scene pixel = sceneFile("cornell-diffuse", 1, 1);
  const float one = render(pixel, guideSettings(), 4000)[0], other = render(pixel, guideSettings(Method::pt), 4000)[0];
  EXPECT_NEAR(one, other, 0.2 * other);
  for (Scene scene : {sceneFile("features/conductor", 16, 16), sceneFile("cornell-diffuse", 16, 16)}) {
    scene.emitters.clear();
    for (Shape& shape : scene.shapes) shape.emitter = kNone;
    for (const float value : render(scene, guideSettings(), 20)) EXPECT_EQ(value, 0);
  }
}

}  // namespace
}  // namespace wavecrest
