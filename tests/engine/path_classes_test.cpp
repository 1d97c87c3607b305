// Verdicts on path classes: by the rules, by the study's choices of reference, and by what rendering shows.
#include "engine/inspect/path_classes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// ---- rules ----------------------------------------------------------------------------------------------------------

// What METHODS.md says of each method, as it follows from the stages on its page.
TEST(PathStrategies, followFromTheStages) {
  const PathStrategies bidirectional{.emission = true, .nextEvent = true, .connect = true, .camera = true};
  EXPECT_EQ(strategiesOf(Method::pt), (PathStrategies{.emission = true, .nextEvent = true}));
  EXPECT_EQ(strategiesOf(Method::lt),
            (PathStrategies{.emission = true, .nextEvent = true, .camera = true, .specularViewsOnly = true}));
  EXPECT_EQ(strategiesOf(Method::bpt), bidirectional);
  EXPECT_EQ(strategiesOf(Method::mlt), bidirectional) << "each step takes one of bidirectional path tracing's";
  EXPECT_EQ(strategiesOf(Method::ppm), (PathStrategies{.emission = true, .merge = true, .mergeAtFirstVertex = true}));
  EXPECT_EQ(strategiesOf(Method::bpm), (PathStrategies{.emission = true, .merge = true}));
  PathStrategies all = bidirectional;
  all.merge = true;
  EXPECT_EQ(strategiesOf(Method::vcm), all);
  EXPECT_EQ(strategiesOf(Method::gpt), strategiesOf(Method::pt)) << "a guide draws directions and makes no other paths";
}

TEST(PathStrategies, decideTheWeights) {
  for (const MethodEntry& entry : kMethods) {
    const MethodPage page = entry.page();
    const PathStrategies strategies = strategiesOf(entry.method);
    const MisSettings camera = weightsOf(page, Walk::camera);
    EXPECT_EQ(camera.nextEvent, strategies.nextEvent) << entry.name;
    EXPECT_EQ(camera.connect, strategies.connect) << entry.name;
    EXPECT_EQ(camera.merge, strategies.merge) << entry.name;
    EXPECT_EQ(camera.mergeWeights, !strategies.mergeAtFirstVertex) << entry.name;
    // Merging alone leaves emission only what it cannot make, and light tracing's walks make different paths.
    EXPECT_EQ(camera.emission, strategies.nextEvent) << entry.name;
    EXPECT_EQ(camera.camera, strategies.camera && !strategies.specularViewsOnly) << entry.name;
    EXPECT_EQ(camera.powerHeuristic,
              entry.method == Method::pt || entry.method == Method::lt || entry.method == Method::gpt)
        << entry.name;
    EXPECT_EQ(isBidirectional(page), entry.method != Method::pt && entry.method != Method::gpt) << entry.name;
  }
  const MisSettings light = weightsOf(lightTracing(), Walk::light);
  EXPECT_FALSE(light.emission || light.nextEvent || light.connect || light.merge);
  EXPECT_TRUE(light.camera);
  const MisSettings recorded = weightsOf(pathSpaceMetropolis(), Walk::camera);
  EXPECT_FALSE(recorded.emission || recorded.nextEvent || recorded.connect || recorded.camera || recorded.merge);
  EXPECT_FALSE(isBidirectional(primarySampleSpace()));
}

// A scene in which everything sees everything, and nothing is hard.
SceneLinks allLinks() {
  SceneLinks links;
  links.fromLight = links.between = {{{true, true}, {true, true}}};
  links.fromEye = {true, true};
  links.eyeMeetsLight = true;
  links.lightSolidAngle = 1;
  links.lightCoverage = links.cameraCoverage = 1;
  return links;
}

const PathClass* find(const PathClassTable& table, const std::string& signature) {
  for (const PathClass& pathClass : table.classes) {
    if (pathClass.signature == signature) return &pathClass;
  }
  return nullptr;
}

// "pt lt ..." of the methods with this verdict.
std::string methodsWith(const PathClassTable& table, const std::string& signature, Verdict verdict) {
  const PathClass* const pathClass = find(table, signature);
  if (pathClass == nullptr) return "no such class";
  std::string names;
  for (const MethodEntry& entry : kMethods) {
    if (table.verdict(*pathClass, entry.method) == verdict) {
      names += (names.empty() ? "" : " ") + std::string(entry.name);
    }
  }
  return names;
}

TEST(PathClasses, areEighteenWhereEverythingIsLinked) {
  const PathClassTable table = classifyPaths(allLinks());
  EXPECT_EQ(table.classes.size(), 18u);  // ten of extended lights, eight of delta lights
  for (const PathClass& a : table.classes) {
    EXPECT_EQ(a.verdicts.size(), kMethods.size());
    EXPECT_EQ(find(table, a.signature), &a) << a.signature << " stands for one class";
  }
}

// The examples of METHODS 8.1.
TEST(PathClasses, impossibleOnesAreThoseNoStrategyMakes) {
  const PathClassTable table = classifyPaths(allLinks());
  EXPECT_EQ(methodsWith(table, "A D E", Verdict::impossible), "");
  EXPECT_EQ(methodsWith(table, "A S+ E", Verdict::impossible), "");
  EXPECT_EQ(methodsWith(table, "A S+ D E", Verdict::impossible), "");
  EXPECT_EQ(methodsWith(table, "P D E", Verdict::impossible), "");
  EXPECT_EQ(methodsWith(table, "P S+ D E", Verdict::impossible), "pt gpt");
  EXPECT_EQ(methodsWith(table, "P S+ D S+ E", Verdict::impossible), "pt lt bpt mlt gpt");
  EXPECT_EQ(methodsWith(table, "P S+ D D S+ E", Verdict::impossible), "pt lt gpt");
  EXPECT_EQ(find(table, "P S+ E"), nullptr) << "no method shows it";
}

TEST(PathClasses, smallLightsMakeEmissionInefficient) {
  SceneLinks links = allLinks();
  links.lightSolidAngle = 0.01;
  const PathClassTable table = classifyPaths(links);
  EXPECT_EQ(methodsWith(table, "A S+ D E", Verdict::inefficient), "pt gpt");
  EXPECT_EQ(methodsWith(table, "A S+ D S+ E", Verdict::inefficient), "pt lt bpt mlt gpt");
  EXPECT_EQ(methodsWith(table, "A S+ E", Verdict::inefficient), "") << "delta lobes lead there for certain";
  EXPECT_EQ(methodsWith(table, "A D E", Verdict::inefficient), "") << "next event estimation finds it";
}

TEST(PathClasses, glossySurfacesInViewAreInefficientByLightTracingAndFirstMerges) {
  SceneLinks links = allLinks();
  links.eyeSeesGlossy = true;
  EXPECT_EQ(methodsWith(classifyPaths(links), "A D E", Verdict::inefficient), "lt ppm");
}

TEST(PathClasses, lightTracingIsInefficientWhereTheCameraSeesLittleOfTheLight) {
  SceneLinks links = allLinks();
  links.cameraCoverage = 0.001;
  EXPECT_EQ(methodsWith(classifyPaths(links), "A D D E", Verdict::inefficient), "lt");
}

TEST(PathClasses, nextEventIsInefficientForIndirectLightWhereFewPlacesSeeALamp) {
  SceneLinks links = allLinks();
  links.lightCoverage = 0.01;
  links.lightSolidAngle = 0.01;
  const PathClassTable table = classifyPaths(links);
  EXPECT_EQ(methodsWith(table, "A D D E", Verdict::inefficient), "pt gpt");
  EXPECT_EQ(methodsWith(table, "A D E", Verdict::inefficient), "");
}

TEST(PathClasses, connectionsBetweenGlossySurfacesAloneAreInefficient) {
  SceneLinks links = allLinks();
  links.onlyGlossyPairs = true;
  EXPECT_EQ(methodsWith(classifyPaths(links), "P S+ D D S+ E", Verdict::inefficient), "bpt mlt");
}

TEST(PathClasses, areThoseThatLinksAllow) {
  SceneLinks links;
  links.fromLight[1] = {false, true};  // a sun behind water
  links.between = {{{false, true}, {true, false}}};
  links.fromEye = {true, false};
  const PathClassTable table = classifyPaths(links);
  ASSERT_EQ(table.classes.size(), 1u);
  EXPECT_EQ(table.classes[0].signature, "P S+ D E");
}

TEST(PathClasses, haveNoMoreEdgesThanPaths) {
  const std::pair<uint32_t, size_t> cases[] = {{1, 1}, {2, 4}, {3, 10}, {4, 16}, {5, 18}};
  for (const auto& [edges, classes] : cases) {
    EXPECT_EQ(classifyPaths(allLinks(), edges).classes.size(), classes) << edges;
  }
  Scene scene = sceneFile("cornell-mirror", 64, 48);
  scene.defaults.maxDepth = 2;
  const PathClassTable table = classifyPaths(scene);
  EXPECT_NE(find(table, "A D E"), nullptr);
  EXPECT_EQ(find(table, "A S+ D E"), nullptr);
  EXPECT_EQ(table.reference.method, Method::pt);
}

// ---- reference methods ----------------------------------------------------------------------------------------------

// What the study rendered its references by; merging needs a choice between vcm and ppm.
// t = 1 knows lenses and filters, so the share of light vertices in view does not depend on them, but for the few at
// the frame's edge.
TEST(SceneLinks, aLensAFilterAndParallelRaysSeeLightVerticesToo) {
  Scene scene = sceneFile("cornell-diffuse", 64, 48);
  const double pinhole = findLinks(scene).cameraCoverage;
  EXPECT_GT(pinhole, 0.05);
  scene.film.filter = ReconstructionFilter::gaussian;
  scene.sensor.kind = Sensor::Kind::thinlens;
  scene.sensor.apertureRadius = 5;
  scene.sensor.focusDistance = 1000;
  EXPECT_NEAR(findLinks(scene).cameraCoverage, pinhole, 0.1 * pinhole);
  scene.sensor.kind = Sensor::Kind::orthographic;
  scene.sensor.toWorld = {{{278, 0, 0, 278}, {0, 278, 0, 273}, {0, 0, 1, -800}, {0, 0, 0, 1}}};
  EXPECT_GT(findLinks(scene).cameraCoverage, 0.05);
}

TEST(ReferenceMethod, isTheStudysForItsScenes) {
  const auto reference = [](const std::string& scene) { return classifyPaths(sceneFile(scene, 64, 48)).reference; };
  EXPECT_EQ(reference("cornell-diffuse").method, Method::pt);
  EXPECT_EQ(reference("cornell-mirror").method, Method::bpt);
  EXPECT_EQ(reference("cornell-glossy").method, Method::pt);
  EXPECT_EQ(reference("cornell-spheres").method, Method::vcm);
  EXPECT_TRUE(reference("cornell-spheres").biased);
  EXPECT_EQ(reference("lafortune-room").method, Method::bpt);
  EXPECT_EQ(reference("pool-interior").method, Method::lt);
  EXPECT_EQ(reference("veach-door").method, Method::bpt);
}

TEST(ReferenceMethod, saysWhy) {
  const ReferenceChoice choice = classifyPaths(sceneFile("cornell-mirror", 64, 48)).reference;
  EXPECT_FALSE(choice.biased);
  EXPECT_NE(choice.reason.find("A S+ D E"), std::string::npos) << choice.reason;
}

// ---- what rendering shows -------------------------------------------------------------------------------------------

// A point light between a white floor at z = 0 and a mirror at z = 2, with a black screen that keeps its direct light
// from the floor: all light is a caustic, as from a second light at z = 3. The camera looks at the floor (S = false) or
// at the mirror, which shows the floor.
constexpr double kFloorAlbedo = 0.6, kIntensity = 10;
Scene causticScene(bool throughMirror) {
  Scene scene;
  const uint32_t white = addDiffuse(scene, kFloorAlbedo, kFloorAlbedo, kFloorAlbedo),
                 black = addDiffuse(scene, 0, 0, 0);
  addShape(scene, Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, white);
  addShape(scene, Rectangle{{-0.5, -0.5, 0.9}, {1, 0, 0}, {0, 1, 0}}, black);
  Material mirror;
  mirror.kind = Conductor{.perfectMirror = true};
  scene.materials.push_back(mirror);
  addShape(scene, Rectangle{{-5, -5, 2}, {0, 10, 0}, {10, 0, 0}}, 2);  // facing -z
  Emitter light;
  light.kind = PointEmitter{{0, 0, 1}, {kIntensity, kIntensity, kIntensity}};
  scene.emitters.push_back(light);
  setCamera(scene, {2, 0, 1.5}, 40, 48, 48);
  if (throughMirror) {
    scene.sensor.toWorld[0][0] = 1;
    scene.sensor.toWorld[2][2] = 1;
  }
  return scene;
}

// Mean over the image by the formula of the mirrored light, at the centres of a fine grid.
double causticMean(bool throughMirror) {
  const double height = throughMirror ? 2.5 : 1.5;  // of the eye above the floor, on the path of light
  const double half = height * std::tan(20 * std::numbers::pi / 180);
  constexpr int kGrid = 200;
  double sum = 0;
  for (int i = 0; i < kGrid; ++i) {
    for (int k = 0; k < kGrid; ++k) {
      const double x = 2 + half * (2 * (i + 0.5) / kGrid - 1), y = half * (2 * (k + 0.5) / kGrid - 1);
      const double dist2 = x * x + y * y + 9;
      sum += kFloorAlbedo / std::numbers::pi * kIntensity * 3 / (dist2 * std::sqrt(dist2));
    }
  }
  return sum / (kGrid * kGrid);
}

class CausticTest : public testing::TestWithParam<bool> {};

TEST_P(CausticTest, isMadeBySampledMethodsAndByNoOther) {
  const Scene scene = causticScene(GetParam());
  const PathClassTable table = classifyPaths(scene);
  ASSERT_EQ(table.classes.size(), 1u);
  EXPECT_EQ(table.classes[0].signature, GetParam() ? "P S+ D S+ E" : "P S+ D E");
  const double truth = causticMean(GetParam());
  for (const MethodEntry& entry : kMethods) {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.method = entry.method;
    settings.radius = 0.01;
    settings.limits.maxDepth = GetParam() ? 4 : 3;  // the floor is seen again in the mirror's light
    if (table.verdict(table.classes[0], entry.method) == Verdict::impossible) {
      const RgbImage image = render(scene, settings, samples(100, 25));
      EXPECT_EQ(*std::max_element(image.begin(), image.end()), 0.0f) << entry.name;
      continue;
    }
    // 0.6 % of the light paths arrive in view, or 1.7 % through the mirror: of 0.9 million, standard errors of 1.4 %
    // and 0.8 %, which the t test measures; half as much with WAVECREST_THOROUGH. A merge of radius r sees the mean
    // over a disc, r^2 / 8 times the Laplacian too much: of E ~ (x^2 + 9)^(-3/2) at most E / 3, so of the image less
    // than 3e-4 with r = 0.01 x 7.1.
    const SeedMeans seeds = renderSeeds(scene, settings, samples(100, 25));
    const auto difference = [&](size_t seed, size_t i) -> std::optional<double> {
      return seeds.images[seed][i] - truth;
    };
    const TileStatistics statistics = tileStatistics(seeds.width, seeds.mean.size(), difference, 3e-4 * truth);
    EXPECT_LE(statistics.imageT, 7) << entry.name << ": " << statistics.describe();
  }
}
INSTANTIATE_TEST_SUITE_P(PathClasses, CausticTest, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "inMirror" : "inView"; });

// Sunlight through a plate of glass: 0.6 x 0.96^2 in every pixel (the scene's comment), nothing by path tracing.
TEST(PathClasses, sunlightThroughGlassIsThatOfTheFormula) {
  const Scene scene = sceneFile("validation/sun-through-glass", 32, 32);
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.radius = 0.01;
  settings.limits.maxDepth = 4;
  for (const Method method : {Method::lt, Method::bpt, Method::ppm, Method::bpm, Method::vcm}) {
    settings.method = method;
    // One light path in a hundred arrives in view: some 40 in each tile of 8x8 pixels, four times as many with
    // WAVECREST_THOROUGH.
    expectTruth(
        renderSeeds(scene, settings, samples(200, 50)),
        [](uint32_t, uint32_t, size_t) -> std::optional<double> { return 0.55296; }, std::string(toString(method)));
  }
  settings.method = Method::pt;
  const RgbImage image = render(scene, settings, 4);
  EXPECT_EQ(*std::max_element(image.begin(), image.end()), 0.0f);
}

// cornell-mirror's patch on the ceiling is inefficient by pt and sampled by bpt: both converge, pt with more noise.
TEST(PathClasses, inefficientOnesConvergeWithMoreNoise) {
  const Scene scene = sceneFile("cornell-mirror", 96, 72);
  const PathClassTable table = classifyPaths(scene);
  EXPECT_EQ(methodsWith(table, "A S+ D E", Verdict::inefficient), "pt gpt");
  const auto patch = [&](Method method) {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.method = method;
    SeedMeans seeds = renderSeeds(scene, settings, 16);
    std::vector<double> sums(kSeeds, 0.0);
    for (size_t s = 0; s < kSeeds; ++s) {
      for (uint32_t y = 8; y < 12; ++y) {
        for (uint32_t x = 27; x < 40; ++x) sums[s] += seeds.images[s][3 * (y * 96 + x) + 1];
      }
    }
    double mean = 0, squares = 0;
    for (const double sum : sums) mean += sum / kSeeds;
    for (const double sum : sums) squares += (sum - mean) * (sum - mean) / (kSeeds - 1);
    return std::array{mean, std::sqrt(squares / kSeeds)};
  };
  const auto [ptMean, ptError] = patch(Method::pt);
  const auto [bptMean, bptError] = patch(Method::bpt);
  EXPECT_NEAR(ptMean, bptMean, 6 * std::hypot(ptError, bptError));
  EXPECT_GT(ptError, 2 * bptError);
}

}  // namespace
}  // namespace wavecrest
