// wavecrest scenes: the built-in scenes, a line each.
#include <fmt/core.h>

#include "cli/commands.h"
#include "scenes/scene_list.h"

namespace wavecrest {

void addScenesCommand(CommandLine& program, int&) {
  const Command command = program.add("scenes", "list the built-in scenes");
  command.run([] {
    for (const SceneEntry& scene : builtInScenes()) fmt::print("{:<24} {}\n", scene.name, scene.description);
  });
}

}  // namespace wavecrest
