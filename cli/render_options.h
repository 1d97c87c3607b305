// The options of `wavecrest render`, and the engine's settings that follow from them.
#pragma once

#include <string>
#include <vector>

#include "cli/checkpointing.h"
#include "cli/command_line.h"
#include "cli/live_render.h"
#include "cli/scene_options.h"
#include "cli/until_goal.h"
#include "library/render_settings.h"

namespace wavecrest {

// The library's options of a render, and those that only the command line has.
struct RenderOptions : api::RenderOptions {
  SceneOptions scene;
  std::string part, snapshotEvery, stats, progress = "auto";
  std::vector<std::string> outputs;
  double exposure = 0;  // stops, of PNG
  bool dryRun = false, pin = false, quiet = false, partial = false;
  CheckpointOptions checkpoint;
  UntilRequest until;
  LiveOptions live;
};

// Adds all of them to the command, which keeps references to `options`.
void addRenderOptions(const Command& command, RenderOptions& options);

// The engine's settings: what the options leave open comes from the scene and the machine. Stages are timed only where
// statistics are written. Throws UsageError for options that do not go together.
RenderSettings settingsOfRender(const RenderOptions& options, const Scene& scene);

}  // namespace wavecrest
