// A scene that renders in no time, and the least that a render must be told.
#pragma once

#include "engine/load/load.h"
#include "engine/plan/render_settings.h"
#include "scenes/scene_list.h"

namespace wavecrest {

inline Scene smallBox(uint32_t width, uint32_t height) {
  LoadOptions options;
  options.filmSize = {width, height};
  return loadScene(findScene("cornell-diffuse"), options);
}

inline RenderSettings settingsOf(Method method, uint64_t seed = 0) {
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.method = method;
  settings.seed = seed;
  return settings;
}

}  // namespace wavecrest
