// Numbers of a render that the command line would refuse are refused by the library as well.
#include "library/render_settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "library/errors.h"
#include "library/option_ranges.h"
#include "tests/refusal.h"

namespace wavecrest {
namespace {

std::string refusalOfRender(const api::RenderOptions& options) {
  return refusalOf<UsageError>([&] { renderSettings(options, Scene()); });
}

TEST(RenderSettings, numbersOutOfRangeAreRefusedByName) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::pair<api::RenderOptions, const char*> cases[] = {
      {{.threads = 4097}, "--threads 4097: expected a number from 1 to 4096"},
      {{.maxDepth = -7}, "--max-depth -7: expected a number from 1 to 4095, or -1"},
      {{.maxDepth = 4096}, "--max-depth 4096: expected a number from 1 to 4095, or -1"},
      {{.rrDepth = -3}, "--rr-depth -3: expected a number from 1 to 2147483647"},
      {{.wave = 0}, "--wave 0: expected a number from 16 to 1048576"},
      {{.method = "vcm", .radius = nan}, "--radius nan: expected a number from 1e-06 to 10, or 0"},
      {{.method = "vcm", .radius = -0.05}, "--radius -0.05: expected a number from 1e-06 to 10, or 0"},
      {{.method = "vcm", .radiusAlpha = -5}, "--radius-alpha -5: expected a number from 0 to 1"},
      {{.method = "vcm", .lightPaths = kMostPaths + uint64_t{1}},
       "--light-paths 268435457: expected a number from 1 to 268435456"},
      {{.method = "bpt", .connectionRoulette = infinity}, "--connection-roulette inf: expected a number from 0 to 100"},
      {{.method = "mlt", .chains = 0}, "--chains 0: expected a number from 1 to 16777216"},
      {{.method = "mlt", .bootstrap = 0}, "--bootstrap 0: expected a number from 1 to 268435456"},
      {{.method = "mlt", .restart = (1u << 24) + 1}, "--restart 16777217: expected a number from 1 to 16777216"},
  };
  for (const auto& [options, expected] : cases) EXPECT_EQ(refusalOfRender(options), expected);
  // Inspections take the options of all methods.
  EXPECT_EQ(refusalOf<UsageError>([] { inspectionSettings({.chains = 0}, Scene()); }),
            "--chains 0: expected a number from 1 to 16777216");
}

TEST(RenderSettings, endsOfRangesAndDefaultsAreTaken) {
  const auto accepts = [](const api::RenderOptions& options) { renderSettings(options, Scene()); };
  EXPECT_NO_THROW(accepts({}));
  EXPECT_NO_THROW(accepts({.maxDepth = -1}));
  EXPECT_NO_THROW(accepts({.threads = 4096, .maxDepth = kDepthRange.most, .rrDepth = 1, .wave = 16}));
  EXPECT_NO_THROW(accepts({.method = "vcm", .radius = 1e-6, .radiusAlpha = 1, .lightPaths = kMostPaths}));
  EXPECT_NO_THROW(accepts({.method = "mlt", .chains = 1, .bootstrap = 1, .restart = 1}));
}

TEST(RenderSettings, theRadiusIsLeftToTheImageUnlessItIsGiven) {
  EXPECT_FALSE(renderSettings({.method = "vcm"}, Scene()).radius);
  EXPECT_EQ(renderSettings({.method = "vcm", .radius = 0.001}, Scene()).radius, 0.001);
}

TEST(RenderSettings, theSamplerIsTheBestOfTheMethodUnlessItIsChosen) {
  // Trials take Sobol points where they serve the method that they choose.
  for (const char* method : {"pt", "bpt", "vcm", "evcm", "gpt"}) {
    EXPECT_EQ(renderSettings({.method = method}, Scene()).sampler, SamplerKind::sobol) << method;
  }
  for (const char* method : {"lt", "ppm", "bpm", "mlt"}) {
    EXPECT_EQ(renderSettings({.method = method}, Scene()).sampler, SamplerKind::independent) << method;
  }
  EXPECT_EQ(renderSettings({.method = "gpt", .guide = "radiance"}, Scene()).sampler, SamplerKind::independent);
  EXPECT_EQ(renderSettings({.method = "gpt", .guide = "off"}, Scene()).sampler, SamplerKind::sobol) << "path tracing";
  EXPECT_EQ(renderSettings({.method = "pt", .sampler = "independent"}, Scene()).sampler, SamplerKind::independent);
  EXPECT_EQ(renderSettings({.method = "ppm", .sampler = "sobol"}, Scene()).sampler, SamplerKind::sobol);
}

TEST(RenderSettings, rouletteIsEfficientUnlessItIsChosen) {
  EXPECT_EQ(renderSettings({}, Scene()).roulette, Roulette::efficiency);
  EXPECT_EQ(renderSettings({.roulette = "throughput"}, Scene()).roulette, Roulette::throughput);
  EXPECT_EQ(renderSettings({.method = "vcm", .roulette = "albedo"}, Scene()).roulette, Roulette::albedo);
  EXPECT_NE(refusalOfRender({.roulette = "luck"}).find("throughput, albedo, efficiency"), std::string::npos);
}

TEST(RenderSettings, rouletteDepthIsRefusedWhereNoWalkEndsByRoulette) {
  EXPECT_EQ(refusalOfRender({.method = "mlt", .rrDepth = 3}),
            "--rr-depth: mmlt ends no walk by roulette; expected --mlt pssmlt");
  EXPECT_EQ(refusalOfRender({.method = "mlt", .rrDepth = 3, .mlt = "pathspace"}),
            "--rr-depth: pathspace ends no walk by roulette; expected --mlt pssmlt");
  EXPECT_NO_THROW(renderSettings({.method = "mlt", .rrDepth = 3, .mlt = "pssmlt"}, Scene()));
  // What the scene says, in its file or again by the option.
  Scene scene;
  scene.defaults.rrDepth = 3;
  EXPECT_NO_THROW(renderSettings({.method = "mlt"}, scene));
  EXPECT_NO_THROW(renderSettings({.method = "mlt", .rrDepth = 3}, scene));
}

TEST(RenderSettings, vcmMergesAtFirstVerticesUnlessItIsToldOtherwise) {
  EXPECT_EQ(renderSettings({.method = "vcm"}, Scene()).mergeVertices, MergeVertices::first);
  EXPECT_EQ(renderSettings({.method = "vcm", .mergeVertices = "all"}, Scene()).mergeVertices, MergeVertices::all);
}

}  // namespace
}  // namespace wavecrest
