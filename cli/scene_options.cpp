#include "cli/scene_options.h"

#include <fmt/core.h>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"

namespace wavecrest {

void addSceneOptions(const Command& command, SceneOptions& options) {
  command.add("scene", options.scene, "built-in scene or path of an XML file").required();
  command.add("--size", options.size, "film size, WIDTHxHEIGHT");
  command.add("-D", options.defines, "value of a scene's $name: NAME=VALUE").repeatable();
  command.addFlag("--lenient", options.lenient, "skip what a scene asks and wavecrest lacks, with a warning");
}

Scene loadScene(const SceneOptions& options) {
  LoadOptions load;
  load.lenient = options.lenient;
  if (!options.size.empty()) load.filmSize = parseSize(options.size);
  for (const std::string& define : options.defines) {
    const size_t equals = define.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError(fmt::format("-D {}: expected NAME=VALUE", define));
    }
    load.defines[define.substr(0, equals)] = define.substr(equals + 1);
  }
  Scene scene = loadScene(findScene(options.scene), load);
  for (const std::string& warning : scene.warnings) fmt::print(stderr, "wavecrest: warning: {}\n", warning);
  return scene;
}

}  // namespace wavecrest
