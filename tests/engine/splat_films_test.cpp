// Sums of splats next to their limits, shared by many workers, and images of any brightness.
#include "engine/film/splat_films.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/methods/method_list.h"
#include "engine/tasks/for_each.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/test_scenes.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

// A queue of splats with memory of its own.
template <class S>
struct Queue {
  explicit Queue(size_t capacity) : arena(splats.bytes(capacity)) { splats.bind(arena, capacity); }
  void push(uint32_t pixel, S red, S green, S blue) {
    const size_t i = splats.claim(1);
    splats.pixel[i] = pixel;
    splats.red[i] = red;
    splats.green[i] = green;
    splats.blue[i] = blue;
  }
  Splats<S> splats;
  Arena arena;
};

template <class S>
AddSplats<S> addSplatsOf(Isa isa) {
  constexpr Precision kPrecision = sizeof(S) == 8 ? Precision::doubled : Precision::floating;
  return findStages<S>(isa, kPrecision, chooseSpecialization(0, kPrecision)).addSplats;
}

using SplatSumsTest = IsaTest;
WAVECREST_TEST_EVERY_ISA(SplatSumsTest);

// The low half is full, or one splat short of it: what does not fit is carried into the high half.
TEST_P(SplatSumsTest, carryIntoTheHighHalf) {
  for (const uint64_t before : {~uint64_t{0}, ~uint64_t{0} - 1, uint64_t{1} << 63, uint64_t{0}}) {
    SplatFilm film(1, 1, 1.0);
    for (size_t c = 0; c < 3; ++c) film.sums().low[c] = before;
    Queue<float> queue(16);
    queue.push(0, 1, 3, 0x1p61f);
    StageCounters counters;
    addSplatsOf<float>(GetParam())(queue.splats, 0, 1, film.sums(), counters);
    const uint64_t added[3] = {1, 3, uint64_t{1} << 61};
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_TRUE(splatSum(film.sums(), c) == static_cast<__int128>(before) + added[c]) << before << ", channel " << c;
    }
  }
}

// Splats of any size are added as the scalar form adds them, whatever shares their block.
TEST_P(SplatSumsTest, takeEverySizeExactly) {
  std::mt19937_64 random(3);
  for (const size_t count : {1u, 5u, 15u, 16u, 17u, 40u, 200u}) {
    constexpr size_t kPixels = 7;
    SplatFilm film(kPixels, 1, 0x1p40), expected(kPixels, 1, 0x1p40);
    Queue<double> queue(count);
    const auto value = [&] {
      const double mantissa = 1 + static_cast<double>(random() >> 40) * 0x1p-24;
      return std::ldexp(mantissa, static_cast<int>(random() % 120) - 50) * (random() % 8 == 0 ? -1 : 1);
    };
    for (size_t i = 0; i < count; ++i) {
      const auto pixel = static_cast<uint32_t>(random() % kPixels);
      const double rgb[3] = {value(), value(), value()};
      queue.push(pixel, rgb[0], rgb[1], rgb[2]);
      for (size_t c = 0; c < 3; ++c) addToSplatSum(expected.sums(), 3 * pixel + c, rgb[c]);
    }
    StageCounters counters;
    const size_t middle = count / 3;  // a range may begin anywhere
    addSplatsOf<double>(GetParam())(queue.splats, 0, middle, film.sums(), counters);
    addSplatsOf<double>(GetParam())(queue.splats, middle, count, film.sums(), counters);
    for (size_t c = 0; c < 3 * kPixels; ++c) {
      EXPECT_TRUE(splatSum(film.sums(), c) == splatSum(expected.sums(), c)) << count << ", channel " << c;
    }
    EXPECT_EQ(counters.nonFinite, 0u);
    EXPECT_EQ(counters.saturatedSplats, 0u);
  }
}

TEST_P(SplatSumsTest, dropAndCountWhatIsNotFinite) {
  SplatFilm film(2, 1, 1.0);
  Queue<float> queue(16);
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  queue.push(0, 4, inf, 4);
  queue.push(0, 4, 4, nan);
  queue.push(1, 5, 6, 7);
  StageCounters counters;
  addSplatsOf<float>(GetParam())(queue.splats, 0, 3, film.sums(), counters);
  EXPECT_EQ(counters.nonFinite, 2u);
  EXPECT_TRUE(splatSum(film.sums(), 0) == 0 && splatSum(film.sums(), 1) == 0);
  EXPECT_TRUE(splatSum(film.sums(), 3) == 5 && splatSum(film.sums(), 5) == 7);
}

// Beyond the limit a sum stays where it is, and says so.
TEST_P(SplatSumsTest, saturateAndCount) {
  SplatFilm film(1, 1, 1.0);
  Queue<double> queue(16);
  queue.push(0, 0x1p200, 1, 1);
  queue.push(0, 0x1p123, 0x1p123, 1);
  StageCounters counters;
  const AddSplats<double> add = addSplatsOf<double>(GetParam());
  add(queue.splats, 0, 2, film.sums(), counters);
  EXPECT_EQ(counters.saturatedSplats, 2u);
  EXPECT_EQ(static_cast<double>(splatSum(film.sums(), 0)), kSplatLimit);
  EXPECT_EQ(static_cast<double>(splatSum(film.sums(), 1)), 0x1p123);
  for (int i = 0; i < 40; ++i) add(queue.splats, 0, 2, film.sums(), counters);
  EXPECT_GE(static_cast<double>(splatSum(film.sums(), 1)), kSplatLimit) << "a sum never wraps";
  EXPECT_LE(static_cast<double>(splatSum(film.sums(), 1)), kSplatLimit + 0x1p123);
}

// An hour of one pixel at 20 million splats a second, all of them large, as sums that were there before.
TEST_P(SplatSumsTest, holdAnHourOfLargeSplats) {
  SplatFilm film(1, 1, 0x1p48);
  constexpr double kSplatsPerHour = 3600.0 * 20e6, kSplat = 1000;
  const auto units = static_cast<unsigned __int128>(kSplatsPerHour * kSplat * 0x1p48);
  film.sums().low[0] = static_cast<uint64_t>(units);
  film.sums().high[0] = static_cast<uint64_t>(units >> 64);
  Queue<float> queue(1000);
  for (int i = 0; i < 1000; ++i) queue.push(0, static_cast<float>(kSplat), 0, 0);
  StageCounters counters;
  addSplatsOf<float>(GetParam())(queue.splats, 0, 1000, film.sums(), counters);
  EXPECT_EQ(static_cast<double>(splatSum(film.sums(), 0)) * 0x1p-48, (kSplatsPerHour + 1000) * kSplat);
}

// ---- films ----------------------------------------------------------------------------------------------------------

// Any number of workers, at the same time, come to the same sums; and they share a bounded number of films.
TEST(SplatFilms, areTheSameForAnyNumberOfWorkers) {
  constexpr size_t kPixels = 1000, kQueueCapacity = 256, kQueues = 200;
  std::vector<unsigned char> expected;
  for (const size_t threads : {1u, 2u, 3u, 8u, 64u}) {
    SplatFilms films(kPixels, threads, 0x1p40);
    EXPECT_EQ(films.bytes(), SplatFilms::bytesFor(kPixels, std::min<size_t>(threads, kSplatFilms)));
    EXPECT_EQ(films.regions() > 1, threads > kSplatFilms);
    forEach(threads, [&](size_t worker) {
      SplatWriter<float> writer(films, addSplatsOf<float>(bestIsa()), kQueueCapacity);
      EXPECT_EQ(writer.bytes(), SplatWriter<float>::bytesFor(kPixels, threads, kQueueCapacity));
      EXPECT_EQ(writer.bytes() > 0, threads > kSplatFilms);
      Queue<float> queue(kQueueCapacity);
      StageCounters counters;
      for (size_t i = worker; i < kQueues; i += threads) {
        std::mt19937_64 random(i);
        for (size_t k = 0; k < kQueueCapacity; ++k) {
          const auto bright = static_cast<float>(random() % 1'000'003) * 1e-3f;
          queue.push(static_cast<uint32_t>(random() % kPixels), bright, 1, 1e9f);
        }
        writer.drain(queue.splats, counters);
        EXPECT_EQ(queue.splats.size, 0u);
      }
    });
    if (expected.empty()) expected = savedState(films);
    EXPECT_EQ(savedState(films), expected) << threads << " workers";
    SplatFilms restored(kPixels, threads, 0x1p40);
    restoreState(restored, expected);
    EXPECT_EQ(savedState(restored), expected);
  }
}

// ---- images ---------------------------------------------------------------------------------------------------------

class AnyBrightness : public testing::TestWithParam<Method> {};

// The light's radiance times a power of two is an image times that, to the last bit: nothing wraps, and nothing is
// lost below a unit. Without splats in units of the scene, lt, bpt and vcm were off by a half at 2^20 and by a third at
// 2^-40. pssmlt decides by ratios of luminances, so its chains take the same steps.
TEST_P(AnyBrightness, isTheSameImage) {
  constexpr uint32_t kSize = 24;
  const auto image = [&](double factor, uint64_t iterations) {
    Scene scene = sceneFile("mitsuba-cornell-box", kSize, kSize);
    for (Emitter& emitter : scene.emitters) {
      for (double& channel : std::get<AreaEmitter>(emitter.kind).radiance.value) channel *= factor;
    }
    RenderSettings settings;
    settings.method = GetParam();
    settings.isa = bestIsa();
    settings.threads = 2;
    settings.metropolis.chains = 256;
    settings.metropolis.bootstrapSamples = 4096;
    settings.metropolis.variant = MetropolisVariant::pssmlt;
    return render(scene, settings, iterations);
  };
  constexpr uint64_t kManyIterations = 64;
  const RgbImage expected = image(1, kManyIterations);
  for (const int exponent : {-40, 17, 40}) {
    const RgbImage scaled = image(std::ldexp(1.0, exponent), kManyIterations);
    for (size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(std::ldexp(scaled[i], -exponent), expected[i]) << "2^" << exponent << ", value " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, AnyBrightness, testing::ValuesIn([] {
                           std::vector<Method> methods;
                           methods.reserve(kMethods.size());
                           for (const MethodEntry& entry : kMethods) methods.push_back(entry.method);
                           return methods;
                         }()),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// Light paths of the faint lamp begin with a throughput of pi / 100 times its radiance, 2e-31. Roulette compares later
// throughputs with it, so the same paths survive as of a bright lamp. The box is grey and seen at no grazing angle: no
// contribution is small enough to be flushed to zero.
TEST(FaintLamp, isTheSameImageAsABrightOne) {
  const auto image = [](double radiance) {
    Scene scene;
    scene.name = "box";
    const uint32_t grey = addDiffuse(scene, 0.6, 0.6, 0.6);
    addShape(scene, Rectangle{{-0.5, -0.5, 0.5}, {1, 0, 0}, {0, 0, -1}}, grey);       // floor
    addShape(scene, Rectangle{{-0.5, 0.5, -0.5}, {1, 0, 0}, {0, 0, 1}}, grey);        // ceiling
    addShape(scene, Rectangle{{-0.5, -0.5, -0.5}, {1, 0, 0}, {0, 1, 0}}, grey);       // back
    addShape(scene, Rectangle{{0.5, -0.5, 0.5}, {-1, 0, 0}, {0, 1, 0}}, grey);        // front
    addShape(scene, Rectangle{{-0.5, -0.5, 0.5}, {0, 0, -1}, {0, 1, 0}}, grey);       // left
    addShape(scene, Rectangle{{0.5, -0.5, -0.5}, {0, 0, 1}, {0, 1, 0}}, grey);        // right
    addShape(scene, Rectangle{{-0.05, 0.4, -0.05}, {0.1, 0, 0}, {0, 0, 0.1}}, grey);  // lamp, facing down
    makeLight(scene, {radiance, radiance, radiance});
    setCamera(scene, {0, 0, 0.4}, 60, 16, 16);
    RenderSettings settings;
    settings.method = Method::lt;
    settings.isa = bestIsa();
    settings.threads = 2;
    return render(scene, settings, 32);
  };
  constexpr int kExponent = -97;
  const RgbImage bright = image(1), faint = image(std::ldexp(1.0, kExponent));
  for (size_t i = 0; i < bright.size(); ++i) {
    ASSERT_EQ(std::ldexp(faint[i], -kExponent), bright[i]) << "value " << i;
  }
}

}  // namespace
}  // namespace wavecrest
