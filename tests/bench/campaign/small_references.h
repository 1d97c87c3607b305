// What tests that render references share: a scene with a small film, settings that a test can afford, and their goal.
#pragma once

#include "bench/campaign/render_reference.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"

namespace wavecrest::test {

inline Scene sceneOf(uint32_t width, uint32_t height, const char* name = "cornell-diffuse") {
  LoadOptions options;
  options.filmSize = {{width, height}};
  return loadScene(findScene(name), options);
}

inline RenderSettings settingsOf(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.threads = 2;
  return settings;
}

// So many iterations of each half.
inline ReferenceGoal iterations(uint64_t count) {
  return {.relativeError = std::nullopt, .seconds = std::nullopt, .iterations = count};
}

}  // namespace wavecrest::test
