// Error at equal time: what counts in the end is how good the image is after a given time, not how many paths it took.
//
// The reference is rendered at the beginning, in two halves of different seeds; half the distance between them is its
// own noise. A mean square error against the reference contains that noise, so it is subtracted again: without it an
// error near the reference's would be overstated.
#pragma once

#include <vector>

#include "engine/session/session.h"
#include "metrics/image/image.h"

namespace wavecrest {

struct NoisyReference {
  Method method{};
  bool biased = false;  // by merging (ReferenceChoice)
  Image image;
  double noise = 0;  // relMSE of the image against the unknown truth, expected
  double seconds = 0;
};

struct ErrorAtTime {
  double seconds = 0, cpuSeconds = 0;
  double samplesPerPixel = 0;
  double relmse = 0;      // reference's noise subtracted, not below zero
  double efficiency = 0;  // 1 / (relmse * CPU seconds); 0 where the error is lost in the reference's noise
};

struct ErrorRow {
  Method method{};
  SamplerKind sampler{};
  std::vector<ErrorAtTime> points;  // at a quarter, half and all of the time
};

// By the method that `inspect` names for the scene, whatever the settings' own is.
NoisyReference renderReference(const Scene& scene, const RenderSettings& settings, double seconds);

// Every method with every sampler, each for the same render time.
std::vector<ErrorRow> measureEqualTime(const Scene& scene, const RenderSettings& settings,
                                       const std::vector<Method>& methods, const NoisyReference& reference,
                                       double seconds);

}  // namespace wavecrest
