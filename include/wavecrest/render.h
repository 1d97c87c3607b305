// A render that can be watched: it goes on for as long as it is told to, and shows its image in between.
//
//   Render render(Scene::load("cornell-mirror"), {.method = "vcm", .time = "30s"});
//   for (double seconds : {1, 2, 4, 8}) {
//     render.runUntil(seconds);
//     use(render.image());
//   }
//   render.run();  // to the end of the 30 seconds
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wavecrest/image.h"
#include "wavecrest/scene.h"

namespace wavecrest::api {

class WAVECREST_EXPORT Render {
 public:
  // Compiles the scene for the method and plans the memory. Throws Error.
  Render(const Scene& scene, const RenderOptions& options);
  ~Render();
  Render(Render&&) noexcept;
  Render& operator=(Render&&) noexcept;

  // Renders until the time or the iterations of the options are reached, whichever comes first, or until stop().
  void run();
  // The same until so many seconds or iterations since the beginning of the render, whatever the options say.
  void runUntil(std::optional<double> seconds, std::optional<uint64_t> iterations = std::nullopt);

  // Ends a run once the waves under way are done, here or in any other thread; safe in a signal handler. A render that
  // was stopped stays so.
  void stop() noexcept;
  bool stopped() const noexcept;

  // Not while it runs. The clock of seconds() stands still between runs.
  double seconds() const;
  uint64_t iterations() const;  // whole ones, of all pixels
  // Of iterations() > 0: before that, pixels without any sample would be black. Throws Error.
  Image image() const;
  // Numbers so far: the object that `wavecrest render --stats` writes, `stages` where RenderOptions::measureStages says
  // so. `notes` is what was approximated or left out when the scene was loaded.
  std::string stats() const;
  // The image, by extension: .exr with the scalar stats as attributes, .pfm or .png. Throws Error.
  void write(const std::string& file) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace wavecrest::api
