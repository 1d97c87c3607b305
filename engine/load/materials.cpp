#include "engine/load/materials.h"

#include <algorithm>
#include <limits>

#include "engine/load/color.h"
#include "engine/load/mesh_attributes.h"
#include "engine/load/plugins.h"
#include "engine/load/values.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {

namespace {

bool isTexture(const XmlElement& element) { return element.isObject() && element.tag == "texture"; }

// The smallest and the largest value of a texture. Negative channels of a picture whose luminances are not negative
// count as 0: they are those of colours outside of Rec. 709.
std::pair<double, double> rangeOf(const Texture& texture) {
  if (const auto* const board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    const auto [least0, most0] = std::ranges::minmax(board->color0);
    const auto [least1, most1] = std::ranges::minmax(board->color1);
    return {std::min(least0, least1), std::max(most0, most1)};
  }
  const auto& image = std::get<BitmapTexture>(texture.kind);
  const Bitmap& bitmap = *image.bitmap;
  // Of a mesh attribute only the corners of triangles: the other texels lie outside and are extrapolated.
  std::vector<float> corners;
  if (image.attribute != nullptr) corners = unbakedAttribute(bitmap, size_t{bitmap.width} * bitmap.height / 4).values;
  const std::vector<float>& pixels = image.attribute != nullptr ? corners : bitmap.pixels;
  if (pixels.empty()) return {0, 0};
  const auto [least, most] = std::ranges::minmax(pixels);
  if (least >= 0 || bitmap.channels != 3 || pixels.size() == 3) return {least, most};
  for (size_t i = 0; i < pixels.size(); i += 3) {
    if (luminance({pixels[i], pixels[i + 1], pixels[i + 2]}) < 0) return {least, most};
  }
  return {0, most};
}

// Textures that reflect more than arrives are taken as they are, as in Mitsuba. Less than nothing is refused, and so is
// what a float cannot hold.
void checkRange(LoadContext& context, const Texture& texture, ColorRole role, const SourceLocation& where) {
  const bool reflects = role == ColorRole::reflectance;
  if (!reflects && role != ColorRole::emission) return;
  const auto [least, most] = rangeOf(texture);
  if (least < 0 || most > double{std::numeric_limits<float>::max()}) {
    throw LoadError(where, std::string(reflects ? "reflectance" : "emission") + " texture has a value of " +
                               std::to_string(least < 0 ? least : most) + "; expected " +
                               (reflects ? "0 to 1" : "0 to 3.4e38"));
  }
  if (reflects && most > 1) {
    context.warn(where, "reflectance texture has values up to " + std::to_string(most) +
                            ", which reflect more light than arrives; expected 0 to 1");
  }
}

// The value of a texture that is the same everywhere.
Rgb constantOf(const Texture& texture) {
  const std::vector<float>& value = std::get<BitmapTexture>(texture.kind).bitmap->pixels;
  return {value[0], value[1], value[2]};
}

// A colour or a texture; grey of value `fallback` if the parameter is absent. `role` says which colours are valid.
TexturedRgb readTextured(LoadContext& context, Parameters& parameters, std::string_view name, double fallback,
                         ColorRole role) {
  const XmlElement* element = parameters.element(name);
  if (!element) return {.value = {fallback, fallback, fallback}};
  if (!isTexture(*element)) return {.value = readColor(context, *element, role)};
  const SourceLocation where = parameters.locationOf(name);
  // A rawconstant becomes a plain colour, which needs no lookup.
  if (element->get("type") == "rawconstant") {
    const Texture texture = readTexture(context, *element);
    checkRange(context, texture, role, where);
    const Rgb value = constantOf(texture);
    // A number is at least 0 in all forms.
    if (role == ColorRole::unbounded && std::ranges::min(value) < 0) {
      throw LoadError(where, inQuotes(name) + " has a value of " + std::to_string(std::ranges::min(value)) +
                                 "; expected 0 to 3.4e38");
    }
    return {.value = value};
  }
  const uint32_t texture = textureOf(context, *element);
  checkRange(context, context.scene.textures[texture], role, where);
  return {.value = {0, 0, 0}, .texture = texture};
}

}  // namespace

uint32_t materialOf(LoadContext& context, const XmlElement& bsdf) {
  if (const auto known = context.materials.find(&bsdf); known != context.materials.end()) return known->second;
  Material material;
  material.id = bsdf.get("id");
  material.source = bsdf.location();
  // Reading adds the parts of a blend to the scene, so the index of this material is known only afterwards.
  readBsdf(context, bsdf, material);
  const uint32_t index = static_cast<uint32_t>(context.scene.materials.size());
  context.scene.materials.push_back(std::move(material));
  context.materials.emplace(&bsdf, index);
  return index;
}

uint32_t defaultMaterial(LoadContext& context, bool isLight) {
  // Made for the first shape that needs it.
  uint32_t& index = context.defaultMaterial[isLight ? 1 : 0];
  if (index == kNone) {
    index = static_cast<uint32_t>(context.scene.materials.size());
    Material material;
    const double reflectance = isLight ? 0 : 0.5;
    material.kind = Diffuse{.reflectance = {.value = {reflectance, reflectance, reflectance}}};
    material.source = context.document.scene.location();
    context.scene.materials.push_back(std::move(material));
  }
  return index;
}

void readBsdf(LoadContext& context, const XmlElement& bsdf, Material& material) {
  const ReadingGuard guard(context, bsdf);
  const auto replaced = std::ranges::find(replacedBsdfPlugins(), bsdf.get("type"), &BsdfPlugin::type);
  const BsdfPlugin* plugin = replaced != replacedBsdfPlugins().end()
                                 ? &*replaced
                                 : findPlugin(context, bsdfPlugins(), bsdf, "replaced by diffuse of reflectance 0.5");
  // Without --lenient an unknown type is an error, and this is not reached.
  if (!plugin) {
    material.kind = Diffuse{};
    return;
  }
  Parameters parameters(context, bsdf);
  plugin->read(context, parameters, material);
  parameters.finish();
}

Texture readTexture(LoadContext& context, const XmlElement& texture) {
  const ReadingGuard guard(context, texture);
  // With --lenient, a constant of 0.5 replaces a texture of unknown type.
  Texture result{.kind = CheckerboardTexture{.color0 = {0.5, 0.5, 0.5}, .color1 = {0.5, 0.5, 0.5}},
                 .toUv = identityMatrix()};
  if (const TexturePlugin* plugin = findPlugin(context, texturePlugins(), texture, "replaced by a constant of 0.5")) {
    Parameters parameters(context, texture);
    result = plugin->read(context, parameters);
    parameters.finish();
  }
  return result;
}

uint32_t textureOf(LoadContext& context, const XmlElement& texture) {
  if (const auto known = context.textures.find(&texture); known != context.textures.end()) return known->second;
  Texture result = readTexture(context, texture);
  const uint32_t index = static_cast<uint32_t>(context.scene.textures.size());
  context.scene.textures.push_back(std::move(result));
  context.textures.emplace(&texture, index);
  return index;
}

uint32_t emissionTextureOf(LoadContext& context, const XmlElement& texture, const SourceLocation& where) {
  const uint32_t index = textureOf(context, texture);
  checkRange(context, context.scene.textures[index], ColorRole::emission, where);
  return index;
}

TexturedRgb readTexturedRgb(LoadContext& context, Parameters& parameters, std::string_view name, double fallback) {
  return readTextured(context, parameters, name, fallback, ColorRole::reflectance);
}

TexturedRgb readTexturedEmission(LoadContext& context, Parameters& parameters, std::string_view name) {
  return readTextured(context, parameters, name, 1, ColorRole::emission);
}

namespace {

// The luminance of linear Rec. 709, with Mitsuba's weights.
double luminance(double r, double g, double b) { return 0.212671 * r + 0.715160 * g + 0.072169 * b; }

bool isGrey(const Rgb& color) { return color[0] == color[1] && color[1] == color[2]; }

// The mean of the channels. A grey value is taken as it is, since the sum would round it.
double meanOf(const Rgb& color) { return isGrey(color) ? color[0] : (color[0] + color[1] + color[2]) / 3; }

// A bitmap of three channels as one of one channel: that of the luminances, or of the means.
Bitmap greyOf(const Bitmap& colour, bool luminances) {
  Bitmap grey{.width = colour.width, .height = colour.height, .channels = 1, .pixels = {}};
  grey.pixels.reserve(colour.pixels.size() / 3);
  for (size_t i = 0; i + 2 < colour.pixels.size(); i += 3) {
    const double r = colour.pixels[i], g = colour.pixels[i + 1], b = colour.pixels[i + 2];
    grey.pixels.push_back(static_cast<float>(luminances ? luminance(r, g, b) : meanOf({r, g, b})));
  }
  return grey;
}

}  // namespace

// Where a number is asked for, Mitsuba 3 reads the luminance of a colour bitmap, and the means of a checkerboard's
// colours, which it swaps (3.9, seen in its images). Mitsuba 0.6 reads means.
Texture scalarTexture(Texture texture, bool asMitsuba3) {
  if (auto* const board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    if (asMitsuba3) std::swap(board->color0, board->color1);
    for (Rgb* color : {&board->color0, &board->color1}) color->fill(meanOf(*color));
  } else {
    auto& bitmap = std::get<BitmapTexture>(texture.kind).bitmap;
    if (bitmap->channels != 1) bitmap = std::make_shared<Bitmap>(greyOf(*bitmap, asMitsuba3));
  }
  return texture;
}

uint32_t scalarTextureOf(LoadContext& context, uint32_t index, bool asMitsuba3) {
  const std::pair<uint32_t, bool> key{index, asMitsuba3};
  if (const auto known = context.scalarTextures.find(key); known != context.scalarTextures.end()) {
    return known->second;
  }
  const Texture& texture = context.scene.textures[index];
  // A grey bitmap stands for itself.
  const auto* const bitmap = std::get_if<BitmapTexture>(&texture.kind);
  if (bitmap != nullptr && bitmap->bitmap->channels == 1) return index;
  // Any other texture gets a scalar version in the scene, once.
  const uint32_t scalar = static_cast<uint32_t>(context.scene.textures.size());
  context.scene.textures.push_back(scalarTexture(texture, asMitsuba3));
  context.scalarTextures.emplace(key, scalar);
  return scalar;
}

TexturedFloat readTexturedFloat(LoadContext& context, Parameters& parameters, std::string_view name, double fallback) {
  TexturedRgb color = readTextured(context, parameters, name, fallback, ColorRole::unbounded);
  if (color.texture != kNone) color.texture = scalarTextureOf(context, color.texture, !parameters.object().legacy);
  return {.value = meanOf(color.value), .texture = color.texture};
}

bool isColored(LoadContext& context, Parameters& parameters, std::string_view name) {
  const TexturedRgb color = readTextured(context, parameters, name, 0, ColorRole::unbounded);
  if (color.texture == kNone) return !isGrey(color.value);
  const Texture& texture = context.scene.textures[color.texture];
  if (const auto* const board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    return !isGrey(board->color0) || !isGrey(board->color1);
  }
  const Bitmap& bitmap = *std::get<BitmapTexture>(texture.kind).bitmap;
  const std::vector<float>& pixels = bitmap.pixels;
  for (size_t i = 0; bitmap.channels == 3 && i + 2 < pixels.size(); i += 3) {
    if (!isGrey({pixels[i], pixels[i + 1], pixels[i + 2]})) return true;
  }
  return false;
}

Rgb readConstantEmission(LoadContext& context, Parameters& parameters, std::string_view name) {
  const XmlElement* element = parameters.element(name);
  if (!element) return {1, 1, 1};
  if (isTexture(*element)) {
    throw LoadError(parameters.locationOf(name),
                    inQuotes(name) + " of " + parameters.describe() + " is a texture; expected one colour");
  }
  return readColor(context, *element, ColorRole::emission);
}

}  // namespace wavecrest
