// From a render's options, in words, to the engine's settings.
#pragma once

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"
#include "wavecrest/render_options.h"

namespace wavecrest {

// What the options leave open comes from the scene and the machine. Throws UsageError, also for an option that the
// method would ignore; the default of an option fits every method.
RenderSettings renderSettings(const api::RenderOptions& options, const Scene& scene);

// The same of an inspection, which is about all methods and takes the options of each. Throws UsageError.
RenderSettings inspectionSettings(const api::RenderOptions& options, const Scene& scene);

}  // namespace wavecrest
