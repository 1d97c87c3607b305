#include "scenes/scene_list.h"

#include <dlfcn.h>

#include <cstdlib>
#include <system_error>
#include <vector>

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

constexpr SceneEntry kScenes[] = {
    {"cornell-diffuse", "the measured Cornell box, all surfaces diffuse"},
    {"cornell-mirror", "the Cornell box with a mirror block that throws lamp light onto the ceiling"},
    {"cornell-glossy", "the Cornell box with two blocks of brushed aluminium that reflect each other"},
    {"cornell-spheres", "a mirror and a glass sphere in a box lit by the sun alone; caustics, also seen in the mirror"},
    {"dragon-caustics", "the Stanford dragon in amber glass under a small sun; caustics in its shadow",
     "assets/dragon_res2.ply"},
    {"dragon-caustics-glossy", "the amber dragon beside a glossy metal box that reflects it and its caustics",
     "assets/dragon_res2.ply"},
    {"lafortune-room", "a living room lit by lamps in opaque shades; nearly all light is indirect"},
    {"pool-interior", "a tiled pool under water, lit by sunlight through the waves"},
    {"veach-door", "three teapots in a room lit through a door ajar"},
};

constexpr SceneEntry kBenchmarkScenes[] = {
    {"mitsuba-cornell-box", "Mitsuba 3's built-in Cornell box, 256 x 256"},
    {"dragon-diffuse", "the full dragon, 871,414 triangles, diffuse under a constant sky", "assets/dragon_full.ply"},
};

// Prepared dragons are called dragon_full.ply, dragon_res2.ply, ...; the scans they come from dragon_vrip*.ply.gz.
bool isDragon(const fs::path& file) { return file.filename().string().starts_with("dragon_"); }

// The folders of the running program, and of the library or Python module that this code may be part of instead.
std::vector<fs::path> ownFolders() {
  std::vector<fs::path> folders;
  std::error_code error;
  Dl_info module{};
  if (dladdr(static_cast<const void*>(&kScenes), &module) != 0 && module.dli_fname != nullptr) {
    const fs::path file = fs::canonical(module.dli_fname, error);
    if (!error) folders.push_back(file.parent_path());
  }
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(executable.parent_path());
  return folders;
}

// Installed folders first, relative to where they are now: prefixes are moved, and wheels unpacked anywhere.
std::vector<fs::path> defaultFolders() {
  std::vector<fs::path> folders;
  for (const fs::path& own : ownFolders()) {
    for (const char* relative : {"scenes", "../share/wavecrest/scenes", "../../share/wavecrest/scenes"}) {
      folders.push_back((own / relative).lexically_normal());
    }
  }
  folders.emplace_back(WAVECREST_SCENES_SOURCE_DIR);
  folders.emplace_back(WAVECREST_SCENES_INSTALL_DIR);
  for (const fs::path& own : ownFolders()) folders.push_back((own / "../../scenes").lexically_normal());
  return folders;
}

bool holdsScenes(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / (std::string(kScenes[0].name) + ".xml"), error);
}

}  // namespace

std::span<const SceneEntry> builtInScenes() { return kScenes; }
std::span<const SceneEntry> benchmarkScenes() { return kBenchmarkScenes; }

fs::path sceneFolder() {
  if (const char* folder = std::getenv("WAVECREST_SCENES"); folder && *folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      throw SceneFolderError("WAVECREST_SCENES is '" + std::string(folder) + "'; expected a folder of scenes");
    }
    return folder;
  }
  std::string tried;
  for (const fs::path& folder : defaultFolders()) {
    if (holdsScenes(folder)) return folder;
    tried += (tried.empty() ? "" : ", ") + folder.string();
  }
  throw SceneFolderError("the built-in scenes are in none of " + tried +
                         "; expected WAVECREST_SCENES to name their folder");
}

fs::path findScene(const std::string& nameOrPath) {
  for (std::span<const SceneEntry> list : {builtInScenes(), benchmarkScenes()}) {
    for (const SceneEntry& scene : list)
      if (scene.name == nameOrPath) return sceneFolder() / (nameOrPath + ".xml");
  }
  return nameOrPath;
}

std::string missingAssetHint(const fs::path& file) {
  const bool ours = file.parent_path().filename() == "assets" || file.parent_path().filename() == "stanford-dragon";
  if (!ours) return "";
  if (isDragon(file)) return "scenes/fetch-dragon gets the Stanford dragon, the build or that script then prepares it";
  return "the build writes it (target wavecrest_scene_assets)";
}

}  // namespace wavecrest
