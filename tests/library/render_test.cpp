// An image of the library's renders is whole or none.
#include "wavecrest/render.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "wavecrest/error.h"

namespace wavecrest::api {
namespace {

TEST(Render, hasAnImageFromTheFirstWholePassOn) {
  const Scene scene = Scene::load("cornell-diffuse", {.defines = {}, .width = 160, .height = 120});
  for (const char* method : {"pt", "bpt", "mlt"}) {
    RenderOptions options;
    options.method = method;
    options.threads = 1;
    if (options.method == "mlt") options.bootstrap = 4096;
    Render render(scene, options);
    render.runUntil(1e-9);
    EXPECT_EQ(render.iterations(), 0u) << method;
    try {
      render.image();
      ADD_FAILURE() << method << ": an image without samples";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << method;
      EXPECT_NE(std::string(error.what()).find("no whole pass over the film"), std::string::npos) << error.what();
    }
    render.runUntil(std::nullopt, 1);
    EXPECT_EQ(render.iterations(), 1u) << method;
    const Image image = render.image();
    EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0) << method;
  }
}

}  // namespace
}  // namespace wavecrest::api
