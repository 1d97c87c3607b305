// An image of the library's renders is whole or none, and what their statistics tell.
#include "wavecrest/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/metrics/temporary_folder.h"
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

TEST(Render, statsTellNotesAndTimesOfStagesThatAreMeasured) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("scene.xml", R"(<scene version="3.0.0"><integrator type="bdpt"/>
      <sensor type="perspective"/><emitter type="constant"/><shape type="sphere"/></scene>)");
  const Scene scene = Scene::load(file, {.defines = {}, .width = 16, .height = 12});
  for (const bool measured : {false, true}) {
    RenderOptions options;
    options.spp = 1;
    options.measureStages = measured;
    Render render(scene, options);
    render.run();
    const nlohmann::json stats = nlohmann::json::parse(render.stats());
    ASSERT_EQ(stats.at("notes").size(), 1u);
    EXPECT_NE(stats.at("notes").at(0).get<std::string>().find("integrator \"bdpt\""), std::string::npos);
    ASSERT_EQ(stats.contains("stages"), measured);
    if (measured) {
      EXPECT_GT(stats.at("stages").at(0).at("items").get<uint64_t>(), 0u);
    }
  }
}

}  // namespace
}  // namespace wavecrest::api
