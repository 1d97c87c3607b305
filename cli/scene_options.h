// Options of the commands that load a scene: which one, and how it is read.
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/progress.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct SceneOptions {
  std::string scene{}, size{};
  std::vector<std::string> defines{};
  bool lenient = false;
  bool keepAll = false;  // LoadOptions::keepAll; not an option of the command line
};

void addSceneOptions(const Command& command, SceneOptions& options);

// Loads it; what --lenient skipped, and that nothing shines, goes to stderr. Throws UsageError, or LoadError for a
// scene that cannot be read.
Scene loadScene(const SceneOptions& options, ProgressKind kind = ProgressKind::automatic);

// What files without a name of their own are called after: the stem of the scene's file, or stdin.
std::string stemOf(const SceneOptions& options);

// One a line on stderr, unless quiet.
void printNotes(const std::vector<Note>& notes, ProgressKind kind);
inline void printNotes(const Scene& scene, ProgressKind kind) { printNotes(scene.notes, kind); }

}  // namespace wavecrest
