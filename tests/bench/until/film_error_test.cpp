// The error that a film's slices tell of is the one that the film has, as often as its interval says.
#include "bench/until/film_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "bench/until/until.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"
#include "tests/effort.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 32, kHeight = 24;

using Film = std::vector<float>;

RenderSettings settingsOf(const Scene& scene, Method method, uint64_t seed) {
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.method = method;
  settings.seed = seed;
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  settings.radius = 0.01;
  return settings;
}

// The fewest misses that `trials` intervals, of which each misses with probability `miss`, have or exceed with a
// probability below kFalseAlarms. Seeds are fixed: the test fails always or never.
constexpr double kFalseAlarms = 1e-3;
size_t tooManyMisses(size_t trials, double miss) {
  const auto n = static_cast<double>(trials);
  double below = 0;  // probability of fewer than k
  for (size_t k = 0;; ++k) {
    if (1 - below < kFalseAlarms) return k;
    const auto x = static_cast<double>(k);
    below += std::exp(std::lgamma(n + 1) - std::lgamma(x + 1) - std::lgamma(n - x + 1) + x * std::log(miss) +
                      (n - x) * std::log1p(-miss));
  }
}

struct Case {
  const char* name;
  const char* scene;
  Method method;
  double goal;
  SamplerKind sampler = SamplerKind::independent;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class FilmErrorOf : public testing::TestWithParam<Case> {};

// The expectation of a film is the mean of all others, weighted by their iterations; their own error adds m / (n - m)
// to the film's squared one on average.
TEST_P(FilmErrorOf, isWithinItsIntervalAsOftenAsStated) {
  const size_t trials = samples(80, 8);
  LoadOptions options;
  options.filmSize = {kWidth, kHeight};
  const Scene scene = loadScene(findScene(GetParam().scene), options);
  struct Trial {
    Film film;
    ErrorNow now;
  };
  std::vector<Trial> all;
  std::vector<double> sum(size_t{3} * kWidth * kHeight);
  double n = 0;
  for (uint64_t seed = 0; seed < trials; ++seed) {
    RenderSettings settings = settingsOf(scene, GetParam().method, seed);
    settings.sampler = GetParam().sampler;
    settings.iterations = 8000;  // far beyond the goal
    const auto session = Session::create(scene, settings);
    FilmErrorWatch watch;
    const ErrorNow now = watch.renderUntil(*session, settings, GetParam().goal);
    ASSERT_TRUE(now.reached) << "seed " << seed;
    all.push_back({session->film().resolve(), now});
    const auto m = static_cast<double>(now.iterations);
    n += m;
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += m * all.back().film[i];
  }
  size_t misses = 0;
  for (const Trial& trial : all) {
    const auto m = static_cast<double>(trial.now.iterations);
    Film others(sum.size());
    for (size_t i = 0; i < sum.size(); ++i) others[i] = static_cast<float>((sum[i] - m * trial.film[i]) / (n - m));
    const double error = relativeFilmError(trial.film, others, kWidth) * std::sqrt(1 - m / n);
    const Interval interval = trial.now.error->interval;
    misses += error < interval.low || error > interval.high ? 1 : 0;
  }
  RecordProperty("misses", static_cast<int>(misses));
  EXPECT_LT(misses, tooManyMisses(trials, 1 - kIntervalLevel));
}

INSTANTIATE_TEST_SUITE_P(Scenes, FilmErrorOf,
                         testing::Values(Case{"diffusePt", "cornell-diffuse", Method::pt, 0.2},
                                         Case{"mirrorLt", "cornell-mirror", Method::lt, 0.2},
                                         Case{"mirrorVcm", "cornell-mirror", Method::vcm, 0.2},
                                         Case{"doorBpt", "veach-door", Method::bpt, 0.5},
                                         Case{"sobolPt", "cornell-diffuse", Method::pt, 0.03, SamplerKind::sobol},
                                         Case{"sobolBpt", "cornell-diffuse", Method::bpt, 0.03, SamplerKind::sobol}),
                         [](const auto& suite) { return suite.param.name; });

// Slices of a grey film with noise of one size everywhere: N independent samples, K slices. The error's expectation is
// known, and the squared one's standard deviation is sqrt(2 K / ((K - 1) N)) relative to it.
TEST(FilmError, isThatOfEvenNoise) {
  constexpr size_t kSlices = 10, kSamples = size_t{3} * 64 * 64;
  constexpr double kNoise = 0.125;
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal(1, kNoise);
  std::vector<Film> slices(kSlices, Film(kSamples));
  for (Film& slice : slices) {
    for (float& value : slice) value = normal(random);
  }
  const std::optional<FilmError> error = estimateFilmError(slices, 64);
  ASSERT_TRUE(error);
  const double deviation = std::sqrt(2.0 * kSlices / ((kSlices - 1.0) * kSamples));
  EXPECT_NEAR(error->value, kNoise / std::sqrt(double{kSlices}), 4 * 0.5 * deviation * error->value);
  // 0.5 * 1.4 * 2.03 (35 degrees of freedom); the deviation is itself known to some 12 %.
  EXPECT_NEAR(std::log(error->interval.high / error->value), 1.42 * deviation, 0.4 * 1.42 * deviation);
}

TEST(FilmError, isNotToldOfOneSampleThatOutshinesAllOrOfBlackFilms) {
  std::vector<Film> slices(kFewestSlices, Film(size_t{3} * 64 * 64, 0.0f));
  EXPECT_FALSE(estimateFilmError(slices, 64));
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal(1000, 300);
  for (Film& slice : slices) slice[100] = normal(random);
  EXPECT_FALSE(estimateFilmError(slices, 64));
}

TEST(FilmError, isNotToldOfWhatOneSliceAloneHasFound) {
  std::vector<Film> slices(kFewestSlices, Film(size_t{3} * 64 * 64, 0.3f));
  for (size_t i = 0; i < slices[2].size(); i += 7) slices[2][i] = 0.6f;
  EXPECT_FALSE(estimateFilmError(slices, 64));
}

TEST(FilmError, isNoneOfFilmsWithoutVarianceButForTheRoundingOfSlices) {
  std::vector<Film> slices(kFewestSlices, Film(size_t{3} * 64 * 64, 0.3f));
  const std::optional<FilmError> none = estimateFilmError(slices, 64);
  ASSERT_TRUE(none);
  EXPECT_LE(none->interval.high, 1e-6);
  for (size_t k = 0; k < slices.size(); ++k) {
    for (float& value : slices[k]) value *= 1 + static_cast<float>(k % 3) * 0x1p-23f;
  }
  const std::optional<FilmError> rounding = estimateFilmError(slices, 64);
  ASSERT_TRUE(rounding);
  EXPECT_LE(rounding->interval.high, 1e-6);
}

TEST(FilmSlices, areMeansOfTheirOwnIterationsAlone) {
  FilmSlices slices;
  // Iteration i has the value i: the mean of n of them is (n - 1) / 2.
  uint64_t iterations = 0;
  for (int look = 0; look < 26; ++look) {
    iterations = slices.nextIterations();
    slices.add(Film(3, 0.5f * static_cast<float>(iterations - 1)));
  }
  // Sixteen slices of one iteration become eight of two; sixteen of those, eight of four.
  EXPECT_EQ(iterations, 2u * 16 + 2 * 4);
  const float size = static_cast<float>(iterations) / static_cast<float>(slices.slices().size());
  for (size_t k = 0; k < slices.slices().size(); ++k) {
    EXPECT_NEAR(slices.slices()[k][0], static_cast<float>(k) * size + 0.5f * (size - 1), 1e-4f);
  }
}

// The products of noise are as uneven as the pixels are few. Goals are refused where an error is never told.
TEST(FilmError, isToldOfFilmsOfAFewPixels) {
  constexpr int kTrials = 20;
  const auto told = [](size_t pixels, size_t width) {
    std::mt19937_64 random(3);
    std::normal_distribution<float> normal(1, 0.125f);
    int count = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<Film> slices(2 * kFewestSlices - 1);
      for (Film& slice : slices) {
        for (size_t pixel = 0; pixel < pixels; ++pixel) slice.insert(slice.end(), 3, normal(random));  // grey
      }
      count += estimateFilmError(slices, width) ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(told(1, 1), 0);
  EXPECT_GT(told(kFewestPixelsOfError, 4), kTrials / 2);
}

// Two iterations of a film that spreads samples share a place and its mirror image: no slice ends between them.
TEST(FilmErrorWatch, takesPairsOfIterationsUnderAGaussianFilter) {
  LoadOptions options;
  options.filmSize = {kWidth, kHeight};
  Scene scene = loadScene(findScene("cornell-diffuse"), options);
  scene.film.filter = ReconstructionFilter::gaussian;
  const RenderSettings settings = settingsOf(scene, Method::pt, 1);
  const auto session = Session::create(scene, settings);
  ASSERT_TRUE(session->film().spreads());
  FilmErrorWatch watch;
  const ErrorNow now = watch.renderUntil(*session, settings, 1000);  // reached as soon as it is told
  EXPECT_TRUE(now.reached);
  EXPECT_GE(now.iterations, 2 * kFewestSlices);
  EXPECT_EQ(now.iterations % 2, 0u);
}

TEST(FilmErrorWatch, goesOnAfterAnInterrupt) {
  LoadOptions options;
  options.filmSize = {kWidth, kHeight};
  const Scene scene = loadScene(findScene("cornell-diffuse"), options);
  const RenderSettings settings = settingsOf(scene, Method::pt, 1);
  const auto whole = Session::create(scene, settings), parts = Session::create(scene, settings);
  FilmErrorWatch one, two;
  const ErrorNow wanted = one.renderUntil(*whole, settings, 0.3);
  parts->interrupt();
  EXPECT_FALSE(two.renderUntil(*parts, settings, 0.3).reached);
  parts->resume();
  const ErrorNow found = two.renderUntil(*parts, settings, 0.3);
  ASSERT_TRUE(wanted.reached && found.reached);
  EXPECT_EQ(found.iterations, wanted.iterations);
  EXPECT_EQ(found.error->value, wanted.error->value);
  EXPECT_LE(found.error->interval.high, 0.3);
}

// Path tracing of the scene until its error is a tenth, without another limit.
ErrorNow watchedUntilATenth(const std::string& xml) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path("scene.xml");
  std::ofstream(file) << xml;
  LoadOptions options;
  options.filmSize = {kWidth, kHeight};
  const Scene scene = loadScene(file, options);
  const RenderSettings settings = settingsOf(scene, Method::pt, 1);
  const auto session = Session::create(scene, settings);
  FilmErrorWatch watch;
  return watch.renderUntil(*session, settings, 0.1);
}

TEST(FilmErrorWatch, endsAtABlackFilmWhereNothingElseWould) {
  const ErrorNow now =
      watchedUntilATenth(R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/></scene>)");
  EXPECT_TRUE(now.black && !now.reached && !now.error);
  EXPECT_GE(now.iterations, kBlackIterations);
}

// A sky alone, or one beside a small lamp that no path has hit yet: the first looks cannot tell.
TEST(FilmErrorWatch, believesInAFilmWithoutVarianceOnlyAfterManyIterations) {
  const ErrorNow now = watchedUntilATenth(
      R"(<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm"><rfilter type="box"/></film></sensor>
         <emitter type="constant"/><shape type="sphere"><point name="center" z="-9"/></shape></scene>)");
  EXPECT_TRUE(now.reached);
  EXPECT_GE(now.iterations, kBlackIterations);
}

TEST(FilmErrorWatch, saysWhichIterationsAreNotIndependent) {
  RenderSettings settings;
  EXPECT_EQ(whyNoFilmError(settings), "");
  EXPECT_EQ(independentRun(settings.sampler, false), 1);
  EXPECT_EQ(independentRun(settings.sampler, true), 2);
  settings.sampler = SamplerKind::sobol;
  EXPECT_EQ(whyNoFilmError(settings), "");
  EXPECT_EQ(independentRun(settings.sampler, true), kSobolRun);
  settings.method = Method::mlt;
  EXPECT_NE(whyNoFilmError(settings), "");
}

}  // namespace
}  // namespace wavecrest
