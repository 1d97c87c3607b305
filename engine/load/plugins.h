// Every plugin the loader knows, by kind: the one list to extend when a BSDF, shape, emitter, … is added.
//
// A reader takes the parameters of one object and fills in plain data; it must ask for every parameter it knows.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/load/context.h"
#include "engine/load/parameters.h"

namespace wavecrest {

using Geometry = decltype(Shape::kind);
using EmitterKind = decltype(Emitter::kind);

template <class Reader>
struct Plugin {
  std::string_view type;
  Reader read;
};

using BsdfPlugin = Plugin<void (*)(LoadContext&, Parameters&, Material&)>;
using TexturePlugin = Plugin<Texture (*)(LoadContext&, Parameters&)>;
using ShapePlugin = Plugin<Geometry (*)(LoadContext&, Parameters&, const Matrix4& toWorld)>;
using EmitterPlugin = Plugin<EmitterKind (*)(LoadContext&, Parameters&)>;
using SensorPlugin = Plugin<void (*)(Parameters&, Sensor&)>;
using FilterPlugin = Plugin<void (*)(Parameters&, FilmSettings&)>;

std::span<const BsdfPlugin> bsdfPlugins();
std::span<const BsdfPlugin> replacedBsdfPlugins();  // of Mitsuba 0.6: each names the nearest that is supported
std::span<const TexturePlugin> texturePlugins();
std::span<const ShapePlugin> shapePlugins();
std::span<const EmitterPlugin> emitterPlugins();  // all but `area`, which belongs to a shape
std::span<const SensorPlugin> sensorPlugins();
std::span<const FilterPlugin> filterPlugins();

// What a plugin of Mitsuba is about that wavecrest does not render at all, ", since wavecrest renders no hair"; else
// nothing.
std::string outOfScope(const XmlElement& object);

// The reader of the object's type. Unknown: an error, or with --lenient a warning that says what happens instead, and
// null.
template <class Reader>
const Plugin<Reader>* findPlugin(LoadContext& context, std::span<const Plugin<Reader>> plugins,
                                 const XmlElement& object, std::string_view lenientFallback) {
  const std::string_view type = object.get("type");
  std::string list;
  for (const Plugin<Reader>& plugin : plugins) {
    if (plugin.type == type) return &plugin;
    list += (list.empty() ? "" : ", ") + std::string(plugin.type);
  }
  context.unsupported(object.location(),
                      object.tag + " \"" + std::string(type) + "\" is not supported" + outOfScope(object) +
                          (context.options.lenient ? " (" + std::string(lenientFallback) + ")" : "") +
                          "; expected one of " + list);
  return nullptr;
}

}  // namespace wavecrest
