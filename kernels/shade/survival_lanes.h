// Russian roulette of walks: the probability with which a path survives (METHODS 1.5).
#pragma once

#include "kernels/columns/survival.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// Survival probability by the rule; none: by throughput. carried: what is left of the path's throughput, in the scale
// that makes it comparable with 1: refraction's change of radiance says nothing about the light that the path can still
// carry. before: the same before the vertex.
//
// One in twenty paths ends at each vertex however bright the surfaces are, which is what ends walks within glass. At
// albedos above sqrt(0.95) that rate alone would make throughputs grow faster than paths die: variance without end, and
// images that are too dark but for rare fireflies. From kBrightest on, the rate therefore falls as the throughput
// grows.
template <class Real>
WAVECREST_INLINE Real survival(const SurvivalRule* rule, Real carried, Real before) {
  constexpr float kMost = 0.95f, kBrightest = 4;
  Real measure = carried;
  if (rule != nullptr) measure = carried * (rule->byAlbedo ? reciprocal(before) : Real(rule->scale));
  Real q = min(max(measure, Real(0.05f)), Real(kMost));
  const Mask bright = carried > Real(kBrightest);
  if (any(bright)) q = select(bright, Real(1) - Real((1 - kMost) * kBrightest) * reciprocal(carried), q);
  return q;
}

WAVECREST_SIMD_END
