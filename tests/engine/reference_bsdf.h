// Densities of BSDF sampling in scalar double code that shares nothing with the kernels: diffuse, Phong, smooth and
// rough (GGX) conductor, smooth dielectric and smooth plastic. From the papers that the kernels cite.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/vector_math.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// A vertex as sampling sees it. The normal is the shading normal, on the side that the material calls outside.
struct ReferenceBsdf {
  const MaterialRecord* material;
  Double3 normal;

  static ReferenceBsdf facing(const MaterialRecord& material, const Double3& normal, const Double3& wi) {
    const bool turned = (material.flags & kTwoSided) != 0 && dot(normal, wi) < 0;
    return {&material, turned ? normal * -1.0 : normal};
  }

  // Of wo per solid angle given wi, by the lobes that are not deltas.
  double pdfW(const Double3& wi, const Double3& wo) const {
    const double cosWi = dot(wi, normal), cosWo = dot(wo, normal);
    switch (static_cast<BsdfKind>(material->kind)) {
      case BsdfKind::diffuse:
        return cosWi > 0 && cosWo > 0 ? cosWo / std::numbers::pi : 0;
      case BsdfKind::phong: {
        if (cosWi <= 0 || cosWo <= 0) return 0;
        const Double3 mirrored = normal * (2 * cosWi) - wi;
        const double lobe = std::pow(std::max(dot(mirrored, wo), 0.0), double{material->alpha});
        const double pick = material->specularPick;
        return pick * (material->alpha + 1) / (2 * std::numbers::pi) * lobe + (1 - pick) * cosWo / std::numbers::pi;
      }
      case BsdfKind::roughConductor: {  // G1(wi) D(m) / (4 cos wi)
        if (cosWi <= 0 || cosWo <= 0) return 0;
        const double alpha2 = double{material->alpha} * material->alpha;
        const double cosM = dot(normalized(wi + wo), normal);
        const double bracket = cosM * cosM * (alpha2 - 1) + 1;
        const double d = alpha2 / (std::numbers::pi * bracket * bracket);
        const double g1 = 2 * cosWi / (cosWi + std::sqrt(alpha2 + (1 - alpha2) * cosWi * cosWi));
        return g1 * d / (4 * cosWi);
      }
      case BsdfKind::plastic:
        return cosWi > 0 && cosWo > 0 ? (1 - plasticPick(cosWi)) * cosWo / std::numbers::pi : 0;
      case BsdfKind::conductor:
      case BsdfKind::dielectric:
        return 0;
      default:
        ADD_FAILURE() << "no reference for BSDF kind " << material->kind;
        return 0;
    }
  }

  // Of the delta lobe that leads from wi to wo: the factor that stands for its density. Densities of a path that
  // differ in the end from which the vertex is sampled contain the same delta function if it is written in the measure
  // eta^2 cos dw, which reflection and refraction preserve: P eta_wo^2 cos_wo remains.
  double specularDensity(const Double3& wi, const Double3& wo) const {
    const double cosWi = dot(wi, normal), cosWo = dot(wo, normal);
    const double eta = material->eta[0];
    switch (static_cast<BsdfKind>(material->kind)) {
      case BsdfKind::conductor:
        return std::abs(cosWo);
      case BsdfKind::plastic:
        return plasticPick(cosWi) * std::abs(cosWo);
      case BsdfKind::dielectric: {
        const double reflectance = fresnel(std::abs(cosWi), cosWi > 0 ? eta : 1 / eta);
        const double etaWo = cosWo > 0 ? 1 : eta;
        const double pick = cosWi * cosWo > 0 ? reflectance : 1 - reflectance;
        return pick * etaWo * etaWo * std::abs(cosWo);
      }
      default:
        ADD_FAILURE() << "no delta lobe in BSDF kind " << material->kind;
        return 0;
    }
  }

 private:
  // eta: far index over near index.
  static double fresnel(double cosine, double eta) {
    const double sin2 = (1 - cosine * cosine) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double cosT = std::sqrt(1 - sin2);
    const double rs = (cosine - eta * cosT) / (cosine + eta * cosT), rp = (eta * cosine - cosT) / (eta * cosine + cosT);
    return (rs * rs + rp * rp) / 2;
  }
  double plasticPick(double cosine) const {
    const double f = fresnel(std::abs(cosine), material->eta[0]), w = material->specularPick;
    return f * w / (f * w + (1 - f) * (1 - w));
  }
};

}  // namespace wavecrest
