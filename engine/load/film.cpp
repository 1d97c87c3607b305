#include "engine/load/film.h"

#include <algorithm>
#include <limits>
#include <string>

#include "engine/load/plugins.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

constexpr int64_t kLargestSide = 32768;
constexpr int64_t kMostPixels = int64_t{1} << 28;
constexpr uint32_t kMostAcross = 65535;  // a pixel is kept as y << 16 | x
constexpr double kWidestFilter = 32;     // pixels

// `stddev` is in pixels.
void setGaussian(FilmSettings& film, double stddev) {
  film.filter = ReconstructionFilter::gaussian;
  film.gaussianStddev = stddev;
  film.filterRadius = 4 * stddev;  // only bounds the size: samples are cut at 4.5 deviations
}

// Reads the crop window in pixels. It stays 0 x 0, which stands for the whole film, if the file gives none.
void readCrop(Parameters& parameters, FilmSettings& film) {
  const auto pixels = [&](std::string_view name, int64_t fallback, int64_t least) {
    return static_cast<uint32_t>(parameters.integer(name, fallback, least, kLargestSide));
  };
  film.cropX = pixels("crop_offset_x", 0, 0);
  film.cropY = pixels("crop_offset_y", 0, 0);
  const bool any = parameters.has("crop_width") || parameters.has("crop_height") || film.cropX > 0 || film.cropY > 0;
  if (!any) return;
  film.cropWidth = pixels("crop_width", film.width, 1);
  film.cropHeight = pixels("crop_height", film.height, 1);
  if (film.cropX + film.cropWidth > film.width || film.cropY + film.cropHeight > film.height) {
    throw LoadError(parameters.location(), "crop window leaves the film; expected it to be inside " +
                                               std::to_string(film.width) + " x " + std::to_string(film.height));
  }
}

// Returns `radius`, in pixels. LoadError at the parameter `name` if it is above kWidestFilter.
double checkedRadius(const Parameters& parameters, std::string_view name, double radius) {
  if (radius <= kWidestFilter) return radius;
  throw LoadError(parameters.locationOf(name), "reconstruction filter is wider than " +
                                                   std::to_string(static_cast<int>(kWidestFilter)) +
                                                   " pixels; expected a smaller one");
}

}  // namespace

void readBoxFilter(Parameters& parameters, FilmSettings& film) {
  // Mitsuba 3 has no boxes of another size than a pixel's; 0.6 had.
  film.filter = ReconstructionFilter::box;
  film.filterRadius = 0.5;
  if (parameters.positiveReal("radius", 0.5) != film.filterRadius) {
    parameters.leaveOut({"radius"}, "left out: the box is a pixel wide");
  }
}

void readTentFilter(Parameters& parameters, FilmSettings& film) {
  film.filter = ReconstructionFilter::tent;
  film.filterRadius = checkedRadius(parameters, "radius", parameters.positiveReal("radius", 1));
}

void readGaussianFilter(Parameters& parameters, FilmSettings& film) {
  setGaussian(film, parameters.positiveReal("stddev", 0.5));
  checkedRadius(parameters, "stddev", film.filterRadius);
}

void readFilm(LoadContext& context, const XmlElement* element) {
  FilmSettings& film = context.scene.film;
  // Mitsuba's default filter.
  setGaussian(film, 0.5);
  if (element) {
    // All kinds of film are read as hdrfilm.
    const std::string_view type = element->get("type");
    if (type == "ldrfilm" || type == "tiledhdrfilm" || type == "mfilm") {
      context.note(element->location(), "film " + inQuotes(type), "read as hdrfilm; the command line names the files");
    } else if (type != "hdrfilm") {
      context.unsupported(element->location(), "film " + inQuotes(type) + " is not supported; expected hdrfilm");
    }
    Parameters parameters(context, *element);
    // Size and crop window.
    film.width = static_cast<uint32_t>(parameters.integer("width", 768, 1, kLargestSide));
    film.height = static_cast<uint32_t>(parameters.integer("height", 576, 1, kLargestSide));
    readCrop(parameters, film);
    // How the file is stored is the command line's business.
    parameters.ignore({"file_format", "pixel_format", "component_format", "banner", "compensate", "attach_log",
                       "variable", "digits", "has_alpha"});
    // Filters always reach over the border (METHODS.md 1.7), as they do in Mitsuba with one of these.
    parameters.ignore({"sample_border", "high_quality_edges"});
    parameters.leaveOut({"gamma", "exposure", "tonemap_method", "key", "burn"},
                        "left out: images are written linear, or with the sRGB curve");
    // At most one reconstruction filter. Kinds with negative lobes are replaced by a gaussian.
    const std::vector<const XmlElement*> filters = parameters.objects("rfilter");
    if (filters.size() > 1) throw LoadError(filters[1]->location(), "film has two rfilters; expected at most one");
    if (!filters.empty()) {
      const std::string_view filter = filters[0]->get("type");
      if (filter == "mitchell" || filter == "catmullrom" || filter == "lanczos") {
        context.note(filters[0]->location(), "rfilter " + inQuotes(filter), "a gaussian of stddev 0.5 is used");
      } else if (const FilterPlugin* plugin =
                     findPlugin(context, filterPlugins(), *filters[0], "replaced by gaussian")) {
        Parameters filterParameters(context, *filters[0]);
        plugin->read(filterParameters, film);
        filterParameters.finish();
      }
    }
    parameters.finish();
  }
  // A size from the command line replaces that of the file. One side of 0 follows from the aspect ratio of the file.
  if (context.options.filmSize) {
    const double aspect = static_cast<double>(film.width) / film.height;
    const auto [width, height] = *context.options.filmSize;
    const auto rounded = [](double side) {
      return static_cast<uint32_t>(std::clamp(side + 0.5, 1.0, double{std::numeric_limits<uint32_t>::max()}));
    };
    film.width = width != 0 ? width : rounded(height * aspect);
    film.height = height != 0 ? height : rounded(width / aspect);
    if (element && film.isCropped()) {
      context.note(element->location(), "crop window", "left out beside a size from outside");
    }
    film.cropX = film.cropY = film.cropWidth = film.cropHeight = 0;
  }
  // Check the final size.
  const bool isEmpty = film.width == 0 || film.height == 0;
  const bool isTooLong = film.width > kMostAcross || film.height > kMostAcross;
  if (isEmpty || isTooLong || int64_t{film.width} * film.height > kMostPixels) {
    throw LoadError(element ? element->location() : context.document.scene.location(),
                    "film of " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                        " pixels; expected 1 to 2^28 pixels" +
                        (isTooLong ? ", and sides up to " + std::to_string(kMostAcross) : ""));
  }
}

void readSampler(LoadContext& context, const XmlElement* element) {
  // Mitsuba's default.
  context.scene.defaults.sampleCount = 4;
  if (!element) return;
  constexpr int64_t kMost = 1'000'000'000;
  Parameters parameters(context, *element);
  context.scene.defaults.sampleCount = static_cast<uint32_t>(parameters.integer("sample_count", 4, 1, kMost));
  const std::string_view type = element->get("type");
  if (type != "independent") {
    context.note(element->location(), "sampler " + inQuotes(type),
                 "the command line chooses the sampler (--sampler independent or sobol)");
  }
  // How that sampler makes its numbers.
  parameters.ignore({"seed", "jitter", "strength", "dimension", "scramble"});
  parameters.finish();
}

}  // namespace wavecrest
