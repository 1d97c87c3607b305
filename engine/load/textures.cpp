#include "engine/load/textures.h"

#include <algorithm>
#include <limits>

#include "engine/load/bitmap_file.h"
#include "engine/load/color.h"
#include "engine/load/materials.h"
#include "engine/load/matrix.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// to_uv as an affine map of (u, v). Its entries for a third coordinate are dropped.
Matrix4 readToUv(Parameters& parameters) {
  const Matrix4 m = parameters.transform("to_uv").value_or(identityMatrix());
  Matrix4 uv = identityMatrix();
  for (size_t i = 0; i < 2; ++i) {
    for (const size_t j : {size_t{0}, size_t{1}, size_t{3}}) uv[i][j] = m[i][j];
  }
  return uv;
}

// A colour is a reflectance; a number may stand for something else, as for diff_trans, which reaches 2.
Rgb readColorOr(LoadContext& context, Parameters& parameters, std::string_view name, double fallback) {
  const XmlElement* element = parameters.element(name);
  if (!element) return {fallback, fallback, fallback};
  const bool isNumber = element->tag == "float" || element->tag == "integer";
  return readColor(context, *element, isNumber ? ColorRole::unbounded : ColorRole::reflectance);
}

// The filter of a bitmap. `trilinear` and `ewa` are read as bilinear, with a note.
Filter readFilter(LoadContext& context, Parameters& parameters) {
  parameters.ignore({"max_anisotropy"});
  const std::string name = toLower(parameters.string("filter_type", "bilinear"));
  if (name == "nearest") return Filter::nearest;
  if (name == "trilinear" || name == "ewa") {
    context.note(parameters.locationOf("filter_type"), "filter_type " + inQuotes(name), "bilinear is used");
  } else if (name != "bilinear") {
    throw LoadError(parameters.locationOf("filter_type"),
                    "unknown filter_type " + inQuotes(name) + "; expected bilinear, nearest, trilinear or ewa");
  }
  return Filter::bilinear;
}

// The wrap mode in the given parameter. Borders of 0 or 1 are read as clamp, with a note.
Wrap readWrap(LoadContext& context, Parameters& parameters, std::string_view parameter, Wrap fallback) {
  if (!parameters.has(parameter)) return fallback;
  const std::string name = toLower(parameters.string(parameter, ""));
  if (name == "repeat") return Wrap::repeat;
  if (name == "mirror") return Wrap::mirror;
  if (name == "clamp") return Wrap::clamp;
  if (name == "zero" || name == "black" || name == "one" || name == "white") {
    context.note(parameters.locationOf(parameter), std::string(parameter) + " " + inQuotes(name), "clamp is used");
    return Wrap::clamp;
  }
  throw LoadError(parameters.locationOf(parameter),
                  "unknown " + std::string(parameter) + " " + inQuotes(name) + "; expected repeat, mirror or clamp");
}

// `wrap_mode`, which version 0.6 overrides for each axis.
Wrap readWrapOfAxes(LoadContext& context, Parameters& parameters) {
  const Wrap both = readWrap(context, parameters, "wrap_mode", Wrap::repeat);
  const Wrap u = readWrap(context, parameters, "wrap_mode_u", both);
  const Wrap v = readWrap(context, parameters, "wrap_mode_v", both);
  if (u != v) {
    context.unsupported(parameters.locationOf(parameters.has("wrap_mode_v") ? "wrap_mode_v" : "wrap_mode_u"),
                        "wrap_mode_u and wrap_mode_v differ; expected the same for both");
  }
  return u;
}

// A channel of a bitmap of three channels, as a bitmap of one channel.
std::shared_ptr<const Bitmap> oneChannel(const Bitmap& colors, size_t channel) {
  auto grey =
      std::make_shared<Bitmap>(Bitmap{.width = colors.width, .height = colors.height, .channels = 1, .pixels = {}});
  for (size_t i = channel; i < colors.pixels.size(); i += 3) grey->pixels.push_back(colors.pixels[i]);
  return grey;
}

// The channel of the bitmap that the parameter `channel` names; the whole bitmap if it is absent.
std::shared_ptr<const Bitmap> readChannel(LoadContext& context, Parameters& parameters,
                                          const std::shared_ptr<const Bitmap>& bitmap) {
  const std::string name = parameters.string("channel", "");
  if (name.empty() || bitmap->channels == 1) return bitmap;
  constexpr std::string_view kNames = "rgb";
  // Alpha is not read from files. What it mostly says is how opaque a surface is.
  if (name == "a") {
    context.unsupported(parameters.locationOf("channel"),
                        "channel \"a\" of a bitmap is not supported" +
                            std::string(context.options.lenient ? " (replaced by 1)" : "") + "; expected r, g or b");
    return std::make_shared<Bitmap>(Bitmap{.width = 1, .height = 1, .channels = 1, .pixels = {1}});
  }
  const size_t channel = kNames.find(name);
  if (name.size() != 1 || channel == std::string_view::npos) {
    throw LoadError(parameters.locationOf("channel"),
                    "channel " + inQuotes(name) + " of a bitmap is not supported; expected r, g or b");
  }
  return oneChannel(*bitmap, channel);
}

// A number, three numbers, or a colour: Mitsuba's rawconstant takes any of these as they are.
Rgb readRawValue(LoadContext& context, Parameters& parameters) {
  const XmlElement* element = parameters.element("value");
  if (!element) throw LoadError(parameters.location(), parameters.describe() + " has no value; expected one");
  if (element->tag != "vector" && element->tag != "point") return readColor(context, *element, ColorRole::unbounded);
  const Double3 value = *parameters.vector("value");
  constexpr double kMost = double{std::numeric_limits<float>::max()};
  if (std::ranges::any_of(value, [](double v) { return v < -kMost || v > kMost; })) {
    throw LoadError(parameters.locationOf("value"), inQuotes("value") + " of " + parameters.describe() +
                                                        " is out of range; expected values up to 3.4e38");
  }
  return value;
}

// A bitmap of one pixel.
Texture constantTexture(const Rgb& value) {
  auto bitmap = std::make_shared<Bitmap>(Bitmap{.width = 1, .height = 1, .channels = 3, .pixels = {}});
  for (const double channel : value) bitmap->pixels.push_back(static_cast<float>(channel));
  return {.kind = BitmapTexture{.bitmap = std::move(bitmap), .filter = Filter::nearest}, .toUv = identityMatrix()};
}

}  // namespace

Texture readBitmapTexture(LoadContext& context, Parameters& parameters) {
  BitmapTexture texture{
      .bitmap = nullptr, .filter = readFilter(context, parameters), .wrap = readWrapOfAxes(context, parameters)};
  // Whether the file's numbers are light already. In version 0.6 a gamma of 1 says so, 0 leaves it to the file, and -1
  // stands for the sRGB curve.
  const double gamma = parameters.real("gamma", 0);
  const bool raw = parameters.boolean("raw", false) || gamma == 1;
  parameters.ignore({"format", "accel", "cache"});  // how Mitsuba stores it
  // Read the file, and take one channel of it if asked.
  const std::string filename = parameters.requiredString("filename");
  const BitmapFile file =
      readBitmap(context, context.resolvePath(filename, parameters.object()), raw, parameters.locationOf("filename"));
  if (gamma != 0 && gamma != 1 && !(gamma == -1 && file.encoded)) {
    context.note(parameters.locationOf("gamma"), "gamma of a bitmap",
                 "left out: 8- and 16-bit files have the sRGB curve, others none");
  }
  texture.bitmap = readChannel(context, parameters, file.bitmap);
  return {.kind = std::move(texture), .toUv = readToUv(parameters)};
}

Texture readRawConstant(LoadContext& context, Parameters& parameters) {
  return constantTexture(readRawValue(context, parameters));
}

Texture readScaleTexture(LoadContext& context, Parameters& parameters) {
  // The factor is a number or a colour.
  const XmlElement* factor = parameters.element("scale");
  const Rgb scale = factor ? readColor(context, *factor, ColorRole::unbounded) : Rgb{1, 1, 1};
  // What it scales is the colour `value`, or a nested texture of any name. The nested texture is a part of this one: it
  // leaves nothing of its own in the scene.
  const XmlElement* value = parameters.element("value");
  Texture texture = value != nullptr && value->tag != "texture"
                        ? constantTexture(readColor(context, *value, ColorRole::unbounded))
                        : readTexture(context, parameters.onlyObject("texture"));
  if (auto* const board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    for (size_t i = 0; i < 3; ++i) {
      board->color0[i] *= scale[i];
      board->color1[i] *= scale[i];
    }
    return texture;
  }
  // Scale a copy, as other textures may share the bitmap. Grey times grey stays grey.
  auto& bitmap = std::get<BitmapTexture>(texture.kind).bitmap;
  const bool grey = bitmap->channels == 1 && scale[0] == scale[1] && scale[0] == scale[2];
  Bitmap scaled{.width = bitmap->width, .height = bitmap->height, .channels = grey ? 1u : 3u, .pixels = {}};
  scaled.pixels.reserve(size_t{scaled.width} * scaled.height * scaled.channels);
  for (size_t i = 0; i < size_t{scaled.width} * scaled.height; ++i) {
    for (size_t c = 0; c < scaled.channels; ++c) {
      const float texel = bitmap->pixels[bitmap->channels == 1 ? i : 3 * i + c];
      scaled.pixels.push_back(static_cast<float>(scale[c] * texel));
    }
  }
  bitmap = std::make_shared<Bitmap>(std::move(scaled));
  return texture;
}

Texture readCheckerboard(LoadContext& context, Parameters& parameters) {
  return {.kind = CheckerboardTexture{.color0 = readColorOr(context, parameters, "color0", 0.4),
                                      .color1 = readColorOr(context, parameters, "color1", 0.2)},
          .toUv = readToUv(parameters)};
}

}  // namespace wavecrest
