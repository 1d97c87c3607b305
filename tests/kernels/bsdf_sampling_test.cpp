// Sampling of BSDFs against their densities, on every instruction set and precision.
#include <utility>

#include "tests/effort.h"
#include "tests/kernels/bsdf_cases.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/statistics.h"

namespace wavecrest {
namespace {

class BsdfSamplingTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(BsdfSamplingTest);

constexpr std::array kPrecisions{Precision::floating, Precision::doubled};

// ---- a grid over the sphere -----------------------------------------------------------------------------------------
// Cells are steps in theta and in azimuth, measured from the mirror direction, around which lobes at grazing incidence
// are narrow: azimuth = pi s^3 with equal steps of s in [-1, 1]. Integrals over a cell use the nodes of a
// Gauss-Legendre rule in either variable.

constexpr size_t kThetaCells = 72, kPhiCells = 72;
// Three nodes in each of kParts parts of a cell's side: refraction has kinks that no single rule resolves.
constexpr size_t kParts = 4, kNodes = 3 * kParts;
double nodePosition(size_t i) {  // in [0, 1]
  constexpr double kOffsets[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
  const size_t part = i / 3;
  return (static_cast<double>(part) + kOffsets[i % 3]) / kParts;
}
double nodeWeight(size_t i) {  // sums to 1
  return (i % 3 == 1 ? 4.0 / 9 : 5.0 / 18) / kParts;
}

// A node of the cells along one side of the grid; weight: of the rule, times the step of the angle.
struct AngleNode {
  double sine, cosine, weight;
};

// angleAt(x): the angle at x cells from the side's beginning, and its derivative.
template <class AngleAt>
std::vector<AngleNode> angleNodes(size_t cells, AngleAt&& angleAt) {
  std::vector<AngleNode> nodes;
  for (size_t i = 0; i < cells * kNodes; ++i) {
    const size_t cell = i / kNodes;
    const auto [angle, derivative] = angleAt(static_cast<double>(cell) + nodePosition(i % kNodes));
    nodes.push_back({std::sin(angle), std::cos(angle), nodeWeight(i % kNodes) * derivative});
  }
  return nodes;
}

struct Integrals {
  std::vector<double> pdf;         // over each cell
  double total = 0;                // of pdf
  std::array<double, 3> albedo{};  // INT f |cos|
};

double mirrorAzimuth(const Direction& wi) { return std::atan2(-wi[1], -wi[0]); }

size_t cellOf(const Direction& d, double mirrorPhi) {
  const double theta = std::acos(std::clamp(d[2], -1.0, 1.0));
  const double turns = (std::atan2(d[1], d[0]) - mirrorPhi) / (2 * std::numbers::pi);
  const double s = std::cbrt(2 * (turns - std::round(turns)));
  const auto row = static_cast<size_t>(theta / std::numbers::pi * kThetaCells);
  const auto column = static_cast<size_t>((s + 1) / 2 * kPhiCells);
  return std::min(row, kThetaCells - 1) * kPhiCells + std::min(column, kPhiCells - 1);
}

Integrals integrate(const BsdfEntries& entries, const BsdfQuery& query, const Direction& wi) {
  Integrals integrals;
  integrals.pdf.resize(kThetaCells * kPhiCells);
  constexpr double kThetaStep = std::numbers::pi / kThetaCells, kStep = 2.0 / kPhiCells;
  const double mirrorPhi = mirrorAzimuth(wi);
  const std::vector<AngleNode> azimuths = angleNodes(kPhiCells, [&](double position) {
    const double s = position * kStep - 1;
    return std::pair{mirrorPhi + std::numbers::pi * s * s * s, kStep * 3 * std::numbers::pi * s * s};
  });
  const std::vector<AngleNode> thetas = angleNodes(kThetaCells, [&](double position) {
    return std::pair{position * kThetaStep, kThetaStep};
  });
  std::vector<Direction> gens;
  std::vector<double> weights;
  const std::vector<Direction> fixes(kPhiCells * kNodes * kNodes, wi);
  for (size_t row = 0; row < kThetaCells; ++row) {
    gens.clear();
    weights.clear();
    for (size_t column = 0; column < kPhiCells; ++column) {
      for (size_t i = 0; i < kNodes; ++i) {
        const AngleNode& theta = thetas[row * kNodes + i];
        for (size_t j = 0; j < kNodes; ++j) {
          const AngleNode& phi = azimuths[column * kNodes + j];
          gens.push_back({theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine});
          weights.push_back(theta.weight * theta.sine * phi.weight);
        }
      }
    }
    const auto values = evaluate(entries, query, fixes, gens);
    for (size_t n = 0; n < gens.size(); ++n) {
      integrals.pdf[row * kPhiCells + n / (kNodes * kNodes)] += values[n].pdf * weights[n];
      for (size_t k = 0; k < 3; ++k) integrals.albedo[k] += values[n].f[k] * std::abs(gens[n][2]) * weights[n];
    }
  }
  for (const double mass : integrals.pdf) integrals.total += mass;
  return integrals;
}

bool counts(const BsdfDraw& draw) {
  return !draw.specular && std::max({draw.weight[0], draw.weight[1], draw.weight[2]}) > 0;
}

size_t drawCount(Precision precision) {
  return precision == Precision::floating ? samples(1'000'000, 20'000) : samples(200'000, 20'000);
}

// Of what is integrated over the sphere: everything, or one direction of every eighth material. That all materials run
// under sanitizers is for the tests below, which take a few draws of each.
std::vector<BsdfCase> integratedCases() {
  std::vector<BsdfCase> list;
  for (size_t i = 0; i < bsdfCases().size(); i += effort(1, 8)) list.push_back(bsdfCases()[i]);
  return list;
}
std::vector<Direction> integratedDirections(const BsdfCase& bsdf) {
  std::vector<Direction> fixes = wiDirections(bsdf);
  fixes.resize(effort(fixes.size(), 1));
  return fixes;
}
size_t integralCount() {
  size_t count = 0;
  for (const BsdfCase& bsdf : integratedCases()) count += integratedDirections(bsdf).size();
  return count;
}

// Significance 0.01 over all tests that this file makes, per test after Sidak, as a number of standard deviations.
double sidakDeviations(size_t tests) {
  const double perTest = 1 - std::pow(1 - 0.01, 1 / static_cast<double>(tests));
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) / 2 > perTest ? low : high) = middle;
  }
  return low;
}

// One material and direction on one instruction set and precision, against integrals of the double policy: draws fall
// into cells as the density says, draws that are rejected or take a delta lobe being one more cell; and their mean
// weight is the albedo.
void checkSampling(const BsdfEntries& entries, const BsdfQuery& query, const Direction& wi, const Integrals& integrals,
                   double maxDeviations) {
  const size_t drawn = drawCount(query.precision);
  const auto n = static_cast<double>(drawn);
  const double mirrorPhi = mirrorAzimuth(wi);
  std::vector<size_t> counted(integrals.pdf.size() + 1);
  std::array<double, 3> sum{}, squares{};
  forEachDraw(entries, query, wi, drawn, 7, [&](const BsdfDraw& draw) {
    ++counted[counts(draw) ? cellOf(draw.wo, mirrorPhi) : counted.size() - 1];
    for (size_t k = 0; k < 3 && counts(draw); ++k) {
      sum[k] += draw.weight[k];
      squares[k] += draw.weight[k] * draw.weight[k];
    }
  });
  std::vector<double> expected(integrals.pdf);
  for (double& mass : expected) mass *= n;
  expected.push_back(std::max(0.0, 1 - integrals.total) * n);
  EXPECT_LE(integrals.total, 1 + 1e-3);
  const auto used =
      static_cast<size_t>(std::count_if(expected.begin(), expected.end(), [](double e) { return e > 5; }));
  if (used > 1) {
    EXPECT_LT(chiSquareDeviations(counted, expected), maxDeviations);
  } else {
    EXPECT_EQ(counted.back(), drawn) << "a BSDF of delta lobes alone drew something else";
  }
  for (size_t k = 0; k < 3; ++k) {
    const double mean = sum[k] / n, variance = std::max(0.0, squares[k] / n - mean * mean) / n;
    // Besides noise: what the quadrature of narrow lobes leaves out.
    EXPECT_NEAR(mean, integrals.albedo[k], 5 * std::sqrt(variance) + 1e-3 * integrals.albedo[k] + 1e-9);
  }
}

// The scalar twin and the widest instruction set. The others draw what the twin draws
// (BsdfSymmetryTest.everyInstructionSetAgreesWithTheScalarTwin).
std::vector<Isa> drawnIsas() {
  std::vector<Isa> list{Isa::scalar};
  if (bestIsa() != Isa::scalar) list.push_back(bestIsa());
  return list;
}

// A material on these instruction sets together, because the integrals take longer than the draws.
class BsdfDrawsTest : public testing::TestWithParam<BsdfCase> {};

TEST_P(BsdfDrawsTest, followTheDensityAndAddUpToTheAlbedo) {
  const double maxDeviations = sidakDeviations(integralCount() * kPrecisions.size() * drawnIsas().size());
  for (const Direction& wi : integratedDirections(GetParam())) {
    const BsdfQuery exact{
        .material = &GetParam().record, .compounds = GetParam().compounds, .precision = Precision::doubled};
    const Integrals integrals = integrate(IsaTable<BsdfEntries>::of(bestIsa()), exact, wi);
    for (const Isa isa : drawnIsas()) {
      for (const Precision precision : kPrecisions) {
        SCOPED_TRACE(std::string(toString(isa)) + ", " + std::string(kPrecisionNames[static_cast<size_t>(precision)]) +
                     ", cosine " + std::to_string(wi[2]));
        checkSampling(IsaTable<BsdfEntries>::of(isa),
                      {.material = &GetParam().record, .compounds = GetParam().compounds, .precision = precision}, wi,
                      integrals, maxDeviations);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, BsdfDrawsTest, testing::ValuesIn(integratedCases()), [](const auto& instance) {
  std::string name = instance.param.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

// A draw's weight and densities are those of evaluation, and nothing is drawn where evaluation sees nothing.
TEST_P(BsdfSamplingTest, weightIsValueTimesCosineOverDensity) {
  const BsdfEntries& kernel = entries<BsdfEntries>();
  for (const BsdfCase& bsdf : bsdfCases()) {
    for (const Precision precision : kPrecisions) {
      for (const Walk walk : {Walk::camera, Walk::light}) {
        SCOPED_TRACE(bsdf.name + ", " + std::string(kPrecisionNames[static_cast<size_t>(precision)]));
        const BsdfQuery query{
            .material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision, .walk = walk};
        // Directions carry an error of an ulp of 1, which a lobe of width w amplifies to 1 / w of its value.
        const double tolerance = precision == Precision::doubled ? 1e-7 : 1e-2;
        double sumOfErrors = 0, terms = 0;
        for (const Direction& wi : wiDirections(bsdf)) {
          auto draws = drawSamples(kernel, query, wi, effort(2000, 100), 11);
          std::erase_if(draws, [](const BsdfDraw& d) { return !counts(d); });
          std::vector<Direction> gens;
          gens.reserve(draws.size());
          for (const BsdfDraw& draw : draws) gens.push_back(draw.wo);
          const auto values = evaluate(kernel, query, std::vector<Direction>(gens.size(), wi), gens);
          for (size_t i = 0; i < draws.size(); ++i) {
            ASSERT_NEAR(draws[i].pdf, values[i].pdf, tolerance * values[i].pdf) << draws[i].wo[2];
            ASSERT_NEAR(draws[i].pdfReverse, values[i].pdfReverse, tolerance * values[i].pdfReverse);
            for (size_t k = 0; k < 3; ++k) {
              const double weight = values[i].f[k] * std::abs(gens[i][2]) / values[i].pdf;
              ASSERT_NEAR(draws[i].weight[k], weight, tolerance * weight);
              sumOfErrors += std::abs(draws[i].weight[k] - weight);
              ++terms;
            }
          }
        }
        EXPECT_LE(sumOfErrors, terms * tolerance * 1e-2);
      }
    }
  }
}

// Particle walks carry power: no material returns more than it gets, but for the principled ones, whose lobes add up to
// what their authors liked.
TEST_P(BsdfSamplingTest, noMaterialCreatesEnergy) {
  for (const BsdfCase& bsdf : bsdfCases()) {
    if (bsdf.isAmong(bitOf(BsdfKind::principled) | bitOf(BsdfKind::principledThin))) continue;
    for (const Direction& wi : wiDirections(bsdf)) {
      const BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .walk = Walk::light};
      const auto draws = drawSamples(entries<BsdfEntries>(), query, wi, effort(20000, 500), 3);
      for (size_t k = 0; k < 3; ++k) {
        double sum = 0, squares = 0;
        for (const BsdfDraw& draw : draws) {
          sum += draw.weight[k];
          squares += draw.weight[k] * draw.weight[k];
        }
        const auto n = static_cast<double>(draws.size());
        const double mean = sum / n;
        EXPECT_LE(mean, 1 + 1e-5 + 5 * std::sqrt(std::max(0.0, squares / n - mean * mean) / n)) << bsdf.name;
      }
    }
  }
}

// Mean weight of the draws of delta lobes, and its standard error, per channel.
struct DeltaMean {
  std::array<double, 3> mean{}, error{};
};
DeltaMean deltaMean(const BsdfEntries& entries, const BsdfQuery& query, const Direction& wi) {
  constexpr size_t kDraws = effort(20000, 1000);
  DeltaMean result;
  std::array<double, 3> squares{};
  forEachDraw(entries, query, wi, kDraws, 5, [&](const BsdfDraw& draw) {
    for (size_t k = 0; k < 3 && draw.specular; ++k) {
      result.mean[k] += draw.weight[k] / kDraws;
      squares[k] += draw.weight[k] * draw.weight[k] / kDraws;
    }
  });
  for (size_t k = 0; k < 3; ++k) {
    result.error[k] = std::sqrt(std::max(0.0, squares[k] - result.mean[k] * result.mean[k]) / kDraws);
  }
  return result;
}

// Delta lobes alone: the same light as when all lobes are sampled and the others thrown away, and nothing else.
TEST_P(BsdfSamplingTest, deltaLobesAloneCarryTheirShare) {
  for (const BsdfCase& bsdf : bsdfCases()) {
    for (const Direction& wi : wiDirections(bsdf)) {
      SCOPED_TRACE(bsdf.name);
      const BsdfQuery all{.material = &bsdf.record, .compounds = bsdf.compounds},
          alone{.material = &bsdf.record, .compounds = bsdf.compounds, .specularOnly = true};
      const DeltaMean expected = deltaMean(entries<BsdfEntries>(), all, wi);
      const DeltaMean actual = deltaMean(entries<BsdfEntries>(), alone, wi);
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(actual.mean[k], expected.mean[k], 5 * (actual.error[k] + expected.error[k]) + 1e-5);
      }
      forEachDraw(entries<BsdfEntries>(), alone, wi, effort(1000, 200), 6, [](const BsdfDraw& draw) {
        ASSERT_TRUE(draw.specular || draw.weight[0] + draw.weight[1] + draw.weight[2] == 0);
      });
    }
  }
}

}  // namespace
}  // namespace wavecrest
