// What must hold between the two ways of walking over a BSDF, and between instruction sets.
#include "tests/effort.h"
#include "tests/kernels/bsdf_cases.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

class BsdfSymmetryTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(BsdfSymmetryTest);

constexpr size_t kPairs = effort(4000, 1000);

// How far two computations of one value may lie apart. Part of the error is absolute: 1 - F next to total reflection is
// the rounded difference of numbers near 1.
double tolerated(Precision precision, double value) {
  return precision == Precision::doubled ? 1e-9 * value + 1e-12 : 2e-3 * value + 1e-5;
}

// Index on the side of a direction over the exterior one, for a dielectric or a blend with one.
double sideIndex(const BsdfCase& bsdf, const Direction& d) {
  if (!bsdf.back || d[2] > 0 || bsdf.isAmong(bitOf(BsdfKind::principledThin))) return 1;
  for (const MaterialRecord& part : bsdf.tables->materials) {
    if (part.eta[0] != 0) return part.eta[0];
  }
  return 1;
}

bool isBeckmann(const BsdfCase& bsdf) { return bsdf.name.find("eckmann") != std::string::npos; }

// f(l, e) / eta_e^2 = f(e, l) / eta_l^2 (Veach 1997, 5.2), and pdfReverse is pdf with the directions swapped.
TEST_P(BsdfSymmetryTest, valuesAreReciprocalAndReverseDensitiesAreSwapped) {
  const auto a = randomDirections(kPairs, 1), b = randomDirections(kPairs, 2);
  for (const BsdfCase& bsdf : bsdfCases()) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      SCOPED_TRACE(bsdf.name);
      const BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision};
      const auto forward = evaluate(entries<BsdfEntries>(), query, a, b);
      const auto backward = evaluate(entries<BsdfEntries>(), query, b, a);
      for (size_t i = 0; i < kPairs; ++i) {
        const double eyeA = std::pow(sideIndex(bsdf, a[i]), 2), eyeB = std::pow(sideIndex(bsdf, b[i]), 2);
        // Light goes through a sheet by a rule that tells the eye's side from the light's (bsdf_principled_thin.h).
        const bool ordered = bsdf.isAmong(bitOf(BsdfKind::principledThin)) && a[i][2] * b[i][2] < 0;
        for (size_t k = 0; k < 3 && !ordered; ++k) {
          const double left = forward[i].f[k] / eyeA, right = backward[i].f[k] / eyeB;
          ASSERT_NEAR(left, right, tolerated(precision, right));
        }
        ASSERT_NEAR(forward[i].pdfReverse, backward[i].pdf, tolerated(precision, backward[i].pdf));
        ASSERT_NEAR(forward[i].pdf, backward[i].pdfReverse, tolerated(precision, forward[i].pdf));
      }
    }
  }
}

// The value does not depend on who asks: wi as the eye's side on a camera walk is wo on a light walk.
TEST_P(BsdfSymmetryTest, bothWalksSeeTheSameValue) {
  const auto eye = randomDirections(kPairs, 3), light = randomDirections(kPairs, 4);
  for (const BsdfCase& bsdf : bsdfCases()) {
    SCOPED_TRACE(bsdf.name);
    BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .precision = Precision::doubled};
    const auto fromCamera = evaluate(entries<BsdfEntries>(), query, eye, light);
    query.walk = Walk::light;
    const auto fromLight = evaluate(entries<BsdfEntries>(), query, light, eye);
    for (size_t i = 0; i < kPairs; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(fromCamera[i].f[k], fromLight[i].f[k], tolerated(query.precision, fromCamera[i].f[k]));
      }
      ASSERT_NEAR(fromCamera[i].pdf, fromLight[i].pdfReverse, tolerated(query.precision, fromCamera[i].pdf));
    }
  }
}

// A delta lobe's reverse probability is the probability of the way back, and the way back undoes the change of index.
TEST_P(BsdfSymmetryTest, deltaLobesLeadBack) {
  for (const BsdfCase& bsdf : bsdfCases()) {
    SCOPED_TRACE(bsdf.name);
    // Several parts of these lead into the same direction, with probabilities of their own.
    if (bsdf.isAmong(kBlendKinds) && bsdf.name != "blendGlass") continue;
    const BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .precision = Precision::doubled};
    for (const Direction& wi : wiDirections(bsdf)) {
      for (const BsdfDraw& draw : drawSamples(entries<BsdfEntries>(), query, wi, effort(200, 20), 8)) {
        if (!draw.specular || draw.weight[0] == 0) continue;
        bool found = false;
        for (const BsdfDraw& back : drawSamples(entries<BsdfEntries>(), query, draw.wo, 200, 9)) {
          if (!back.specular || dot(back.wo, wi) < 1 - 1e-9) continue;
          found = true;
          ASSERT_NEAR(draw.pdfReverse, back.pdf, 1e-9);
          ASSERT_NEAR(draw.etaRatio * back.etaRatio, 1, 1e-9);
          ASSERT_NEAR(draw.weight[0] * back.weight[0] * draw.pdf * back.pdf,
                      std::pow(draw.weight[0] * draw.pdf / (draw.etaRatio * draw.etaRatio), 2), 1e-6);
        }
        if (draw.pdf > 0.05 && draw.wo[2] * wi[2] != 0 && (bsdf.back || wi[2] > 0) && (bsdf.back || draw.wo[2] > 0)) {
          ASSERT_TRUE(found);
        }
      }
    }
  }
}

// Every instruction set against the scalar twin: fused multiply-adds aside, the same arithmetic. Narrow lobes amplify
// an ulp of the directions, hence two bounds: one on the worst, one on the mean over all pairs.
TEST_P(BsdfSymmetryTest, everyInstructionSetAgreesWithTheScalarTwin) {
  for (const BsdfCase& bsdf : bsdfCases()) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      SCOPED_TRACE(bsdf.name + std::to_string(static_cast<int>(precision)));
      const BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision};
      // Beckmann's exact masking takes its error function in float, whatever the precision.
      const bool inFloat = precision != Precision::doubled || isBeckmann(bsdf);
      const Precision rounding = inFloat && precision == Precision::doubled ? Precision::floating : precision;
      const double ulp = inFloat ? 0x1p-23 : 0x1p-52;
      const auto wi = randomDirections(kPairs, 5), wo = randomDirections(kPairs, 6);
      const auto values = evaluate(entries<BsdfEntries>(), query, wi, wo);
      const auto expected = evaluate(twin<BsdfEntries>(), query, wi, wo);
      double sum = 0;
      for (size_t i = 0; i < kPairs; ++i) {
        ASSERT_NEAR(values[i].pdf, expected[i].pdf, tolerated(rounding, expected[i].pdf)) << i;
        ASSERT_NEAR(values[i].f[0], expected[i].f[0], tolerated(rounding, expected[i].f[0])) << i;
        sum += std::abs(values[i].pdf - expected[i].pdf) / std::max(expected[i].pdf, 1e-3);
      }
      EXPECT_LE(sum / kPairs, 16 * ulp);

      // Draws: a number that lies within rounding of a lobe's probability may go either way.
      std::vector<BsdfDraw> draws(kPairs), twins(kPairs);
      const auto u = randomDraws(kPairs, 10);
      entries<BsdfEntries>().sample(query, wi, u, draws.data());
      twin<BsdfEntries>().sample(query, wi, u, twins.data());
      // Beckmann's slopes are drawn in float under every precision.
      const double drawUlp = isBeckmann(bsdf) ? 0x1p-23 : ulp;
      size_t otherLobe = 0;
      for (size_t i = 0; i < kPairs; ++i) {
        const bool drawn = draws[i].weight[0] > 0, drawnByTwin = twins[i].weight[0] > 0;
        if (drawn != drawnByTwin || (drawn && dot(draws[i].wo, twins[i].wo) < 0.99)) {
          ++otherLobe;
          continue;
        }
        if (!drawn) continue;
        for (size_t k = 0; k < 3; ++k) ASSERT_NEAR(draws[i].wo[k], twins[i].wo[k], 4096 * drawUlp) << i;
      }
      EXPECT_LE(otherLobe, 4u);
    }
  }
}

}  // namespace
}  // namespace wavecrest
