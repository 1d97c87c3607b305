// wavecrest inspect --guide: a picture of what guided path tracing has learned for what a pixel sees.
#pragma once

#include <string>

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct GuideOptions {
  std::string pixel{};   // X,Y from the upper left corner of the image; empty: no picture
  std::string time{};    // of learning; empty: 10 s
  std::string output{};  // .exr or .pfm has densities, .png is scaled so that the greatest is white
};

// Renders the scene by gpt for the given time, prints what was learned, and writes the picture: directions laid out as
// in Mitsuba's environment maps, values in draws per steradian. Throws UsageError,
// and InputError where the pixel sees no rough surface.
void writeGuidePicture(const Scene& scene, RenderSettings settings, const GuideOptions& options);

}  // namespace wavecrest
