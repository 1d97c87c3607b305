#include "engine/load/upgrade.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

namespace wavecrest {

namespace {

bool isLower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool isUpper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

// intIOR -> int_ior: an underscore where lower case turns to upper case, and the whole run of capitals lowered.
std::string camelToUnderscore(const std::string& name) {
  std::string result;
  bool inRun = false;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool startsRun = i > 0 && isLower(name[i - 1]) && isUpper(c);
    if (startsRun) result += '_';
    inRun = isUpper(c) && (startsRun || inRun);
    result += inRun ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
  }
  return result;
}

}  // namespace

void upgradeElement(XmlElement& element) {
  if (element.tag == "lookAt") element.tag = "lookat";
  // `intent` has an effect in builds of Mitsuba that render spectra only.
  if (element.tag == "rgb" || element.tag == "spectrum") {
    std::erase_if(element.attributes, [](const auto& attribute) { return attribute.first == "intent"; });
  }
  for (auto& [name, value] : element.attributes) {
    // The name of a <default> is that of a variable, not that of a parameter.
    if (name == "name" && element.tag != "default") value = camelToUnderscore(value);
    if (name == "type" && element.tag == "bsdf" && value == "bump") value = "bumpmap";  // of 0.4
  }
}

void upgradeChildren(XmlElement& element) {
  if (!element.isObject()) return;
  // Take out the values. Those that are absent leave the texture coordinates as they are.
  std::string offset[2] = {"0", "0"}, scale[2], bothScales = "1";
  bool any = false;
  XmlElement transform;
  std::erase_if(element.children, [&](const XmlElement& child) {
    constexpr std::string_view kNames[] = {"uoffset", "voffset", "uscale", "vscale", "uvscale"};
    std::string* const values[] = {&offset[0], &offset[1], &scale[0], &scale[1], &bothScales};
    const auto* const name = std::ranges::find(kNames, child.get("name"));
    if (name == std::end(kNames)) return false;
    *values[name - kNames] = child.get("value");
    any = true;
    // An error in the transform is reported at the last of the values.
    transform.line = child.line;
    return true;
  });
  for (std::string& own : scale) own = own.empty() ? bothScales : own;
  // The reflectance of `diffuse` and `roughdiffuse` had a longer name.
  const std::string_view type = element.get("type");
  if (element.tag == "bsdf" && (type == "diffuse" || type == "roughdiffuse")) {
    for (XmlElement& child : element.children) {
      for (auto& [name, value] : child.attributes) {
        if (name == "name" && value == "diffuse_reflectance") value = "reflectance";
      }
    }
  }
  if (!any) return;
  // As 0.6 does: first the scale. Mitsuba 3 upgrades to the other order, which moves the texture.
  transform.tag = "transform";
  transform.file = element.file;
  transform.attributes = {{"name", "to_uv"}};
  XmlElement translate = transform, scaling = transform;
  translate.tag = "translate";
  translate.attributes = {{"x", offset[0]}, {"y", offset[1]}};
  scaling.tag = "scale";
  scaling.attributes = {{"x", scale[0]}, {"y", scale[1]}};
  transform.children = {std::move(scaling), std::move(translate)};
  element.children.push_back(std::move(transform));
}

}  // namespace wavecrest
