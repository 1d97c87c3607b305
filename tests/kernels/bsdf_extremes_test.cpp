// The ends of every parameter's range: results stay finite, and nothing jumps where one kind of kernel takes over from
// another.
#include "tests/effort.h"
#include "tests/kernels/bsdf_cases.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

class BsdfExtremesTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(BsdfExtremesTest);

constexpr double kEtas[] = {0.9999, 1, 1 + 1e-6, 1 + 1e-4, 1.0003, 1.5, 2.4, 4};
constexpr double kAlphas[] = {0, 1e-6, 1e-4, 1e-3, 0.01, 0.5, 1};

// Two roughnesses, and every parameter of the principled BSDFs at either end.
void appendExtremeCompounds(std::vector<BsdfCase>& cases) {
  // Colours outside of Rec. 709 have negative channels.
  Principled outside = principledGlass();
  outside.baseColor = rgb(-0.01, 0.5, 0.3);
  cases.push_back(bsdfCase("principled negative", outside, true));
  for (const Distribution distribution : {Distribution::ggx, Distribution::beckmann}) {
    Conductor metal = aluminium(1e-4, distribution);
    metal.alphaV = TexturedFloat{1};
    cases.push_back(bsdfCase("brushed", metal));
    Dielectric ice = glass(1, 1.5, distribution);
    ice.alphaV = TexturedFloat{1e-4};
    cases.push_back(bsdfCase("brushed glass", ice, true));
  }
  for (const double roughness : {0.0, 1.0}) {
    for (const double eta : {0.7, 1.0, 1.001, 2.0}) {
      for (const double other : {0.0, 1.0}) {
        for (const double transmits : {0.0, 1.0}) {
          Principled all{.baseColor = rgb(0, 0.5, 1), .eta = eta, .roughness = {roughness}, .specTrans = {transmits}};
          all.anisotropic = all.specTint = all.sheen = all.sheenTint = all.flatness = all.clearcoat =
              all.clearcoatGloss = TexturedFloat{other};
          const std::string name = " " + std::to_string(roughness) + " " + std::to_string(eta);
          cases.push_back(bsdfCase("principled" + name, all, transmits > 0));
          all.thin = true;
          all.diffTrans = TexturedFloat{2 * other};
          cases.push_back(bsdfCase("sheet" + name, all, true));
        }
      }
    }
  }
}

std::vector<BsdfCase> extremeCases() {
  std::vector<BsdfCase> cases;
  appendExtremeCompounds(cases);
  for (const Distribution distribution : {Distribution::ggx, Distribution::beckmann}) {
    for (const double alpha : kAlphas) {
      const std::string name = " alpha " + std::to_string(alpha);
      cases.push_back(bsdfCase("metal" + name, aluminium(alpha, distribution)));
      for (const double eta : kEtas) {
        const std::string both = name + " eta " + std::to_string(eta);
        cases.push_back(bsdfCase("glass" + both, glass(alpha, eta, distribution), true));
        cases.push_back(bsdfCase("plastic" + both, plastic(alpha, eta, distribution)));
        if (alpha == 0) {
          cases.push_back(bsdfCase("pane" + both, Dielectric{.intIor = eta, .extIor = 1, .thin = true}, true));
        }
      }
    }
  }
  for (const double exponent : {0.0, 1.0, 30.0, 1e4, 1e6}) {
    cases.push_back(bsdfCase("phong " + std::to_string(exponent), phong(exponent)));
  }
  for (const double rho : {0.0, 1 - 1e-6, 1.0}) {
    cases.push_back(bsdfCase("diffuse " + std::to_string(rho), Diffuse{rgb(rho, rho, rho)}));
    Plastic bright = plastic(0.1);
    bright.diffuseReflectance = bright.specularReflectance = rgb(rho, rho, rho);
    for (const bool nonlinear : {false, true}) {
      bright.nonlinear = nonlinear;
      for (const double alpha : {0.0, 0.1}) {
        bright.alpha = {alpha};
        cases.push_back(bsdfCase("bright plastic", bright));
      }
    }
    cases.push_back(bsdfCase("opacity " + std::to_string(rho), Diffuse{rgb(0.5, 0.5, 0.5)}, false, rho));
  }
  return cases;
}

std::vector<Direction> extremeDirections() {
  std::vector<Direction> directions{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
  for (const double cosine : {1e-6, 1e-3, 0.1, 0.7453559925, 0.9, 1 - 1e-7}) {  // the fourth: critical for eta = 1.5
    for (const double sign : {1.0, -1.0}) {
      const double sine = std::sqrt(1 - cosine * cosine);
      directions.push_back({sine * 0.6, sine * 0.8, sign * cosine});
      directions.push_back({-sine * 0.6, -sine * 0.8, sign * cosine});
    }
  }
  return directions;
}

bool finite(const std::array<double, 3>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x) && std::abs(x) < 1e30; });
}

TEST_P(BsdfExtremesTest, everythingIsFinite) {
  const auto directions = extremeDirections();
  std::vector<std::array<float, 3>> draws = randomDraws(24, 3);
  const float last = 1 - 0x1p-24f;
  for (const float a : {0.0f, last}) {
    for (const float b : {0.0f, 0.5f, last}) draws.push_back({a, b, b});
  }
  const std::vector<BsdfCase> cases = extremeCases();
  for (size_t i = 0; i < cases.size(); i += effort(1, 3)) {
    const BsdfCase& bsdf = cases[i];
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      for (const Walk walk : {Walk::camera, Walk::light}) {
        const BsdfQuery query{
            .material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision, .walk = walk};
        for (const Direction& wi : directions) {
          const auto values =
              evaluate(entries<BsdfEntries>(), query, std::vector<Direction>(directions.size(), wi), directions);
          for (size_t k = 0; k < values.size(); ++k) {
            ASSERT_TRUE(finite(values[k].f)) << bsdf.name << " " << wi[2] << " " << directions[k][2];
            ASSERT_TRUE(finite({values[k].pdf, values[k].pdfReverse, 0})) << bsdf.name << " " << wi[2];
            ASSERT_GE(values[k].pdf, 0) << bsdf.name;
          }
          std::vector<BsdfDraw> drawn(draws.size());
          entries<BsdfEntries>().sample(query, std::vector<Direction>(draws.size(), wi), draws, drawn.data());
          for (const BsdfDraw& draw : drawn) {
            ASSERT_TRUE(finite(draw.weight)) << bsdf.name << " " << wi[2];
            if (std::ranges::max(draw.weight) == 0) continue;
            ASSERT_TRUE(finite(draw.wo) && finite({draw.pdf, draw.pdfReverse, draw.etaRatio})) << bsdf.name;
            ASSERT_NEAR(dot(draw.wo, draw.wo), 1, 1e-5) << bsdf.name << " " << wi[2];
            ASSERT_GT(draw.pdf, 0) << bsdf.name << " " << wi[2];
          }
        }
      }
    }
  }
}

// Where draws of one material go on average, and with what weight.
struct Average {
  double weight = 0, cosine = 0;
};
Average averageOf(const BsdfEntries& entries, const BsdfCase& bsdf, const Direction& wi) {
  Average average;
  constexpr size_t kDraws = effort(20000, 1000);
  forEachDraw(entries, {.material = &bsdf.record, .compounds = bsdf.compounds}, wi, kDraws, 4,
              [&](const BsdfDraw& draw) {
                average.weight += draw.weight[0] / kDraws;
                average.cosine += draw.weight[0] * draw.wo[2] / kDraws;
              });
  return average;
}

void expectContinuous(const BsdfEntries& entries, const BsdfCase& below, const BsdfCase& above, double tolerance) {
  for (const Direction& wi : wiDirections(below)) {
    const Average a = averageOf(entries, below, wi), b = averageOf(entries, above, wi);
    EXPECT_NEAR(a.weight, b.weight, tolerance) << below.name << " " << wi[2];
    EXPECT_NEAR(a.cosine, b.cosine, tolerance) << below.name << " " << wi[2];
  }
}

TEST_P(BsdfExtremesTest, roughBecomesSmoothWithoutAJump) {
  const BsdfEntries& kernel = entries<BsdfEntries>();
  const double below = kSmallestAlpha * 0.999, above = kSmallestAlpha * 1.001;
  for (const Distribution distribution : {Distribution::ggx, Distribution::beckmann}) {
    // The same numbers choose the lobes on either side, so what remains is the lobe's width.
    expectContinuous(kernel, bsdfCase("metal", aluminium(below, distribution)),
                     bsdfCase("metal", aluminium(above, distribution)), 2e-3);
    expectContinuous(kernel, bsdfCase("glass", glass(below, 1.5, distribution), true),
                     bsdfCase("glass", glass(above, 1.5, distribution), true), 5e-3);
  }
}

TEST_P(BsdfExtremesTest, aMatchedIndexLetsEverythingPass) {
  const BsdfEntries& kernel = entries<BsdfEntries>();
  // A narrow lobe: a wide one would lose to shadowing what a boundary that is not there does not.
  expectContinuous(kernel, bsdfCase("glass", glass(0.01, 1 + 0.999e-4), true),
                   bsdfCase("glass", glass(0.01, 1 + 1.001e-4), true), 1e-2);
  const BsdfCase matched = bsdfCase("matched", glass(0, 1), true);
  for (const Direction& wi : wiDirections(matched)) {
    for (const BsdfDraw& draw : drawSamples(kernel, {.material = &matched.record}, wi, 100, 2)) {
      EXPECT_NEAR(dot(draw.wo, wi), -1, 1e-6);
      EXPECT_NEAR(draw.weight[0], 1, 1e-6);
    }
  }
  // Where light is refracted, not even rounding makes the index of a principled BSDF 1.
  for (const double eta : {1 - 1e-8, 1.0, 1 + 1e-8}) {
    const Principled clear{.baseColor = rgb(1, 1, 1), .eta = eta, .roughness = {0.1}, .specTrans = {1}};
    const BsdfCase bsdf = bsdfCase("principled", clear, true);
    for (const double side : {1.0, -1.0}) EXPECT_GT(averageOf(kernel, bsdf, {0, 0, side}).weight, 0.9) << eta;
  }
}

// The half vectors of the narrowest clear coat, alpha 0.001, are so close to the normal that 1 - cos^2 has few digits
// in float: the density needs sin^2.
TEST_P(BsdfExtremesTest, aGlossyCoatKeepsItsDigitsInFloat) {
  const BsdfCase bsdf = bsdfCase("coat", Principled{.clearcoat = {1}, .clearcoatGloss = {1}});
  const auto drawn = [&](Precision precision) {
    const BsdfQuery query{.material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision};
    return drawSamples(entries<BsdfEntries>(), query, fromAngles(0.9, 4.0), 2000, 5);
  };
  const std::vector<BsdfDraw> inFloat = drawn(Precision::floating), inDouble = drawn(Precision::doubled);
  for (size_t i = 0; i < inFloat.size(); ++i) {
    EXPECT_NEAR(inFloat[i].pdf, inDouble[i].pdf, 1e-2 * inDouble[i].pdf) << i;
  }
}

}  // namespace
}  // namespace wavecrest
