#include "scenes/scene_list.h"

#include <array>
#include <cstdlib>

namespace wavecrest {
namespace {

constexpr std::array kScenes{
    SceneEntry{"cornell-diffuse", "the measured Cornell box: diffuse walls and blocks under an area light"},
    SceneEntry{"cornell-mirror", "the box with its tall block a perfect mirror"},
    SceneEntry{"cornell-glossy", "the box with both blocks of highly glossy metal"},
    SceneEntry{"cornell-spheres", "a mirror and a glass sphere in a box, lit by the sun alone"},
    SceneEntry{"dragon-caustics", "a dragon of orange glass under a sky, its caustic on the floor"},
    SceneEntry{"dragon-caustics-glossy", "the same beside a glossy box that reflects dragon and caustic"},
    SceneEntry{"lafortune-room", "a room lit by lamps that are hidden in their shades"},
    SceneEntry{"pool-interior", "under water: caustics of sunlight on the tiles of a pool"},
    SceneEntry{"veach-door", "a room lit through a door ajar, with three teapots"},
};

}  // namespace

std::span<const SceneEntry> builtInScenes() { return kScenes; }

std::filesystem::path sceneFolder() {
  const char* const folder = std::getenv("WAVECREST_SCENES");
  return folder != nullptr ? folder : WAVECREST_SCENE_FOLDER;
}

std::filesystem::path findScene(const std::string& nameOrPath) {
  for (const SceneEntry& scene : kScenes) {
    if (scene.name == nameOrPath) return sceneFolder() / (nameOrPath + ".xml");
  }
  return nameOrPath;
}

}  // namespace wavecrest
