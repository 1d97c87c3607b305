// From a render's options, in words, to the engine's settings.
#pragma once

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"
#include "wavecrest/render_options.h"

namespace wavecrest {

// What the options leave open comes from the scene and the machine. Throws UsageError.
RenderSettings renderSettings(const api::RenderOptions& options, const Scene& scene);

}  // namespace wavecrest
