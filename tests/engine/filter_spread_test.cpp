// Camera samples that are spread over the filter's footprint: against the formula written out, against samples that go
// to one pixel, and the same bits for any threads, waves and interruptions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/film/spread_sums.h"
#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/test_scenes.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

CameraView cameraOf(FilterKind filter, double scale) {
  CameraView camera;
  camera.filter = filter;
  camera.filterScale = scale;
  return camera;
}

// ---- against the formula --------------------------------------------------------------------------------------------

// h of kernels/columns/filter_spread.h along one axis, up to a factor.
double filterAt(const CameraView& camera, double x) {
  if (camera.filter == FilterKind::tent) return std::max(0.0, 1 - std::abs(x) / camera.filterScale);
  if (std::abs(x) > 4.5 * camera.filterScale) return 0;
  return std::exp(-0.5 * x * x / (camera.filterScale * camera.filterScale));
}

template <class S>
const auto& spreadStages(Isa isa) {
  constexpr Precision kPrecision = sizeof(S) == 8 ? Precision::doubled : Precision::floating;
  return findStages<S>(isa, kPrecision, chooseSpecialization(0, kPrecision));
}

struct FilmCase {
  uint32_t x0, y0, width, height;
};

// Every sample to every pixel, in double.
template <class S>
std::vector<double> spreadByFormula(const CameraView& camera, const FilmArea& area, const Wave<S>& wave,
                                    std::span<const FilterPlace> places) {
  const auto axis = [&](double raster, uint32_t size) {
    std::vector<double> weights(size);
    double sum = 0;
    for (uint32_t i = 0; i < size; ++i) sum += weights[i] = filterAt(camera, raster - i - 0.5);
    for (double& weight : weights) weight = sum > 0 ? weight / sum : 0;
    return weights;
  };
  std::vector<double> image(3 * size_t{area.width} * area.height);
  for (size_t i = 0; i < area.pixels.size(); ++i) {
    const uint32_t x = (area.pixels[i] & 0xffffu) - area.x0, y = (area.pixels[i] >> 16) - area.y0;
    for (size_t k = 0; k < places.size(); ++k) {
      const auto wx = axis(x + places[k].x, area.width), wy = axis(y + places[k].y, area.height);
      const size_t lane = i * places.size() + k;
      for (size_t j = 0; j < image.size() / 3; ++j) {
        const double weight = wx[j % area.width] * wy[j / area.width] / static_cast<double>(places.size());
        image[3 * j] += weight * wave.radiance.red[lane];
        image[3 * j + 1] += weight * wave.radiance.green[lane];
        image[3 * j + 2] += weight * wave.radiance.blue[lane];
      }
    }
  }
  return image;
}

template <class S>
void expectTheFormula(Isa isa, const CameraView& camera, const FilmCase& film, double tolerance) {
  const FilmArea area = FilmArea::make(film.x0, film.y0, film.width, film.height);
  // The centre of a pixel, one of its corners, and samples in the filter's tail, which may lie pixels away.
  const double tail = (camera.filter == FilterKind::tent ? 0.99 : 5.4) * camera.filterScale;
  const std::vector<FilterPlace> places{{0.5, 0.5}, {0.5 - tail, 0.5 + tail}, {0.5 + tail, 0.3}, {0.0, 0.9999}};
  Wave<S> wave(static_cast<uint32_t>(places.size() * area.pixels.size()), ColumnNeeds{});
  wave.pathCount = places.size() * area.pixels.size();
  wave.iterationBits = 2;
  std::mt19937 random(7);
  std::exponential_distribution<S> value(1);
  for (size_t lane = 0; lane < wave.pathCount; ++lane) {
    wave.radiance.red[lane] = value(random);
    wave.radiance.green[lane] = value(random);
    wave.radiance.blue[lane] = value(random);
  }
  SpreadSums sums(camera, area);
  EXPECT_EQ(sums.add(wave, places, spreadStages<S>(isa).spreadSamples), 0u);
  const std::vector<double> image = sums.resolve(std::vector<uint64_t>(area.pixels.size(), places.size()));
  const std::vector<double> expected = spreadByFormula(camera, area, wave, places);
  for (size_t i = 0; i < image.size(); ++i) {
    ASSERT_NEAR(image[i], expected[i], tolerance * (1 + expected[i]))
        << "value " << i << " of " << film.width << "x" << film.height << ", scale " << camera.filterScale;
  }
}

using SpreadSumsTest = IsaTest;
WAVECREST_TEST_EVERY_ISA(SpreadSumsTest);

// Films of less than a tile, of a tile, of tiles and parts of them, and a crop.
TEST_P(SpreadSumsTest, areTheFormulaInFloatAndDouble) {
  const FilmCase films[] = {{0, 0, 1, 1}, {0, 0, 16, 16}, {0, 0, 17, 33}, {5, 3, 40, 9}, {0, 0, 1, 50}};
  for (const CameraView& camera :
       {cameraOf(FilterKind::gaussian, 0.5), cameraOf(FilterKind::gaussian, 1), cameraOf(FilterKind::gaussian, 0.2),
        cameraOf(FilterKind::tent, 1), cameraOf(FilterKind::tent, 2.7), cameraOf(FilterKind::tent, 0.4)}) {
    for (const FilmCase& film : films) {
      // Weights are float: 11 taps of relative error 2^-23 along each axis.
      expectTheFormula<float>(GetParam(), camera, film, 3e-6);
      expectTheFormula<double>(GetParam(), camera, film, 3e-6);
    }
  }
}

TEST_P(SpreadSumsTest, samplesThatAreNotFiniteAreBlackAndCounted) {
  const FilmArea area = FilmArea::make(0, 0, 20, 20);
  Wave<float> wave(400, ColumnNeeds{});
  wave.pathCount = 400;
  for (size_t lane = 0; lane < 400; ++lane) {
    wave.radiance.red[lane] = wave.radiance.green[lane] = wave.radiance.blue[lane] = 1;
  }
  wave.radiance.green[17] = std::nanf("");
  wave.radiance.red[300] = HUGE_VALF;
  SpreadSums sums(cameraOf(FilterKind::tent, 1), area);
  const FilterPlace centre;
  EXPECT_EQ(sums.add(wave, {&centre, 1}, spreadStages<float>(GetParam()).spreadSamples), 2u);
  const std::vector<double> image = sums.resolve(std::vector<uint64_t>(400, 1));
  for (size_t i = 0; i < 1200; ++i) EXPECT_TRUE(image[i] == 0 || std::abs(image[i] - 1) < 1e-6) << image[i];
}

// Spreads a tile by a tent of radius 1, at (0.5, 1.49): the taps reach the last row of the tile's sums, and other tiles
// have their sums behind it. All sums begin as -0, which adding a zero would turn into 0.
template <class S>
void expectOnlyReachedSums(Isa isa) {
  const SpreadAxis x{.first = 1, .taps = 3, .weight = {0, 1, 0}, .scale = {1}};
  const SpreadAxis y{.first = 2, .taps = 3, .weight = {0, 0.51f, 0.49f}, .scale = {1}};
  constexpr size_t kRow = kFilmTile + 4, kPlane = kRow * kRow, kReached = kFilmTile + 2;
  const std::vector<S> ones(kTilePixels, 1);
  std::vector<uint8_t> place(kTilePixels);
  for (size_t i = 0; i < place.size(); ++i) place[i] = static_cast<uint8_t>(i);
  std::vector<double> sums(3 * kPlane + 64, -0.0);
  const TileSamples<S> samples{.red = ones.data(),
                               .green = ones.data(),
                               .blue = ones.data(),
                               .stride = 1,
                               .count = kTilePixels,
                               .place = place.data()};
  EXPECT_EQ(spreadStages<S>(isa).spreadSamples(samples, x, y, {sums.data(), kRow, kPlane}), 0u);
  for (size_t i = 0; i < sums.size(); ++i) {
    const size_t row = i % kPlane / kRow - y.first, column = i % kRow - x.first;  // before it they wrap
    const bool reached = i < 3 * kPlane && row < kReached && column < kReached;
    ASSERT_EQ(std::signbit(sums[i]), !reached) << i;
  }
}

TEST_P(SpreadSumsTest, areOnlyWrittenWhereTheFilterReaches) {
  expectOnlyReachedSums<float>(GetParam());
  expectOnlyReachedSums<double>(GetParam());
}

// Those of FilterKind::box reach their own pixel alone, and very wide ones would be margin for the most part.
TEST(CanSpread, neitherBoxesNorVeryWideFilters) {
  EXPECT_FALSE(canSpread(cameraOf(FilterKind::box, 0)));
  EXPECT_TRUE(canSpread(cameraOf(FilterKind::tent, 4.5)));
  EXPECT_FALSE(canSpread(cameraOf(FilterKind::tent, 4.6)));
  EXPECT_TRUE(canSpread(cameraOf(FilterKind::gaussian, 1)));
  EXPECT_FALSE(canSpread(cameraOf(FilterKind::gaussian, 1.1)));
}

// ---- whole renders --------------------------------------------------------------------------------------------------

Scene filteredScene(uint32_t width, uint32_t height, ReconstructionFilter filter = ReconstructionFilter::gaussian) {
  Scene scene = sceneFile("cornell-diffuse", width, height);
  scene.film.filter = filter;
  scene.film.filterRadius = 1;  // of a tent
  return scene;
}

struct SpreadCase {
  Method method;
  SamplerKind sampler;
  ReconstructionFilter filter = ReconstructionFilter::gaussian;
};

class SpreadRenderTest : public testing::TestWithParam<SpreadCase> {
 protected:
  RenderSettings settings(uint32_t threads = 1, uint32_t waveSize = 256) const {
    RenderSettings settings = settingsFor({Precision::floating, GetParam().sampler, Accel::automatic});
    settings.method = GetParam().method;
    settings.metropolis.chains = 500;
    settings.metropolis.bootstrapSamples = 4000;
    settings.threads = threads;
    settings.waveSize = waveSize;
    settings.seed = 5;
    return settings;
  }
  // Neither side is a multiple of a tile, nor the number of pixels one of any size of waves.
  const Scene scene_ = filteredScene(40, 27, GetParam().filter);
  static constexpr uint64_t kIterations = 19;
};

TEST_P(SpreadRenderTest, threadsAndWavesChangeNoBit) {
  const RgbImage expected = render(scene_, settings(), kIterations);
  for (const uint32_t threads : {1u, 2u, 3u}) {
    for (const uint32_t waveSize : {16u, 1000u, 4096u}) {
      EXPECT_EQ(expected, render(scene_, settings(threads, waveSize), kIterations)) << threads << ", " << waveSize;
    }
  }
}

// Sessions that stop anywhere, save their state, and go on in others.
TEST_P(SpreadRenderTest, interruptionsChangeNoBit) {
  const auto session = [&](uint32_t threads, uint32_t waveSize) {
    return Session::create(scene_, settings(threads, waveSize));
  };
  std::vector<unsigned char> state = savedState(*session(1, 256));
  for (uint32_t stop = 0; stop < 12; ++stop) {
    const auto part = session(1 + stop % 3, stop % 2 == 0 ? 300 : 2048);
    restoreState(*part, state);
    part->renderUntil(kIterations, part->progressSeconds() + 5e-4);
    state = savedState(*part);
  }
  const auto last = session(2, 1024);
  restoreState(*last, state);
  last->renderUntil(kIterations, std::nullopt);
  EXPECT_EQ(last->film().resolve(), render(scene_, settings(), kIterations));
}

INSTANTIATE_TEST_SUITE_P(Engine, SpreadRenderTest,
                         testing::Values(SpreadCase{Method::pt, SamplerKind::independent},
                                         SpreadCase{Method::pt, SamplerKind::sobol},
                                         SpreadCase{Method::lt, SamplerKind::independent},
                                         SpreadCase{Method::bpt, SamplerKind::independent},
                                         SpreadCase{Method::mlt, SamplerKind::independent},
                                         SpreadCase{Method::pt, SamplerKind::sobol, ReconstructionFilter::tent},
                                         SpreadCase{Method::lt, SamplerKind::independent, ReconstructionFilter::tent}),
                         [](const auto& instance) {
                           return std::string(toString(instance.param.method)) + "_" +
                                  std::string(toString(instance.param.sampler)) + "_" +
                                  std::string(kFilterNames[static_cast<size_t>(instance.param.filter)]);
                         });

// The same image as of samples that go to one pixel each, up to the film's edge, and less noise.
TEST(SpreadRenders, expectTheSampledImageWithLessNoise) {
  for (const ReconstructionFilter filter : {ReconstructionFilter::gaussian, ReconstructionFilter::tent}) {
    const Scene scene = filteredScene(20, 12, filter);
    RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::automatic});
    const SeedMeans spread = renderSeeds(scene, settings, samples(64, 32));
    settings.filterMode = FilterMode::sample;
    const SeedMeans sampled = renderSeeds(scene, settings, samples(64, 32), 2000);
    expectSameTruth(spread, sampled, std::string(kFilterNames[static_cast<size_t>(filter)]));
    double spreadVariance = 0, sampledVariance = 0;
    for (size_t i = 0; i < spread.error.size(); ++i) {
      spreadVariance += spread.error[i] * spread.error[i];
      sampledVariance += sampled.error[i] * sampled.error[i];
    }
    // The integral of the filter's square is 1 / 3.1 for the Gaussian, 1 / 2.25 for the tent; variances scatter by 5 %.
    EXPECT_LT(spreadVariance, 0.55 * sampledVariance);
  }
}

// A film of one pixel has nowhere to spread to: the weight of each sample is one, whatever the filter.
TEST(SpreadRenders, ofOnePixelAreTheSampledOnes) {
  const Scene scene = filteredScene(1, 1);
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::automatic});
  const SeedMeans spread = renderSeeds(scene, settings, 256);
  settings.filterMode = FilterMode::sample;
  expectSameTruth(spread, renderSeeds(scene, settings, 256, 2000), "one pixel");
}

}  // namespace
}  // namespace wavecrest
