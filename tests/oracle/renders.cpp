// Renders of a scene by several seeds, for oracle tests: one process for all, because starting `wavecrest render` and
// loading the scene takes as long as a small picture.
//
//   oracle_renders SCENE FIRST LAST [OPTION VALUE]...
//
// In: a scene, the first and the last seed, and those options of `wavecrest render` that oracle tests use. Out, on
// stdout: the images as 32-bit floats, one after the other, each row by row from the top, RGB.
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "wavecrest/wavecrest.h"

namespace {

using wavecrest::api::Image;
using wavecrest::api::LoadOptions;
using wavecrest::api::Render;
using wavecrest::api::RenderOptions;
using wavecrest::api::Scene;

struct Choices {
  LoadOptions load{};
  RenderOptions render{};
};

void setSize(LoadOptions& load, const std::string& size) {
  size_t end = 0;
  load.width = static_cast<uint32_t>(std::stoul(size, &end));
  load.height = static_cast<uint32_t>(std::stoul(size.substr(end + 1)));
}

Choices read(int count, char** words) {
  Choices choices;
  RenderOptions& render = choices.render;
  const std::map<std::string, std::function<void(const std::string&)>> options = {
      {"--size", [&](const std::string& value) { setSize(choices.load, value); }},
      {"--method", [&](const std::string& value) { render.method = value; }},
      {"--spp", [&](const std::string& value) { render.spp = std::stoull(value); }},
      {"--sampler", [&](const std::string& value) { render.sampler = value; }},
      {"--max-depth", [&](const std::string& value) { render.maxDepth = std::stoi(value); }},
      {"--rr-depth", [&](const std::string& value) { render.rrDepth = std::stoi(value); }},
      {"--radius", [&](const std::string& value) { render.radius = std::stod(value); }},
      {"--instances", [&](const std::string& value) { render.instances = value; }},
      {"--threads", [&](const std::string& value) { render.threads = static_cast<uint32_t>(std::stoul(value)); }},
      {"--mlt", [&](const std::string& value) { render.mlt = value; }},
  };
  for (int i = 0; i < count; i += 2) {
    const auto option = options.find(words[i]);
    if (option == options.end() || i + 1 == count) throw std::invalid_argument(std::string("unexpected ") + words[i]);
    option->second(words[i + 1]);
  }
  return choices;
}

void renderSeeds(int count, char** words) {
  if (count < 4) throw std::invalid_argument("expected SCENE FIRST LAST [OPTION VALUE]...");
  Choices choices = read(count - 4, words + 4);
  const Scene scene = Scene::load(words[1], choices.load);
  const uint64_t last = std::stoull(words[3]);
  for (uint64_t seed = std::stoull(words[2]); seed <= last; ++seed) {
    choices.render.seed = seed;
    Render render(scene, choices.render);
    render.run();
    const Image image = render.image();
    if (std::fwrite(image.pixels.data(), sizeof(float), image.pixels.size(), stdout) != image.pixels.size()) {
      throw std::runtime_error("cannot write to stdout");
    }
  }
}

}  // namespace

int main(int count, char** words) {
  try {
    renderSeeds(count, words);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "oracle_renders: error: %s\n", error.what());
    return 1;
  }
}
