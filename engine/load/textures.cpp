#include "engine/load/textures.h"

#include "engine/load/color.h"

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

}  // namespace

Texture readCheckerboard(LoadContext& context, Parameters& parameters) {
  return {.kind = CheckerboardTexture{.color0 = readColorOr(context, parameters, "color0", 0.4),
                                      .color1 = readColorOr(context, parameters, "color1", 0.2)},
          .toUv = readToUv(parameters)};
}

}  // namespace wavecrest
