#include "engine/load/matrix.h"
#include "engine/save/preimage.h"
#include "engine/save/sections.h"

namespace wavecrest {

namespace {

class EmitterWriter {
 public:
  explicit EmitterWriter(SaveContext& context) : context_(context) {}

  void operator()(const AreaEmitter&) const {}  // stands in its shape
  void operator()(const PointEmitter& e) const {
    const pugi::xml_node node = start("point");
    addPoint(node, "position", e.position);
    addRgb(node, "intensity", e.intensity);
  }
  void operator()(const SpotEmitter& e) const {
    const pugi::xml_node node = start("spot");
    addTransform(node, "to_world", e.toWorld);
    addRgb(node, "intensity", e.intensity);
    addFloat(node, "cutoff_angle", e.cutoffAngle);
    addFloat(node, "beam_width", e.beamWidth);
  }
  void operator()(const DirectionalEmitter& e) const {
    // The loader makes a unit vector of it.
    const auto unit = [](const Double3& v) { return (1 / length(v)) * v; };
    const pugi::xml_node node = start("directional");
    addVector(node, "direction", unitPreimage(e.direction, 1.0 / 2048, unit));
    addRgb(node, "irradiance", e.irradiance);
  }
  void operator()(const ConstantEmitter& e) const { addRgb(start("constant"), "radiance", e.radiance); }
  void operator()(const EnvmapEmitter& e) const {
    const pugi::xml_node node = start("envmap");
    addString(node, "filename", context_.assets.addBitmap(e.bitmap, false).filename);
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
