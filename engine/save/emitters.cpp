#include "engine/load/matrix.h"
#include "engine/save/preimage.h"
#include "engine/save/sections.h"

namespace wavecrest {

namespace {

// Writes one emitter as an element of the scene.
class EmitterWriter {
 public:
  explicit EmitterWriter(SaveContext& context) : context_(context) {}

  void operator()(const AreaEmitter&) const {}  // stands in its shape
  void operator()(const PointEmitter& e) const {
    const pugi::xml_node node = start("point");
    addPoint(node, "position", e.position);
    addRgb(node, "intensity", e.intensity);
  }
  // The loader takes position and direction from to_world.
  void operator()(const SpotEmitter& e) const {
    const pugi::xml_node node = start("spot");
    addTransform(node, "to_world", e.toWorld);
    addRgb(node, "intensity", e.intensity);
    addFloat(node, "cutoff_angle", e.cutoffAngle);
    addFloat(node, "beam_width", e.beamWidth);
    if (e.texture != kNone) addRef(node, context_.textureIds[e.texture], "texture");
  }
  void operator()(const SunskyEmitter& e) const {
    // The loader makes a unit vector of the direction. The vector written is one from which it makes the same.
    const auto unit = [](const Double3& v) { return (1 / length(v)) * v; };
    const pugi::xml_node node = start("sunsky");
    addTransform(node, "to_world", e.toWorld);
    addFloat(node, "turbidity", e.turbidity);
    addRgb(node, "albedo", e.albedo);
    addVector(node, "sun_direction", unitPreimage(e.sunDirection, 1.0 / 2048, unit));
    addFloat(node, "sun_scale", e.sunScale);
    addFloat(node, "sky_scale", e.skyScale);
    addFloat(node, "sun_aperture", e.sunAperture);
  }
  // The aspect follows from the texture.
  void operator()(const ProjectorEmitter& e) const {
    const pugi::xml_node node = start("projector");
    addTransform(node, "to_world", e.toWorld);
    addString(node, "fov_axis", "x");
    addFloat(node, "fov", e.fovX);
    addFloat(node, "scale", e.scale);
    addTexturedRgb(context_, node, "irradiance", e.irradiance);
  }
  void operator()(const DirectionalEmitter& e) const {
    // As of the sun: a vector from which the loader makes this unit vector.
    const auto unit = [](const Double3& v) { return (1 / length(v)) * v; };
    const pugi::xml_node node = start("directional");
    addVector(node, "direction", unitPreimage(e.direction, 1.0 / 2048, unit));
    addRgb(node, "irradiance", e.irradiance);
  }
  void operator()(const ConstantEmitter& e) const { addRgb(start("constant"), "radiance", e.radiance); }
  void operator()(const EnvmapEmitter& e) const {
    const pugi::xml_node node = start("envmap");
    addString(node, "filename", context_.assets.addEnvironment(e.bitmap));
    addFloat(node, "scale", e.scale);
    addTransform(node, "to_world", e.toWorld);
  }

 private:
  pugi::xml_node start(const char* type) const { return addObject(context_.root, "emitter", type); }

  SaveContext& context_;
};

}  // namespace

void saveEmitters(SaveContext& context) {
  for (const Emitter& emitter : context.scene.emitters) std::visit(EmitterWriter(context), emitter.kind);
}

}  // namespace wavecrest
