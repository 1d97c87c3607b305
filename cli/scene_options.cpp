#include "cli/scene_options.h"

#include <fmt/core.h>

#include "cli/commands.h"
#include "cli/file_check.h"
#include "engine/load/load.h"
#include "engine/scene/scene_error.h"
#include "library/campaign_rows.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {

void addSceneOptions(const Command& command, SceneOptions& options) {
  command.add("scene", options.scene, "built-in scene, path of an XML file, or - for stdin").required();
  command.add("--size", options.size, "film size, WIDTHxHEIGHT");
  command.add("-D", options.defines, "value of a scene's $name: NAME=VALUE").repeatable();
  command.addFlag("--lenient", options.lenient, "skip what a scene asks and wavecrest lacks, with a warning");
}

Scene loadScene(const SceneOptions& options, ProgressKind kind) {
  LoadOptions load;
  load.lenient = options.lenient;
  load.keepAll = options.keepAll;
  if (!options.size.empty()) load.filmSize = parseSize("--size", options.size);
  load.defines = parseDefinitions(options.defines);
  Scene scene = loadScene(findScene(options.scene), load);
  for (const std::string& warning : scene.warnings) warn(kind, warning);
  if (scene.emitters.empty()) warn(kind, fmt::format("{}: the scene has no light; its image is black", options.scene));
  return scene;
}

std::string stemOf(const SceneOptions& options) {
  return options.scene == kStandardStream ? "stdin" : findScene(options.scene).stem().string();
}

void printNotes(const std::vector<Note>& notes, ProgressKind kind) {
  for (const Note& one : notes) note(kind, toString(one));
}

}  // namespace wavecrest
