// Scenes: loaded, checked, ready for any number of renders.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wavecrest/export.h"
#include "wavecrest/render_options.h"

namespace wavecrest::api {

struct LoadOptions {
  std::map<std::string, std::string> defines;  // values of the scene's $names, stronger than its defaults
  bool lenient = false;                        // skip what is not supported, with a warning
  uint32_t width = 0, height = 0;              // of the film; 0: the file's. One alone keeps the file's aspect ratio.
  uint64_t spp = 0;                            // iterations of a render that does not say; 0: the file's
};

struct BuiltInScene {
  std::string name, description;
};

// What load() takes besides paths.
WAVECREST_EXPORT std::vector<BuiltInScene> builtInScenes();
// Where their files are, with references/SCENE.exr. Throws Error.
WAVECREST_EXPORT std::string sceneFolder();

// A handle; copies share the scene, which never changes. Safe to use from several threads.
class WAVECREST_EXPORT Scene {
 public:
  // A built-in scene by name, or a Mitsuba 3 XML file by path. Throws Error, with file and line.
  static Scene load(const std::string& nameOrPath, const LoadOptions& options = {});

  const std::string& name() const;
  uint32_t width() const;  // of the rendered part of the film
  uint32_t height() const;
  uint64_t spp() const;                              // iterations of a render that does not say
  std::string hash() const;                          // of all that the scene was loaded from, 16 hexadecimal digits
  const std::vector<std::string>& warnings() const;  // what LoadOptions::lenient skipped

  // What is in the scene, which kernels and intersector it gets, memory for each method, which paths each method can
  // make and by which its reference should be rendered: the object that `wavecrest inspect --json` prints. Options that
  // decide kernels, memory or the radius of merges count: threads, precision, accel, instances, wave, radius, chains
  // and memory among them. The method does not count, and light paths are refused. Throws Error.
  std::string inspect(const RenderOptions& options = {}) const;

 private:
  friend class Render;
  struct Data;
  explicit Scene(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

}  // namespace wavecrest::api
