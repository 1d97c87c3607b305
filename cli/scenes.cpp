// wavecrest scenes: the built-in scenes, a line each.
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "scenes/scene_list.h"

namespace wavecrest {

void addScenesCommand(CommandLine& program, int&) {
  const Command command = program.add("scenes", "list the built-in scenes");
  const auto json = std::make_shared<bool>(false);
  command.addFlag("--json", *json, "as an array of objects: name, description, file");
  command.run([json] {
    if (!*json) {
      for (const SceneEntry& scene : builtInScenes()) printOut("{:<24} {}\n", scene.name, scene.description);
      return;
    }
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const SceneEntry& scene : builtInScenes()) {
      all.push_back({{"name", scene.name},
                     {"description", scene.description},
                     {"file", findScene(std::string(scene.name)).string()}});
    }
    printOut("{}\n", jsonText(all, 2));
  });
}

}  // namespace wavecrest
