#include "engine/load/emitters.h"

#include <algorithm>
#include <cmath>

#include "engine/load/bitmap_file.h"
#include "engine/load/materials.h"
#include "engine/load/perspective.h"
#include "engine/load/values.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {

namespace {

// Mitsuba's sampling_weight only guides which light is sampled. Returns false if the light is never sampled.
bool readIsSampled(Parameters& parameters) {
  const double weight = parameters.real("sampling_weight", 1);
  if (weight < 0) {
    throw LoadError(parameters.locationOf("sampling_weight"), "sampling_weight is negative; expected 0 or more");
  }
  return weight > 0;
}

Matrix4 readToWorld(Parameters& parameters) { return parameters.transform("to_world").value_or(identityMatrix()); }

// `v` at unit length. LoadError at the parameter `name` if `v` has no direction.
Double3 unitDirection(const Parameters& parameters, const Double3& v, std::string_view name) {
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size)) {
    throw LoadError(parameters.locationOf(name),
                    inQuotes(name) + " has no direction; expected a vector of positive length");
  }
  return (1 / size) * v;
}

// Whether the light surrounds the scene.
bool isInfinite(const EmitterKind& kind) {
  return std::holds_alternative<ConstantEmitter>(kind) || std::holds_alternative<EnvmapEmitter>(kind) ||
         std::holds_alternative<SunskyEmitter>(kind);
}

// Whether the light is a point or a direction: paths cannot hit it by chance.
bool isDelta(const EmitterKind& kind) {
  return std::holds_alternative<PointEmitter>(kind) || std::holds_alternative<SpotEmitter>(kind) ||
         std::holds_alternative<ProjectorEmitter>(kind) || std::holds_alternative<DirectionalEmitter>(kind);
}

}  // namespace

void addEmitter(LoadContext& context, const XmlElement& emitter) {
  if (emitter.get("type") == "area") {
    // Shapes refer to it by its id.
    if (context.areaLights.contains(&emitter)) return;
    throw LoadError(emitter.location(),
                    "area light outside of a shape; expected it as a child of the shape that emits, or a <ref> there");
  }
  // Read the light.
  const EmitterPlugin* plugin = findPlugin(context, emitterPlugins(), emitter, "left out");
  if (!plugin) return;
  Parameters parameters(context, emitter);
  EmitterKind kind = plugin->read(context, parameters);
  const bool isSampled = readIsSampled(parameters);
  parameters.finish();
  if (!isSampled && isDelta(kind)) {
    context.note(emitter.location(), parameters.describe() + " of sampling_weight 0",
                 "left out, since Mitsuba never samples it");
    return;
  }
  // Only one light may surround the scene. A sun and a sky of the same day become one light.
  if (isInfinite(kind)) {
    for (Emitter& other : context.scene.emitters) {
      if (joinSunAndSky(other.kind, kind)) return;
      if (isInfinite(other.kind)) {
        throw LoadError(emitter.location(), "second environment light (the first is at line " +
                                                std::to_string(other.source.line) + "); expected at most one");
      }
    }
  }
  context.scene.emitters.push_back({.kind = std::move(kind), .source = emitter.location()});
}

AreaEmitter readAreaEmitter(LoadContext& context, const XmlElement& emitter, uint32_t shape) {
  if (emitter.get("type") != "area") {
    throw LoadError(emitter.location(),
                    "emitter " + inQuotes(emitter.get("type")) + " inside a shape; expected \"area\"");
  }
  Parameters parameters(context, emitter);
  AreaEmitter light{.radiance = readTexturedEmission(context, parameters, "radiance"), .shape = shape};
  readIsSampled(parameters);
  // The light is where its shape is.
  if (parameters.has("to_world")) {
    throw LoadError(parameters.locationOf("to_world"), "area light has a to_world; expected it on the shape");
  }
  parameters.finish();
  return light;
}

EmitterKind readPoint(LoadContext& context, Parameters& parameters) {
  // `position`, or the image of the origin.
  const std::optional<Double3> position = parameters.vector("position");
  const std::optional<Matrix4> toWorld = parameters.transform("to_world");
  if (position && toWorld) {
    throw LoadError(parameters.locationOf("to_world"),
                    "point light has position and to_world; expected one of the two");
  }
  return PointEmitter{.position = position.value_or(transformPoint(toWorld.value_or(identityMatrix()), {0, 0, 0})),
                      .intensity = readConstantEmission(context, parameters, "intensity")};
}

EmitterKind readSpot(LoadContext& context, Parameters& parameters) {
  // In its own space the light is at the origin and shines along +z.
  SpotEmitter spot{.toWorld = readToWorld(parameters)};
  spot.position = transformPoint(spot.toWorld, {0, 0, 0});
  spot.direction = unitDirection(parameters, transformVector(spot.toWorld, {0, 0, 1}), "to_world");
  if (!isSimilarity(spot.toWorld)) {
    context.note(parameters.locationOf("to_world"), "spot light whose to_world scales unevenly or shears",
                 "its cone stays circular; Mitsuba deforms it");
  }
  spot.intensity = readConstantEmission(context, parameters, "intensity");
  // Half angles in degrees. The intensity falls off between beam_width and cutoff_angle.
  spot.cutoffAngle = parameters.positiveReal("cutoff_angle", 20);
  spot.beamWidth = parameters.real("beam_width", 0.75 * spot.cutoffAngle);
  if (spot.cutoffAngle > 90) {
    throw LoadError(parameters.locationOf("cutoff_angle"), "cutoff_angle is above 90 degrees; expected 0 to 90");
  }
  if (spot.beamWidth < 0 || spot.beamWidth > spot.cutoffAngle) {
    throw LoadError(parameters.locationOf("beam_width"), "beam_width is " + std::to_string(spot.beamWidth) +
                                                             "; expected 0 to the cutoff_angle, " +
                                                             std::to_string(spot.cutoffAngle) + " degrees");
  }
  // The light projects the texture as a picture: to_world may scale it, but not shear it.
  if (const XmlElement* texture = parameters.element("texture")) {
    checkPerpendicular(spot.toWorld, "the spot light", parameters.locationOf("to_world"));
    spot.texture = emissionTextureOf(context, *texture, parameters.locationOf("texture"));
  }
  return spot;
}

namespace {

// Width over height of a texture's picture; 1 where it has no resolution.
double aspectOf(const LoadContext& context, const TexturedRgb& value) {
  if (value.texture == kNone) return 1;
  const auto* const bitmap = std::get_if<BitmapTexture>(&context.scene.textures[value.texture].kind);
  if (bitmap == nullptr) return 1;
  return static_cast<double>(bitmap->bitmap->width) / bitmap->bitmap->height;
}

}  // namespace

EmitterKind readProjector(LoadContext& context, Parameters& parameters) {
  ProjectorEmitter projector{.irradiance = readTexturedEmission(context, parameters, "irradiance"),
                             .scale = parameters.real("scale", 1),
                             .toWorld = readToWorld(parameters)};
  if (!(projector.scale >= 0)) {
    throw LoadError(parameters.locationOf("scale"), "scale of the projector is negative; expected 0 or more");
  }
  checkRigid(projector.toWorld, "the projector", parameters.locationOf("to_world"));
  // The field of view refers to the sides of the picture.
  projector.aspect = aspectOf(context, projector.irradiance);
  projector.fovX = readHorizontalFov(parameters, projector.aspect);
  return projector;
}

EmitterKind readDirectional(LoadContext& context, Parameters& parameters) {
  // `direction`, or the image of +z.
  const std::optional<Double3> direction = parameters.vector("direction");
  const std::optional<Matrix4> toWorld = parameters.transform("to_world");
  if (direction && toWorld) {
    throw LoadError(parameters.locationOf("to_world"),
                    "directional light has direction and to_world; expected one of the two");
  }
  const Double3 along = direction.value_or(transformVector(toWorld.value_or(identityMatrix()), {0, 0, 1}));
  return DirectionalEmitter{.direction = unitDirection(parameters, along, direction ? "direction" : "to_world"),
                            .irradiance = readConstantEmission(context, parameters, "irradiance")};
}

EmitterKind readConstant(LoadContext& context, Parameters& parameters) {
  parameters.ignore({"to_world"});  // the same radiance from everywhere
  return ConstantEmitter{.radiance = readConstantEmission(context, parameters, "radiance")};
}

void checkEnvironmentTransform(LoadContext& context, const Parameters& parameters, const Matrix4& toWorld) {
  const SourceLocation where = parameters.locationOf("to_world");
  checkPerpendicular(toWorld, "the environment", where);
  if (!isSimilarity(toWorld)) {
    context.note(where, "environment whose to_world scales unevenly",
                 "the scale is left out, and only the rotation used");
  }
}

namespace {

// The bitmap without texels of negative luminance, which a light cannot have. A note counts those that become 0. Other
// negative values are those of colours outside of Rec. 709, and stay as in Mitsuba.
std::shared_ptr<const Bitmap> withoutNegatives(LoadContext& context, std::shared_ptr<const Bitmap> bitmap,
                                               const std::string& filename, const SourceLocation& where) {
  const size_t channels = bitmap->channels;
  const auto isNegative = [&](size_t texel) {
    const float* const p = &bitmap->pixels[texel * channels];
    const Rgb colour = channels == 3 ? Rgb{p[0], p[1], p[2]} : Rgb{p[0], p[0], p[0]};
    return luminance(colour) < 0 || (luminance(colour) == 0 && colour != Rgb{0, 0, 0});
  };
  std::vector<size_t> negative;
  for (size_t i = 0; i < bitmap->pixels.size() / channels; ++i) {
    if (isNegative(i)) negative.push_back(i);
  }
  if (negative.empty()) return bitmap;
  context.note(
      where,
      "texels of negative luminance in the environment " + inQuotes(filename) + ": " + std::to_string(negative.size()),
      "black is used");
  // A copy, as textures may share the bitmap.
  auto clamped = std::make_shared<Bitmap>(*bitmap);
  for (const size_t texel : negative) std::fill_n(&clamped->pixels[texel * channels], channels, 0.0f);
  return clamped;
}

}  // namespace

EmitterKind readEnvmap(LoadContext& context, Parameters& parameters) {
  const std::string filename = parameters.requiredString("filename");
  const SourceLocation where = parameters.locationOf("filename");
  // 8- and 16-bit images are decoded to linear light (raw is false).
  EnvmapEmitter light{
      .bitmap = readBitmap(context, context.resolvePath(filename, parameters.object()), false, where).bitmap,
      .scale = parameters.real("scale", 1),
      .toWorld = readToWorld(parameters)};
  parameters.ignore({"mis_compensation"});  // guides sampling only
  if (!(light.scale >= 0)) {
    throw LoadError(parameters.locationOf("scale"), "scale of the environment is negative; expected 0 or more");
  }
  checkEnvironmentTransform(context, parameters, light.toWorld);
  light.bitmap = withoutNegatives(context, std::move(light.bitmap), filename, where);
  return light;
}

}  // namespace wavecrest
