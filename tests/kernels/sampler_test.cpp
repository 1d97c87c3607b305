// Random numbers: the generator against published vectors, the same bits on every instruction set, and statistics.
#include <cmath>
#include <random>

#include "tests/effort.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/sample_columns.h"
#include "tests/kernels/statistics.h"

namespace wavecrest {
namespace {

using Words = std::array<uint32_t, 4>;

class SamplerTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(SamplerTest);

SamplerSettings settings(SamplerKind kind, uint64_t seed = 0x123456789abcdefu, uint64_t iteration = 5) {
  return {.kind = kind, .seed = seed, .iteration = iteration};
}

// Random123's published vectors for philox4x32-10: zeros, ones, and digits of pi.
TEST_P(SamplerTest, philoxMatchesPublishedVectors) {
  for (const bool perLane : {false, true}) {
    const auto philox = [&](Words counter, uint64_t key) {
      return entries<SamplerEntries>().philox10(counter, key, perLane);
    };
    EXPECT_EQ(philox({0, 0, 0, 0}, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, ~uint64_t{0}), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
  }
}

// Bit for bit the scalar twin's numbers, whatever the width; nothing written past the padded columns.
TEST_P(SamplerTest, numbersDoNotDependOnTheInstructionSet) {
  struct Drawn {
    SamplerKind kind;
    Stream stream;
    uint32_t block;
  };
  for (const Drawn& drawn :
       {Drawn{SamplerKind::independent, Stream::light, 9}, Drawn{SamplerKind::sobol, Stream::camera, 1},
        Drawn{SamplerKind::sobol, Stream::camera, 13}, Drawn{SamplerKind::sobol, Stream::light, 1},
        Drawn{SamplerKind::sobol, Stream::light, 9}}) {
    const SamplerEntries& kernel = entries<SamplerEntries>();
    SamplerSettings sampler = settings(drawn.kind, 77);
    sampler.lightPaths = 5000;
    forEachShape(kernel.lanes, [&](size_t count, size_t offset) {
      const size_t padded = (count + kernel.lanes - 1) / kernel.lanes * kernel.lanes;
      std::vector<GuardedColumn<float>> actual(4, GuardedColumn<float>(count, padded, offset));
      std::vector<GuardedColumn<float>> expected(4, GuardedColumn<float>(count));
      const auto draw = [&](const SamplerEntries& from, std::vector<GuardedColumn<float>>& to) {
        sampler.iteration = count;
        from.fill(sampler, 1000, drawn.block, drawn.stream, count,
                  {to[0].data(), to[1].data(), to[2].data(), to[3].data()});
      };
      draw(kernel, actual);
      draw(twin<SamplerEntries>(), expected);
      for (size_t d = 0; d < 4; ++d) {
        for (size_t i = 0; i < count; ++i) ASSERT_EQ(actual[d][i], expected[d][i]);
        ASSERT_TRUE(actual[d].intact());
      }
    });
  }
}

// A path's numbers are the same drawn alone or among others.
TEST_P(SamplerTest, numbersDoNotDependOnTheNeighbours) {
  for (const SamplerKind kind : kAllSamplerKinds) {
    const SampleColumns many = drawPaths(settings(kind), 100, 3, Stream::camera, 50, GetParam());
    for (uint32_t path = 0; path < 100; ++path) {
      const SampleColumns one = drawPaths(settings(kind), 1, 3, Stream::camera, 50 + path, GetParam());
      for (size_t d = 0; d < 4; ++d) ASSERT_EQ(one[d][0], many[d][path]);
    }
  }
}

// As many iterations as a counter of 64 bits has: those that differ by a power of two share no path's numbers.
TEST_P(SamplerTest, iterationsHaveNumbersOfTheirOwnHoweverMany) {
  constexpr size_t kPaths = 32;
  for (const SamplerKind kind : kAllSamplerKinds) {
    const SampleColumns first = drawPaths(settings(kind, 7, 5), kPaths, 3, Stream::camera, 0, GetParam());
    for (uint32_t bit = 4; bit < 56; ++bit) {
      const SampleColumns other =
          drawPaths(settings(kind, 7, 5 + (uint64_t{1} << bit)), kPaths, 3, Stream::camera, 0, GetParam());
      size_t equal = 0;
      for (size_t d = 0; d < 4; ++d) {
        for (size_t i = 0; i < kPaths; ++i) equal += first[d][i] == other[d][i];
      }
      EXPECT_LE(equal, 1u) << toString(kind) << ", bit " << bit;  // 128 of 2^24: one by chance in 10^5 draws
    }
  }
}

TEST_P(SamplerTest, numbersLieOnTheGridBelowOne) {
  for (const SamplerKind kind : kAllSamplerKinds) {
    for (const auto& column : drawPaths(settings(kind), effort(1 << 16, 1 << 12), 0, Stream::camera, 0, GetParam())) {
      for (const float u : column) {
        ASSERT_TRUE(u >= 0 && u < 1);
        const double onGrid = static_cast<double>(u) * 0x1p24;
        ASSERT_EQ(onGrid, std::floor(onGrid));
      }
    }
  }
}

// Rounded down, a threshold is below a float a exactly where the 48-bit number is, and never 1.
TEST_P(SamplerTest, thresholdsAreRoundedDown) {
  constexpr size_t kCount = effort(1 << 16, 1 << 12);
  std::vector<uint32_t> upper(kCount), lower(kCount);
  std::mt19937 random(5);
  for (size_t i = 0; i < kCount; ++i) {
    upper[i] = static_cast<uint32_t>(random()) >> (i % 32);  // of every magnitude
    lower[i] = static_cast<uint32_t>(random());
  }
  upper[0] = lower[0] = ~0u;
  std::vector<float> actual(kCount);
  entries<SamplerEntries>().thresholds(upper.data(), lower.data(), kCount, actual.data());
  EXPECT_EQ(actual[0], 0x1.fffffep-1f);
  for (size_t i = 0; i < kCount; ++i) {
    const double exact = (upper[i] >> 8) * 0x1p-24 + (lower[i] >> 8) * 0x1p-48;
    ASSERT_LE(double{actual[i]}, exact) << upper[i] << ' ' << lower[i];
    ASSERT_GT(double{std::nextafter(actual[i], 2.0f)}, exact) << upper[i] << ' ' << lower[i];
  }
}

// ---- statistics over the paths of one iteration, for both samplers: pixels must not resemble their neighbours
// --------

class SamplerStatistics : public testing::TestWithParam<SamplerKind> {};
INSTANTIATE_TEST_SUITE_P(EveryKind, SamplerStatistics, testing::ValuesIn(kAllSamplerKinds),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

constexpr size_t kSamples = effort(1 << 19, 1 << 15);

TEST_P(SamplerStatistics, eachNumberIsUniform) {
  for (const auto& column : drawPaths(settings(GetParam()), kSamples)) {
    std::vector<size_t> coarse(1024), fine(1024);
    for (const float u : column) {
      const auto grid = static_cast<uint32_t>(u * 0x1p24f);
      ++coarse[grid >> 14];
      ++fine[grid & 1023];  // the lowest ten of the 24 bits
    }
    EXPECT_LT(std::abs(uniformDeviations(coarse)), kMaxDeviations);
    EXPECT_LT(std::abs(uniformDeviations(fine)), kMaxDeviations);
  }
}

TEST_P(SamplerStatistics, numbersOfOneBlockAreIndependent) {
  const SampleColumns u = drawPaths(settings(GetParam()), kSamples);
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_LT(std::abs(pairDeviations(u[i], u[j])), kMaxDeviations) << i << ' ' << j;
  }
}

TEST_P(SamplerStatistics, neighbouringPathsAreIndependent) {
  for (const auto& u : drawPaths(settings(GetParam()), kSamples)) {
    for (const size_t distance : {1u, 2u, 16u, 1024u}) {
      const size_t n = u.size() - distance;
      EXPECT_LT(std::abs(pairDeviations({u.data(), n}, {u.data() + distance, n})), kMaxDeviations) << distance;
    }
    EXPECT_LT(std::abs(runsDeviations(u)), kMaxDeviations);
  }
}

// Everything that names a set of numbers makes it independent of the other sets.
TEST_P(SamplerStatistics, blocksStreamsAndSeedsAreIndependent) {
  SamplerSettings base = settings(GetParam(), 1);
  base.lightPaths = kSamples;
  const SampleColumns u = drawPaths(base, kSamples);
  const SampleColumns others[] = {
      drawPaths(base, kSamples, 1),
      drawPaths(base, kSamples, 4),
      drawPaths(base, kSamples, 0, Stream::light),
      drawPaths(base, kSamples, 0, Stream::chain),
      drawPaths(settings(GetParam(), 2), kSamples),
      drawPaths(settings(GetParam(), 1 + (uint64_t{1} << 32)), kSamples),
  };
  for (const SampleColumns& other : others) {
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) EXPECT_LT(std::abs(pairDeviations(u[i], other[j])), kMaxDeviations) << i << j;
    }
  }
}

// Only the independent sampler promises this; the other is built to break it.
TEST(IndependentSampler, iterationsAreIndependent) {
  const SampleColumns u = drawPaths(settings(SamplerKind::independent, 1, 0), kSamples);
  for (const uint32_t iteration : {1u, 2u, 1024u}) {
    const SampleColumns other = drawPaths(settings(SamplerKind::independent, 1, iteration), kSamples);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) EXPECT_LT(std::abs(pairDeviations(u[i], other[j])), kMaxDeviations) << i << j;
    }
  }
  const SampleColumns onePath = drawIterations(settings(SamplerKind::independent), 1 << 17, 7);
  for (const auto& column : onePath) {
    EXPECT_LT(std::abs(pairDeviations({column.data(), column.size() - 1}, {column.data() + 1, column.size() - 1})),
              kMaxDeviations);
    EXPECT_LT(std::abs(runsDeviations(column)), kMaxDeviations);
  }
}

}  // namespace
}  // namespace wavecrest
