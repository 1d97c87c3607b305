// The reference of the scene language (scenes/plugins.json) has an entry for each plugin and parameter that the loader
// knows, and no other.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/load/load.h"
#include "engine/load/plugins.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// By object, type and name: the default as text, of booleans and numbers; empty of others.
using AskedNames = std::map<std::string, std::map<std::string, std::map<std::string, std::string>>>;

std::string textOf(const ParameterFallback& fallback) {
  if (const auto* value = std::get_if<bool>(&fallback)) return *value ? "true" : "false";
  if (const auto* value = std::get_if<int64_t>(&fallback)) return std::to_string(*value);
  const auto* const number = std::get_if<double>(&fallback);
  return number != nullptr ? Json(*number == std::floor(*number) ? Json(std::llround(*number)) : Json(*number)).dump()
                           : "";
}

// What readers ask for while they read these scenes, which have every plugin between them.
const AskedNames& askedNames() {
  static const AskedNames all = [] {
    AskedNames names;
    LoadOptions options;
    options.lenient = true;
    options.asked = [&](const AskedParameter& asked) {
      std::string& known = names[std::string(asked.object)][std::string(asked.type)][std::string(asked.name)];
      if (known.empty()) known = textOf(asked.fallback);
    };
    for (const char* folder : {"scenes/features", "scenes/validation", "scenes/plugins", "tests/load/data/plugins"}) {
      for (const auto& file : fs::directory_iterator(fs::path(WAVECREST_SOURCE) / folder)) {
        if (file.path().extension() == ".xml") loadScene(file.path(), options);
      }
    }
    return names;
  }();
  return all;
}

const Json& reference() {
  static const Json json = Json::parse(std::ifstream(fs::path(WAVECREST_SOURCE) / "scenes/plugins.json"));
  return json;
}

// The entry of a plugin, or that of all plugins of its object; null if there is none.
const Json* entryOf(const std::string& object, const std::string& type) {
  const Json& plugins = reference().at("plugins");
  if (!plugins.contains(object)) return nullptr;
  for (const std::string& name : {type, std::string("*")}) {
    if (plugins.at(object).contains(name)) return &plugins.at(object).at(name);
  }
  return nullptr;
}

// Its parameters, with those of the groups that it uses.
std::map<std::string, Json> parametersOf(const Json& entry) {
  std::map<std::string, Json> all;
  const auto add = [&](const Json& parameters) {
    for (const auto& [name, parameter] : parameters.items()) all.try_emplace(name, parameter);
  };
  if (entry.contains("parameters")) add(entry.at("parameters"));
  for (const Json& group : entry.value("uses", Json::array())) {
    add(reference().at("groups").at(group.get<std::string>()));
  }
  return all;
}

TEST(PluginReference, hasEachParameterThatTheLoaderAsksForAndItsDefault) {
  for (const auto& [object, types] : askedNames()) {
    for (const auto& [type, names] : types) {
      const Json* const entry = entryOf(object, type);
      ASSERT_NE(entry, nullptr) << object << ' ' << type;
      const std::map<std::string, Json> listed = parametersOf(*entry);
      for (const auto& [name, asked] : names) {
        SCOPED_TRACE(object + ' ' + type + ": " + name);
        const auto found = listed.find(name);
        ASSERT_NE(found, listed.end());
        const std::string fallback = found->second.at("default");
        // Where a default is found by more than one reader, the entry says in words how.
        const bool said = fallback == "true" || fallback == "false" ||
                          fallback.find_first_not_of("-.0123456789") == std::string::npos;
        if (!asked.empty() && (said || asked == "true" || asked == "false")) {
          EXPECT_EQ(fallback, asked);
        }
      }
    }
  }
}

// Of the sphere's material.
double intIorOf(const std::string& bsdf) {
  const Scene scene = loadBody("<shape type=\"sphere\">" + bsdf + "</shape>");
  const Material& material = scene.materials.at(0);
  const auto* const plastic = std::get_if<Plastic>(&material.kind);
  return plastic != nullptr ? plastic->intIor : std::get<Dielectric>(material.kind).intIor;
}

TEST(PluginReference, namesTheSubstanceWithin) {
  for (const std::string type : {"dielectric", "thindielectric", "roughdielectric", "plastic", "roughplastic"}) {
    const std::string substance = parametersOf(*entryOf("bsdf", type)).at("int_ior").at("default");
    const std::string begin = "<bsdf type=\"" + type + "\">";
    EXPECT_EQ(intIorOf(begin + R"(<string name="int_ior" value=")" + substance + "\"/></bsdf>"),
              intIorOf(begin + "</bsdf>"))
        << type;
  }
}

// What has to be nested in a BSDF.
std::string nestedIn(const std::string& type) {
  const std::string diffuse = R"(<bsdf type="diffuse"/>)";
  if (type == "blendbsdf") return diffuse + diffuse;
  return type == "mask" || type == "coating" || type == "roughcoating" ? diffuse : "";
}

TEST(PluginReference, saysOfNoBsdfsParameterThatItMayBeATextureWhereItMayNot) {
  const auto board = [](const std::string& name) { return R"(<texture type="checkerboard" name=")" + name + "\"/>"; };
  LoadOptions options;
  options.lenient = true;  // for those of 0.6 that are replaced
  for (const auto& [type, entry] : reference().at("plugins").at("bsdf").items()) {
    for (const auto& [name, parameter] : parametersOf(entry)) {
      if (!parameter.at("kind").get<std::string>().ends_with(" or texture")) continue;
      SCOPED_TRACE(type + ": " + name);
      std::string textures = board(name);
      if (name == "alpha_u") textures += board("alpha_v");
      if (name == "alpha_v") textures += board("alpha_u");
      EXPECT_NO_THROW(loadBody(
          "<shape type=\"sphere\"><bsdf type=\"" + type + "\">" + textures + nestedIn(type) + "</bsdf></shape>",
          options));
    }
  }
}

TEST(PluginReference, hasNoParameterThatTheLoaderDoesNotKnow) {
  for (const auto& [object, types] : reference().at("plugins").items()) {
    for (const auto& [type, entry] : types.items()) {
      std::set<std::string> asked;
      const auto known = askedNames().find(object);
      if (known != askedNames().end()) {
        for (const auto& [name, names] : known->second) {
          if (type != "*" && name != type) continue;
          for (const auto& [parameter, fallback] : names) asked.insert(parameter);
        }
      }
      for (const auto& [name, parameter] : parametersOf(entry)) {
        EXPECT_TRUE(asked.contains(name)) << object << ' ' << type << ": " << name;
        EXPECT_FALSE(parameter.at("kind").get<std::string>().empty()) << name;
      }
    }
  }
}

template <class Reader>
void expectEntries(const std::string& object, std::span<const Plugin<Reader>> plugins) {
  for (const auto& plugin : plugins) {
    const Json* const entry = entryOf(object, std::string(plugin.type));
    ASSERT_NE(entry, nullptr) << object << ' ' << plugin.type;
    EXPECT_FALSE(entry->at("summary").get<std::string>().empty()) << object << ' ' << plugin.type;
  }
}

TEST(PluginReference, hasEachPluginAndNoOther) {
  expectEntries("bsdf", bsdfPlugins());
  expectEntries("bsdf", replacedBsdfPlugins());
  expectEntries("texture", texturePlugins());
  expectEntries("shape", shapePlugins());
  expectEntries("emitter", emitterPlugins());
  expectEntries("sensor", sensorPlugins());
  expectEntries("rfilter", filterPlugins());
  const Json& plugins = reference().at("plugins");
  EXPECT_EQ(plugins.at("bsdf").size(), bsdfPlugins().size() + replacedBsdfPlugins().size());
  EXPECT_EQ(plugins.at("texture").size(), texturePlugins().size());
  EXPECT_EQ(plugins.at("shape").size(), shapePlugins().size() + 2) << "shapegroup and instance";
  EXPECT_EQ(plugins.at("emitter").size(), emitterPlugins().size() + 1) << "area";
  EXPECT_EQ(plugins.at("sensor").size(), sensorPlugins().size());
  EXPECT_EQ(plugins.at("rfilter").size(), filterPlugins().size());
}

}  // namespace
}  // namespace wavecrest
