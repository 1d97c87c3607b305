#include "engine/load/textures.h"

#include "engine/load/bitmap_file.h"
#include "engine/load/color.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// to_uv acts on (u, v) only.
Matrix4 readToUv(Parameters& parameters) {
  const Matrix4 m = parameters.transform("to_uv").value_or(identityMatrix());
  Matrix4 uv = identityMatrix();
  for (size_t i = 0; i < 2; ++i) {
    for (const size_t j : {size_t{0}, size_t{1}, size_t{3}}) uv[i][j] = m[i][j];
  }
  return uv;
}

Rgb readColorOr(LoadContext& context, Parameters& parameters, std::string_view name, double fallback) {
  const XmlElement* element = parameters.element(name);
  if (!element) return {fallback, fallback, fallback};
  return readColor(context, *element, ColorRole::reflectance);
}

Filter readFilter(LoadContext& context, Parameters& parameters) {
  const std::string name = toLower(parameters.string("filter_type", "bilinear"));
  if (name == "nearest") return Filter::nearest;
  if (name != "bilinear") {
    context.unsupported(parameters.locationOf("filter_type"),
                        "filter_type " + inQuotes(name) + " is not supported; expected bilinear or nearest");
  }
  return Filter::bilinear;
}

Wrap readWrap(Parameters& parameters) {
  const std::string name = toLower(parameters.string("wrap_mode", "repeat"));
  if (name == "repeat") return Wrap::repeat;
  if (name == "mirror") return Wrap::mirror;
  if (name == "clamp") return Wrap::clamp;
  throw LoadError(parameters.locationOf("wrap_mode"),
                  "unknown wrap_mode " + inQuotes(name) + "; expected repeat, mirror or clamp");
}

}  // namespace

Texture readBitmapTexture(LoadContext& context, Parameters& parameters) {
  BitmapTexture texture{.bitmap = nullptr, .filter = readFilter(context, parameters), .wrap = readWrap(parameters)};
  const bool raw = parameters.boolean("raw", false);
  parameters.ignore({"format", "accel"});  // how Mitsuba stores it
  const std::string filename = parameters.requiredString("filename");
  texture.bitmap =
      readBitmap(context, context.resolvePath(filename, parameters.object()), raw, parameters.locationOf("filename"));
  return {.kind = std::move(texture), .toUv = readToUv(parameters)};
}

Texture readCheckerboard(LoadContext& context, Parameters& parameters) {
  return {.kind = CheckerboardTexture{.color0 = readColorOr(context, parameters, "color0", 0.4),
                                      .color1 = readColorOr(context, parameters, "color1", 0.2)},
          .toUv = readToUv(parameters)};
}

}  // namespace wavecrest
