// Scenes of the interface.
#include "wavecrest/scene.h"

#include <fmt/core.h>

#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "engine/inspect/inspection.h"
#include "engine/load/load.h"
#include "engine/scene/hash_text.h"
#include "library/errors.h"
#include "library/inspection_json.h"
#include "library/render_settings.h"
#include "library/scene_data.h"
#include "library/translate.h"
#include "scenes/scene_list.h"

namespace wavecrest::api {
namespace {

// Most pixels in a row or a column of a film.
constexpr uint32_t kLargestSide = 65535;

// The engine's options. A width or height of 0 is left to the scene file; if only one is 0, the file's aspect ratio
// decides it.
wavecrest::LoadOptions loadOptions(const LoadOptions& options) {
  wavecrest::LoadOptions load;
  load.defines = options.defines;
  load.lenient = options.lenient;
  if (options.width > kLargestSide || options.height > kLargestSide) {
    throw UsageError(
        fmt::format("width {}, height {}: expected at most {}", options.width, options.height, kLargestSide));
  }
  if (options.width != 0 || options.height != 0) load.filmSize = {options.width, options.height};
  return load;
}

}  // namespace

std::vector<BuiltInScene> builtInScenes() {
  std::vector<BuiltInScene> all;
  for (const SceneEntry& scene : wavecrest::builtInScenes()) {
    all.push_back({std::string(scene.name), std::string(scene.description)});
  }
  return all;
}

std::string sceneFolder() {
  return translated([] { return wavecrest::sceneFolder().string(); });
}

Scene::Scene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Scene Scene::load(const std::string& nameOrPath, const LoadOptions& options) {
  return translated([&] {
    // The load time includes looking for the file.
    const auto begin = std::chrono::steady_clock::now();
    if (options.spp > std::numeric_limits<uint32_t>::max()) {
      throw UsageError(fmt::format("spp {}: expected at most {}", options.spp, std::numeric_limits<uint32_t>::max()));
    }
    auto data = std::make_shared<Data>();
    data->scene = loadScene(findScene(nameOrPath), loadOptions(options));
    // The sample count counts for renders that state neither iterations nor time.
    if (options.spp != 0) data->scene.defaults.sampleCount = static_cast<uint32_t>(options.spp);
    data->loadSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return Scene(std::move(data));
  });
}

const std::string& Scene::name() const { return data_->scene.name; }
// Size of the rendered rectangle: the crop window, or the whole film.
uint32_t Scene::width() const { return data_->scene.film.imageWidth(); }
uint32_t Scene::height() const { return data_->scene.film.imageHeight(); }
uint64_t Scene::spp() const { return data_->scene.defaults.sampleCount; }
std::string Scene::hash() const { return hashText(data_->scene.hash); }
const std::vector<std::string>& Scene::warnings() const { return data_->scene.warnings; }

std::string Scene::inspect(const RenderOptions& options) const {
  return translated([&] {
    const SceneInspection facts = inspectScene(data_->scene, inspectionSettings(options, data_->scene));
    return jsonText(inspectionJson(data_->scene, facts));
  });
}

}  // namespace wavecrest::api
