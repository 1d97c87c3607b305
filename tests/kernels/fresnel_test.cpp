// Fresnel reflectances against the textbook formulas in complex double arithmetic.
#include <complex>

#include "tests/kernels/bsdf_cases.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

using Complex = std::complex<double>;

class FresnelTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(FresnelTest);

constexpr std::array kBothPrecisions{Precision::floating, Precision::doubled};
const std::vector<double> kCosines{1e-6, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7071, 0.9, 0.99, 0.9999, 1};

// Mean of |r_s|^2 and |r_p|^2 (Born and Wolf, Principles of Optics, 1.5) for a complex index n of the far side.
double textbook(double cosine, Complex n) {
  const Complex cosT = std::sqrt(1.0 - (1 - cosine * cosine) / (n * n));
  const Complex rs = (cosine - n * cosT) / (cosine + n * cosT), rp = (n * cosine - cosT) / (n * cosine + cosT);
  return (std::norm(rs) + std::norm(rp)) / 2;
}

// Rounding of the policy's numbers, as a share of 1.
double rounding(Precision precision) { return precision == Precision::doubled ? 0x1p-52 : 0x1p-23; }

TEST_P(FresnelTest, dielectricIsTheTextbooks) {
  for (const double eta : {1.0001, 1.0003, 1.33, 1.5, 2.4, 4.0, 1 / 1.0003, 1 / 1.5, 1 / 2.4}) {
    for (const double cosine : kCosines) {
      for (const Precision precision : kBothPrecisions) {
        const double expected = textbook(cosine, eta);
        const double actual = entries<BsdfEntries>().fresnelDielectric(precision, cosine, eta);
        // eta^2 - 1 and the sine lose what eta and the cosine lost when they were rounded: an error of e in eta^2 - 1 +
        // c^2 is e / (2 c) in g. Next to the critical angle that is the square root of e.
        const double g2 = eta * eta - 1 + cosine * cosine;
        const double condition = 1 / std::max(std::sqrt(std::abs(g2)), std::sqrt(rounding(precision)));
        EXPECT_NEAR(actual, expected, 16 * rounding(precision) * condition) << eta << " " << cosine;
      }
    }
  }
}

TEST_P(FresnelTest, conductorIsTheTextbooks) {
  for (const auto& [eta, k] : {std::pair{0.2, 3.4}, {1.66, 9.22}, {0.05, 2.0}, {2.5, 0.5}, {1.0, 1e-3}, {4.0, 4.0}}) {
    for (const double cosine : kCosines) {
      for (const Precision precision : kBothPrecisions) {
        const double expected = textbook(cosine, {eta, k});
        EXPECT_NEAR(entries<BsdfEntries>().fresnelConductor(precision, cosine, eta, k), expected,
                    64 * rounding(precision))
            << eta << " + " << k << " i, " << cosine;
      }
    }
  }
}

TEST_P(FresnelTest, knownValues) {
  const BsdfEntries& kernel = entries<BsdfEntries>();
  for (const Precision precision : kBothPrecisions) {
    const double tolerance = 8 * rounding(precision);
    EXPECT_NEAR(kernel.fresnelDielectric(precision, 1, 1.5), 0.04, tolerance);
    EXPECT_NEAR(kernel.fresnelDielectric(precision, 1, 1 / 1.5), 0.04, tolerance);
    // Brewster's angle: tan = eta; r_p = 0 and r_s = (1 - eta^2) / (1 + eta^2).
    const double brewster = std::cos(std::atan(1.5));
    EXPECT_NEAR(kernel.fresnelDielectric(precision, brewster, 1.5), std::pow(1.25 / 3.25, 2) / 2, tolerance);
    EXPECT_EQ(kernel.fresnelDielectric(precision, 0.5, 1 / 1.5), 1);  // total reflection
    for (const double cosine : {0.0, 1e-6, 0.5, 1.0}) {
      EXPECT_EQ(kernel.fresnelDielectric(precision, cosine, 1), 0) << "no boundary";
      const double mirror = kernel.fresnelConductor(precision, cosine, 0, 1);
      EXPECT_EQ(mirror, 1) << "a perfect mirror";
    }
    EXPECT_NEAR(kernel.fresnelDielectric(precision, 0, 1.5), 1, tolerance);
    EXPECT_NEAR(kernel.fresnelConductor(precision, 1, 0, 5), 1, tolerance);
  }
}

}  // namespace
}  // namespace wavecrest
