// Settings for tests of Metropolis light transport: a small film, and chains that a test can afford.
#pragma once

#include "tests/engine/render_statistics.h"

namespace wavecrest {

constexpr uint32_t kWidth = 32, kHeight = 24;

inline RenderSettings defaults() {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  // Few and short bootstraps, so that an error in what chains start from would show.
  settings.metropolis.chains = 512;
  settings.metropolis.bootstrapSamples = 16384;
  return settings;
}

inline RenderSettings metropolis(MetropolisVariant variant) {
  RenderSettings settings = defaults();
  settings.method = Method::mlt;
  settings.metropolis.variant = variant;
  return settings;
}

}  // namespace wavecrest
