#include "engine/compile/rough_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// Nodes of the quadrature over normals. With twice as many, values change by less than 1e-4; at grazing incidence on
// narrow lobes (alpha = 0.05) by 2e-3.
constexpr int kSlopeSteps = 192, kAzimuthSteps = 32;
// Stands for mu = 0.
constexpr double kGrazing = 1e-6;

// Smith's G1 of a direction with the given cosine (kernels/bsdf/microfacet_lanes.h, beckmann_lanes.h).
double smithG1(const RoughBoundary& boundary, double cosine) {
  const double z = std::abs(cosine);
  const double tangent = std::sqrt(std::max(0.0, 1 - z * z)) / z;
  if (boundary.distribution == Distribution::ggx) {
    return 2 / (1 + std::sqrt(1 + boundary.alpha * boundary.alpha * tangent * tangent));
  }
  const double a = 1 / (boundary.alpha * tangent);
  return a >= 1.6 ? 1 : (3.535 + 2.181 * a) * a / (1 + (2.276 + 2.577 * a) * a);
}

struct Fresnel {
  double reflectance, cosT;  // cosT = 0: total reflection
};
Fresnel fresnel(double cosI, double eta) {
  const double cos2T = 1 - (1 - cosI * cosI) / (eta * eta);
  if (cos2T <= 0) return {1, 0};
  const double cosT = std::sqrt(cos2T);
  const double rs = (cosI - eta * cosT) / (cosI + eta * cosT), rp = (eta * cosI - cosT) / (eta * cosI + cosT);
  return {0.5 * (rs * rs + rp * rp), cosT};
}

// The mean over visible normals m of share(F, cos theta_t, v.m, m_z). With m drawn from D(m) m_z, by inversion of
// u -> tan(theta_m), a visible normal counts G1(v) (v.m) / (v_z m_z). u = 1 - (1-s^2)^2 spreads the nodes so that the
// integrand is smooth at either end.
template <class Share>
double meanOverNormals(const RoughBoundary& boundary, double mu, Share&& share) {
  const double sinI = std::sqrt(std::max(0.0, 1 - mu * mu));
  double sum = 0;
  for (int i = 0; i < kSlopeSteps; ++i) {
    const double s = (i + 0.5) / kSlopeSteps;
    const double rest = (1 - s * s) * (1 - s * s);  // 1 - u
    const double density = 4 * s * (1 - s * s);     // du/ds
    const double tan2 = boundary.distribution == Distribution::ggx ? (1 - rest) / rest : -std::log(rest);
    const double tangent = boundary.alpha * std::sqrt(tan2), mz = 1 / std::sqrt(1 + tangent * tangent);
    for (int j = 0; j < kAzimuthSteps; ++j) {  // symmetric: half of the circle
      const double slope = tangent * std::cos(std::numbers::pi * (j + 0.5) / kAzimuthSteps);
      const double cosI = (mu + sinI * slope) * mz;
      if (cosI <= 0) continue;
      sum += density * cosI / mz * share(fresnel(cosI, boundary.eta), cosI, mz);
    }
  }
  return sum * smithG1(boundary, mu) / (mu * kSlopeSteps * kAzimuthSteps);
}

double nodeOf(size_t i) { return std::max(kGrazing, static_cast<double>(i) / (kTransmittanceSize - 1)); }

}  // namespace

double RoughBoundary::transmittance(double mu) const {
  return meanOverNormals(*this, mu, [&](const Fresnel& f, double cosI, double mz) {
    const double z = (mz * (cosI - eta * f.cosT) - mu) / eta;  // of the refracted direction
    return z < 0 && f.cosT > 0 ? (1 - f.reflectance) * smithG1(*this, z) : 0.0;
  });
}

double RoughBoundary::reflectance(double mu) const {
  return meanOverNormals(*this, mu, [&](const Fresnel& f, double cosI, double mz) {
    const double z = 2 * cosI * mz - mu;  // of the reflected direction
    return z > 0 ? f.reflectance * smithG1(*this, z) : 0.0;
  });
}

std::array<float, kTransmittanceSize> transmittanceTable(const RoughBoundary& boundary) {
  std::array<float, kTransmittanceSize> table{};
  for (size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(std::min(boundary.transmittance(nodeOf(i)), 1.0));
  return table;
}

double internalReflectance(const RoughBoundary& boundary) {
  const RoughBoundary fromWithin{boundary.distribution, boundary.alpha, 1 / boundary.eta};
  double sum = 0;
  for (size_t i = 0; i < kTransmittanceSize; ++i) sum += 2 * nodeOf(i) * fromWithin.reflectance(nodeOf(i));
  return sum / kTransmittanceSize;
}

}  // namespace wavecrest
