// Options of the commands that load a scene: which one, and how it is read.
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct SceneOptions {
  std::string scene, size;
  std::vector<std::string> defines;
  bool lenient = false;
};

void addSceneOptions(const Command& command, SceneOptions& options);

// Loads it; what --lenient skipped goes to stderr. Throws UsageError, or LoadError for a scene that cannot be read.
Scene loadScene(const SceneOptions& options);

}  // namespace wavecrest
