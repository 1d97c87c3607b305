#include "engine/load/load.h"

#include <new>

#include "engine/load/context.h"
#include "engine/load/emitters.h"
#include "engine/load/input_file.h"
#include "engine/load/integrator.h"
#include "engine/load/materials.h"
#include "engine/load/meshes_ahead.h"
#include "engine/load/scene_hash.h"
#include "engine/load/sensor.h"
#include "engine/load/shapes.h"
#include "engine/load/simplify.h"
#include "engine/load/xml_document.h"

namespace wavecrest {

namespace {

// Definitions that no shape uses are checked all the same, and leave nothing in the scene.
void checkUnusedDefinition(LoadContext& context, const XmlElement& element) {
  const size_t materials = context.scene.materials.size(), textures = context.scene.textures.size();
  if (element.tag == "bsdf") {
    if (context.materials.contains(&element)) return;
    materialOf(context, element);
  } else {
    if (context.textures.contains(&element)) return;
    textureOf(context, element);
  }
  // Remove what was read, and forget its indices.
  context.scene.materials.resize(materials);
  context.scene.textures.resize(textures);
  std::erase_if(context.materials, [&](const auto& entry) { return entry.second >= materials; });
  std::erase_if(context.textures, [&](const auto& entry) { return entry.second >= textures; });
  // The scalar version of a texture has a higher index than the texture.
  std::erase_if(context.scalarTextures, [&](const auto& entry) { return entry.second >= textures; });
}

// Reads the first sensor. Further sensors are left out with a note.
void readSensors(LoadContext& context, const std::vector<const XmlElement*>& sensors) {
  if (sensors.empty()) {
    throw LoadError(context.document.scene.location(), "scene has no sensor; expected a <sensor type=\"perspective\">");
  }
  readSensor(context, *sensors.front());
  if (sensors.size() > 1) {
    context.note(sensors[1]->location(), std::to_string(sensors.size()) + " sensors", "the first one is used");
  }
}

// The sky can be hidden; a lamp would have to be transparent for rays from the camera alone.
void checkHiddenEmitters(LoadContext& context) {
  for (const Emitter& emitter : context.scene.emitters) {
    if (!std::holds_alternative<AreaEmitter>(emitter.kind)) continue;
    context.unsupported(emitter.source,
                        "hide_emitters with an area light is not supported: the lamp stays in the picture; expected "
                        "lights without a shape");
    return;
  }
}

// Reads all objects of the file into context.scene, and checks that none is left over.
void readScene(LoadContext& context) {
  Parameters parameters(context, context.document.scene);
  // Integrator and camera.
  const std::vector<const XmlElement*> integrators = parameters.objects("integrator");
  if (integrators.size() > 1) {
    throw LoadError(integrators[1]->location(), "scene has a second integrator; expected at most one");
  }
  if (!integrators.empty()) readIntegrator(context, *integrators.front());
  readSensors(context, parameters.objects("sensor"));
  // Shapes come before lights: an area light at the top level of the file must belong to a shape.
  const std::vector<const XmlElement*> shapes = parameters.objects("shape");
  context.meshesAhead->read(context, shapes);
  for (const XmlElement* shape : shapes) addShape(context, *shape);
  for (const XmlElement* emitter : parameters.objects("emitter")) addEmitter(context, *emitter);
  if (context.scene.defaults.hideEmitters) checkHiddenEmitters(context);
  // Check the definitions that nothing refers to.
  for (const XmlElement* bsdf : parameters.objects("bsdf")) checkUnusedDefinition(context, *bsdf);
  for (const XmlElement* texture : parameters.objects("texture")) checkUnusedDefinition(context, *texture);
  // Mark these as used, so that finish() accepts them: the sensor reads the ones it refers to.
  for (const std::string_view tag : {"sampler", "film", "rfilter"}) parameters.objects(tag);
  parameters.finish();
  if (context.scene.shapes.empty()) {
    throw LoadError(context.document.scene.location(), "scene is empty; expected at least one shape");
  }
}

}  // namespace

Scene loadScene(const std::filesystem::path& xml, const LoadOptions& options) {
  try {
    // Parse the XML.
    const std::unique_ptr<XmlDocument> document = readXmlDocument(xml, options);
    // Convert it to a scene.
    LoadContext context{.options = options, .document = *document, .scene = {}};
    context.meshesAhead = std::make_shared<MeshesAhead>();
    context.scene.name = xml == kStandardInput ? "stdin" : xml.stem().string();
    context.scene.files.assign(document->files.begin(), document->files.end());
    context.scene.warnings = document->warnings;
    readScene(context);
    // The hash is taken before simplification, so that it does not depend on keepAll.
    context.scene.hash = hashScene(context.scene);
    if (!options.keepAll) simplifyScene(context.scene);
    return std::move(context.scene);
  } catch (const std::bad_alloc&) {
    throw LoadError({xml.string(), 0}, "out of memory while loading; expected a scene that fits into memory");
  }
}

}  // namespace wavecrest
