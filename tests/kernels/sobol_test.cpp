// The Sobol sampler: its points form nets, they integrate better than independent ones, and sets do not resemble each
// other.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/sampling/sobol_directions.h"
#include "tests/kernels/sample_columns.h"
#include "tests/kernels/statistics.h"

namespace wavecrest {
namespace {

constexpr SamplerSettings kSobol{.kind = SamplerKind::sobol, .seed = 3, .iteration = 0};
// Of a camera walk: blocks of later vertices are independent.
constexpr uint32_t kSobolBlocks = 4 * sobolVertices(Stream::camera);
constexpr SamplerSettings kIndependent{.kind = SamplerKind::independent, .seed = 3, .iteration = 0};

// How many points fall into each box that is 2^-bits[d] wide along dimension d.
std::vector<size_t> boxCounts(const SampleColumns& u, const std::array<uint32_t, 4>& bits) {
  std::vector<size_t> counts(size_t{1} << (bits[0] + bits[1] + bits[2] + bits[3]));
  for (size_t i = 0; i < u[0].size(); ++i) {
    size_t box = 0;
    for (size_t d = 0; d < 4; ++d) {
      box = box << bits[d] | static_cast<size_t>(std::ldexp(u[d][i], static_cast<int>(bits[d])));
    }
    ++counts[box];
  }
  return counts;
}
void expectEveryBoxHolds(const SampleColumns& u, const std::array<uint32_t, 4>& bits, size_t expected) {
  for (const size_t count : boxCounts(u, bits)) {
    ASSERT_EQ(count, expected) << bits[0] << ' ' << bits[1] << ' ' << bits[2] << ' ' << bits[3];
  }
}

// (0,m,2)-net: each of the 2^m boxes of area 2^-m, of any shape, holds one of the first 2^m points.
TEST(SobolSampler, firstTwoNumbersFormNetsOfEverySize) {
  for (uint32_t m = 0; m <= 12; ++m) {
    const SampleColumns u = drawIterations(kSobol, size_t{1} << m, 5, m % kSobolBlocks);
    for (uint32_t bits = 0; bits <= m; ++bits) expectEveryBoxHolds(u, {bits, m - bits, 0, 0}, 1);
  }
}

TEST(SobolSampler, everyNumberIsStratified) {
  for (uint32_t m = 0; m <= 12; ++m) {
    const SampleColumns u = drawIterations(kSobol, size_t{1} << m, 6, m % kSobolBlocks);
    expectEveryBoxHolds(u, {m, 0, 0, 0}, 1);
    expectEveryBoxHolds(u, {0, m, 0, 0}, 1);
    expectEveryBoxHolds(u, {0, 0, m, 0}, 1);
    expectEveryBoxHolds(u, {0, 0, 0, m}, 1);
  }
}

// Sobol 1967: t is the sum of (degree - 1) over the polynomials of degree 1, 2 and 3, so 3. Boxes of volume 2^(3-m)
// hold 8 points each, in any shape over the four dimensions.
TEST(SobolSampler, allFourNumbersFormNets) {
  constexpr uint32_t kM = 11, kT = 3;
  const SampleColumns u = drawIterations(kSobol, size_t{1} << kM, 7);
  for (uint32_t a = 0; a <= kM - kT; ++a) {
    for (uint32_t b = 0; a + b <= kM - kT; ++b) {
      for (uint32_t c = 0; a + b + c <= kM - kT; ++c) expectEveryBoxHolds(u, {a, b, c, kM - kT - a - b - c}, 1 << kT);
    }
  }
}

// Later aligned ranges of iterations are nets too; the second epoch is one, and is not a repetition of the first.
TEST(SobolSampler, laterIterationsFormNets) {
  const auto draw = [](uint32_t first) { return drawIterations(kSobol, 256, 5, 0, Stream::camera, first); };
  constexpr uint32_t kEpoch = 1u << kPathSetBits;
  for (const uint32_t first : {256u, 3u * 256u, kEpoch - 256u, kEpoch, 2 * kEpoch + 512}) {
    for (uint32_t bits = 0; bits <= 8; ++bits) expectEveryBoxHolds(draw(first), {bits, 8 - bits, 0, 0}, 1);
  }
  EXPECT_NE(draw(0)[0], draw(kEpoch)[0]);
}

// ---- light paths of one sequence ------------------------------------------------------------------------------------

SamplerSettings shared(uint64_t lightPaths, uint64_t iteration = 0) {
  SamplerSettings sampler = kSobol;
  sampler.lightPaths = lightPaths;
  sampler.iteration = iteration;
  return sampler;
}

TEST(SharedSobolSampler, pathsOfAnIterationFormNets) {
  for (const uint64_t iteration : {0u, 1u, 77u}) {
    for (const uint32_t block : {0u, 1u, 3u}) {
      const SampleColumns u = drawPaths(shared(4096, iteration), 4096, block, Stream::light);
      for (uint32_t bits = 0; bits <= 12; ++bits) expectEveryBoxHolds(u, {bits, 12 - bits, 0, 0}, 1);
      for (uint32_t d = 2; d < 4; ++d) {
        std::array<uint32_t, 4> bits{};
        bits[d] = 12;
        expectEveryBoxHolds(u, bits, 1);
      }
    }
  }
}

TEST(SharedSobolSampler, iterationsGoOnWithTheSequence) {
  // Four iterations of 256 paths, from the first of an aligned range of 1024 points on.
  for (const uint64_t first : {0u, 8u, (kMostPaths - 1024u) / 256u}) {
    SampleColumns u;
    for (uint64_t i = first; i < first + 4; ++i) {
      const SampleColumns some = drawPaths(shared(256, i), 256, 0, Stream::light);
      for (size_t d = 0; d < 4; ++d) u[d].insert(u[d].end(), some[d].begin(), some[d].end());
    }
    for (uint32_t bits = 0; bits <= 10; ++bits) expectEveryBoxHolds(u, {bits, 10 - bits, 0, 0}, 1);
  }
}

// Where the points end, another sequence begins with an iteration, however many paths that has.
TEST(SharedSobolSampler, startsOverWithOtherScrambles) {
  for (const uint64_t paths : {uint64_t{kMostPaths}, uint64_t{kMostPaths} / 2, uint64_t{100'000'000}}) {
    const uint64_t together = kMostPaths / paths;
    const auto draw = [&](uint64_t iteration) { return drawPaths(shared(paths, iteration), 256, 0, Stream::light); };
    EXPECT_NE(draw(0)[0], draw(together)[0]);
    for (uint32_t bits = 0; bits <= 8; ++bits) expectEveryBoxHolds(draw(together), {bits, 8 - bits, 0, 0}, 1);
  }
}

TEST(SharedSobolSampler, isForTheOriginsOfLightPathsAlone) {
  const auto isIndependent = [](const SamplerSettings& sampler, uint32_t block, Stream stream) {
    SamplerSettings independent = sampler;
    independent.kind = SamplerKind::independent;
    return drawPaths(sampler, 64, block, stream) == drawPaths(independent, 64, block, stream);
  };
  EXPECT_FALSE(isIndependent(shared(64), 3, Stream::light));
  EXPECT_TRUE(isIndependent(shared(64), 4, Stream::light));
  EXPECT_FALSE(isIndependent(kSobol, 11, Stream::camera));
  EXPECT_TRUE(isIndependent(kSobol, 12, Stream::camera));
  EXPECT_EQ(drawPaths(shared(64), 64, 0, Stream::camera), drawPaths(kSobol, 64, 0, Stream::camera));
}

TEST(SharedSobolSampler, blocksArePairedAtRandom) {
  const SampleColumns u = drawPaths(shared(1 << 15), 1 << 15, 0, Stream::light);
  const SampleColumns others[] = {drawPaths(shared(1 << 15), 1 << 15, 1, Stream::light), drawPaths(kSobol, 1 << 15)};
  for (const SampleColumns& other : others) {
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) EXPECT_LT(pairDeviations(u[i], other[j]), kMaxDeviations) << i << ' ' << j;
    }
  }
}

// ---- convergence ----------------------------------------------------------------------------------------------------

// A smooth function of all four numbers, of known integral 1.
double smoothFunction(double a, double b, double c, double d) {
  const auto factor = [](double u, double phase) {
    const double mean = (std::cos(phase) - std::cos(3 + phase)) / 3;
    return 1 + 0.8 * (std::sin(3 * u + phase) - mean);
  };
  return factor(a, 0) * factor(b, 1) * factor(c, 2) * factor(d, 3);
}

// Root mean square error over many paths of the mean of the first n iterations.
double errorAfter(const SamplerSettings& sampler, uint32_t n) {
  constexpr size_t kPaths = 512;
  std::vector<double> sums(kPaths);
  SamplerSettings current = sampler;
  for (current.iteration = 0; current.iteration < n; ++current.iteration) {
    const SampleColumns u = drawPaths(current, kPaths);
    for (size_t p = 0; p < kPaths; ++p) {
      sums[p] += smoothFunction(static_cast<double>(u[0][p]), static_cast<double>(u[1][p]),
                                static_cast<double>(u[2][p]), static_cast<double>(u[3][p]));
    }
  }
  double squares = 0;
  for (const double sum : sums) squares += (sum / n - 1) * (sum / n - 1);
  return std::sqrt(squares / kPaths);
}

// Independent points: n^-1/2. Scrambled nets of a smooth function: up to n^-3/2 (Owen 1997), n^-1.2 here for small n.
// Rates over 512 paths carry a standard error of 0.01.
TEST(SobolSampler, convergesFasterThanIndependentNumbers) {
  const auto rate = [](const SamplerSettings& s) {
    return std::log(errorAfter(s, 16) / errorAfter(s, 1024)) / std::log(64.0);
  };
  EXPECT_NEAR(rate(kIndependent), 0.5, 0.05);
  EXPECT_GT(rate(kSobol), 1.0);
  EXPECT_LT(errorAfter(kSobol, 1024), errorAfter(kIndependent, 1024) / 20);
  EXPECT_LT(errorAfter(kSobol, 4), errorAfter(kIndependent, 4) / 1.3);  // a gain already at few samples
}

// ---- sets among each other ------------------------------------------------------------------------------------------

// The same iterations of two blocks, or of two paths: were the order of the points not shuffled per set, the pairs
// would fill a few cells only.
TEST(SobolSampler, setsArePairedAtRandom) {
  constexpr size_t kIterations = 1 << 15;
  const SampleColumns u = drawIterations(kSobol, kIterations, 100);
  const SampleColumns others[] = {drawIterations(kSobol, kIterations, 100, 1), drawIterations(kSobol, kIterations, 101),
                                  drawIterations(kSobol, kIterations, 100, 0, Stream::guide)};
  for (const SampleColumns& other : others) {
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) EXPECT_LT(pairDeviations(u[i], other[j]), kMaxDeviations) << i << ' ' << j;
    }
  }
}

}  // namespace
}  // namespace wavecrest
