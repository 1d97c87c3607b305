// Scenes and renders. Options and facts pass as they are in C++; python/wavecrest makes them Pythonic.
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "interrupt.h"
#include "native.h"

namespace wavecrest::python {
namespace {

using api::Render;
using api::RenderOptions;
using api::Scene;

// True: Ctrl-C ended it.
bool runUntil(Render& render, std::optional<double> seconds, std::optional<uint64_t> iterations) {
  InterruptScope interrupt([](void* what) { static_cast<Render*>(what)->stop(); }, &render);
  {
    const nb::gil_scoped_release release;
    render.runUntil(seconds, iterations);
  }
  return interrupt.interrupted();
}

bool run(Render& render) {
  InterruptScope interrupt([](void* what) { static_cast<Render*>(what)->stop(); }, &render);
  {
    const nb::gil_scoped_release release;
    render.run();
  }
  return interrupt.interrupted();
}

nb::object image(const Render& render) {
  api::Image image = render.image();
  return floatArray(std::move(image.pixels), {image.height, image.width, 3});
}

Scene load(const std::string& nameOrPath, const std::map<std::string, std::string>& defines, bool lenient,
           uint32_t width, uint32_t height, uint64_t spp) {
  return Scene::load(nameOrPath,
                     {.defines = defines, .lenient = lenient, .width = width, .height = height, .spp = spp});
}

std::vector<nb::str> warnings(const Scene& scene) {
  std::vector<nb::str> lines;
  for (const std::string& line : scene.warnings()) lines.push_back(toText(line));
  return lines;
}

std::vector<std::pair<std::string, std::string>> builtInScenes() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const api::BuiltInScene& scene : api::builtInScenes()) all.emplace_back(scene.name, scene.description);
  return all;
}

void addOptions(nb::module_& module) {
  nb::class_<RenderOptions>(module, "RenderOptions", "The options of `wavecrest render`, by the same names.")
      .def(nb::init<>())
      .def_rw("method", &RenderOptions::method)
      .def_rw("time", &RenderOptions::time)
      .def_rw("spp", &RenderOptions::spp)
      .def_rw("seed", &RenderOptions::seed)
      .def_rw("threads", &RenderOptions::threads)
      .def_rw("sampler", &RenderOptions::sampler)
      .def_rw("filter_mode", &RenderOptions::filterMode)
      .def_rw("precision", &RenderOptions::precision)
      .def_rw("isa", &RenderOptions::isa)
      .def_rw("accel", &RenderOptions::accel)
      .def_rw("instances", &RenderOptions::instances)
      .def_rw("max_depth", &RenderOptions::maxDepth)
      .def_rw("rr_depth", &RenderOptions::rrDepth)
      .def_rw("roulette", &RenderOptions::roulette)
      .def_rw("wave", &RenderOptions::wave)
      .def_rw("memory", &RenderOptions::memory)
      .def_rw("measure_stages", &RenderOptions::measureStages)
      .def_rw("radius", &RenderOptions::radius)
      .def_rw("radius_alpha", &RenderOptions::radiusAlpha)
      .def_rw("merge_vertices", &RenderOptions::mergeVertices)
      .def_rw("light_paths", &RenderOptions::lightPaths)
      .def_rw("direct_pass", &RenderOptions::directPass)
      .def_rw("connection_roulette", &RenderOptions::connectionRoulette)
      .def_rw("guide", &RenderOptions::guide)
      .def_rw("guide_memory", &RenderOptions::guideMemory)
      .def_rw("mlt", &RenderOptions::mlt)
      .def_rw("chains", &RenderOptions::chains)
      .def_rw("bootstrap", &RenderOptions::bootstrap)
      .def_rw("restart", &RenderOptions::restart)
      .def_rw("no_direct_pass", &RenderOptions::noDirectPass);
}

}  // namespace

void addRender(nb::module_& module) {
  addOptions(module);
  nb::class_<Scene>(module, "Scene")
      .def_prop_ro("name", &Scene::name)
      .def_prop_ro("width", &Scene::width)
      .def_prop_ro("height", &Scene::height)
      .def_prop_ro("spp", &Scene::spp)
      .def_prop_ro("hash", &Scene::hash)
      .def_prop_ro("warnings", &warnings)
      .def("inspect", &Scene::inspect, nb::arg("options"), nb::call_guard<nb::gil_scoped_release>());
  module.def("load", &load, nb::arg("name_or_path"), nb::arg("defines"), nb::arg("lenient"), nb::arg("width"),
             nb::arg("height"), nb::arg("spp"), nb::call_guard<nb::gil_scoped_release>());
  module.def("scenes", &builtInScenes);
  module.def("scene_folder", &api::sceneFolder);

  nb::class_<Render>(module, "Render")
      .def(nb::init<const Scene&, const RenderOptions&>(), nb::arg("scene"), nb::arg("options"),
           nb::call_guard<nb::gil_scoped_release>())
      .def("run", &run, "To the end of the options. True if Ctrl-C ended it.")
      .def("run_until", &runUntil, nb::arg("seconds") = nb::none(), nb::arg("iterations") = nb::none(),
           "To so many seconds or iterations since the beginning. True if Ctrl-C ended it.")
      .def_prop_ro("iterations", &Render::iterations)
      .def("image", &image, nb::sig("def image(self) -> numpy.typing.NDArray[numpy.float32]"))
      .def("stats", &Render::stats);
}

}  // namespace wavecrest::python
