// Images and metrics.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "native.h"

namespace wavecrest::python {
namespace {

using api::MetricInfo;
using api::Reference;

Reference makeReference(const FloatImage& pixels, bool srgb, double exposure, bool gamma, const std::string& name) {
  api::Image image = toImage(pixels, srgb);
  const nb::gil_scoped_release release;
  return Reference(std::move(image), {.exposure = exposure, .gammaCorrectedErrors = gamma}, name);
}

// For each metric: name, main score, all scores by name, map or None, the map's range.
nb::list toRows(api::Comparison& comparison) {
  nb::list rows;
  for (api::MetricResult& result : comparison.results) {
    nb::dict scores;
    for (const api::NamedScore& score : result.scores) scores[score.name.c_str()] = score.value;
    const nb::object map =
        result.map.empty() ? nb::none() : floatArray(std::move(result.map), {comparison.height, comparison.width});
    rows.append(nb::make_tuple(result.metric, result.score, scores, map, result.mapRange));
  }
  return rows;
}

nb::tuple compare(const Reference& reference, const FloatImage& pixels, bool srgb,
                  const std::vector<std::string>& metrics, bool maps, const std::string& name) {
  api::Image test = toImage(pixels, srgb);
  api::Comparison comparison;
  {
    const nb::gil_scoped_release release;
    comparison = reference.compare(std::move(test), metrics, maps, name);
  }
  return nb::make_tuple(toRows(comparison), comparison.nonFinitePixels);
}

std::pair<nb::object, bool> readImage(const std::string& file) {
  api::Image image;
  {
    const nb::gil_scoped_release release;
    image = api::readImage(file);
  }
  return {floatArray(std::move(image.pixels), {image.height, image.width, 3}), image.srgb};
}

void writeImage(const std::string& file, const FloatImage& pixels) {
  const api::Image image = toImage(pixels, false);
  const nb::gil_scoped_release release;
  api::writeImage(file, image);
}

nb::object srgbCodes(const FloatImage& pixels, bool srgb, double exposure) {
  return byteArray(api::srgbCodes(toImage(pixels, srgb), exposure), {pixels.shape(0), pixels.shape(1), 3});
}

nb::object falseColours(const FloatMap& map, double range) {
  const std::vector<float> numbers(map.data(), map.data() + map.size());
  const size_t height = map.shape(0), width = map.shape(1);
  return byteArray(api::falseColours(numbers, static_cast<uint32_t>(width), static_cast<uint32_t>(height), range),
                   {height, width, 3});
}

}  // namespace

void addCompare(nb::module_& module) {
  nb::class_<MetricInfo>(module, "MetricInfo")
      .def_ro("name", &MetricInfo::name)
      .def_ro("symbol", &MetricInfo::symbol)
      .def_ro("title", &MetricInfo::title)
      .def_ro("basis", &MetricInfo::basis)
      .def_ro("higher_is_better", &MetricInfo::higherIsBetter)
      .def_ro("by_default", &MetricInfo::byDefault)
      .def_ro("smallest_side", &MetricInfo::smallestSide);
  module.def("metrics", &api::metrics);

  nb::class_<Reference>(module, "Reference")
      .def(nb::new_(&makeReference), nb::arg("pixels"), nb::arg("srgb"), nb::arg("exposure"), nb::arg("gamma"),
           nb::arg("name"))
      .def("compare", &compare, nb::arg("pixels"), nb::arg("srgb"), nb::arg("metrics"), nb::arg("maps"),
           nb::arg("name"),
           nb::sig("def compare(self, pixels: numpy.typing.NDArray[numpy.float32], srgb: bool, metrics: "
                   "collections.abc.Sequence[str], maps: bool, name: str) -> tuple[list[tuple[str, float, dict[str, "
                   "float], numpy.typing.NDArray[numpy.float32] | None, float]], int]"));

  module.def("read_image", &readImage, nb::arg("file"),
             nb::sig("def read_image(file: str) -> tuple[numpy.typing.NDArray[numpy.float32], bool]"));
  module.def("write_image", &writeImage, nb::arg("file"), nb::arg("pixels"));
  module.def("srgb_codes", &srgbCodes, nb::arg("pixels"), nb::arg("srgb"), nb::arg("exposure"),
             nb::sig("def srgb_codes(pixels: numpy.typing.NDArray[numpy.float32], srgb: bool, exposure: float) -> "
                     "numpy.typing.NDArray[numpy.uint8]"));
  module.def("false_colours", &falseColours, nb::arg("map"), nb::arg("range"),
             nb::sig("def false_colours(map: numpy.typing.NDArray[numpy.float32], range: float) -> "
                     "numpy.typing.NDArray[numpy.uint8]"));
}

}  // namespace wavecrest::python
