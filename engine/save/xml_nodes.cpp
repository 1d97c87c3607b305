#include "engine/save/xml_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/load/matrix.h"

namespace wavecrest {

namespace {

// <TAG name="NAME" value="VALUE">.
void addValue(pugi::xml_node parent, const char* tag, const char* name, const std::string& value) {
  pugi::xml_node node = parent.append_child(tag);
  node.append_attribute("name") = name;
  node.append_attribute("value") = value.c_str();
}

}  // namespace

pugi::xml_node addObject(pugi::xml_node parent, const char* tag, const char* type, const std::string& id,
                         const char* name) {
  pugi::xml_node node = parent.append_child(tag);
  node.append_attribute("type") = type;
  if (!id.empty()) node.append_attribute("id") = id.c_str();
  if (*name != '\0') node.append_attribute("name") = name;
  return node;
}

void addRef(pugi::xml_node parent, const std::string& id, const char* name) {
  pugi::xml_node node = parent.append_child("ref");
  if (*name != '\0') node.append_attribute("name") = name;
  node.append_attribute("id") = id.c_str();
}

// {} prints a number with the fewest digits that read back the same.
void addFloat(pugi::xml_node parent, const char* name, double value) {
  addValue(parent, "float", name, fmt::format("{}", value));
}
void addInteger(pugi::xml_node parent, const char* name, int64_t value) {
  addValue(parent, "integer", name, fmt::format("{}", value));
}
void addBoolean(pugi::xml_node parent, const char* name, bool value) {
  addValue(parent, "boolean", name, value ? "true" : "false");
}
void addString(pugi::xml_node parent, const char* name, const std::string& value) {
  // The loader reads `\$` as a dollar, and a dollar alone as the begin of a variable's name.
  std::string text;
  for (const char c : value) {
    if (c == '$') text += '\\';
    text += c;
  }
  addValue(parent, "string", name, text);
}
void addRgb(pugi::xml_node parent, const char* name, const Rgb& value) {
  addValue(parent, "rgb", name, fmt::format("{}", fmt::join(value, ", ")));
}
void addUnbounded(pugi::xml_node parent, const char* name, const Rgb& value) {
  const pugi::xml_node spectrum = addObject(parent, "spectrum", "srgb", {}, name);
  addRgb(spectrum, "color", value);
  addBoolean(spectrum, "unbounded", true);
}
void addPoint(pugi::xml_node parent, const char* name, const Double3& value) {
  addValue(parent, "point", name, fmt::format("{}", fmt::join(value, ", ")));
}
void addVector(pugi::xml_node parent, const char* name, const Double3& value) {
  addValue(parent, "vector", name, fmt::format("{}", fmt::join(value, ", ")));
}

void addTransform(pugi::xml_node parent, const char* name, const Matrix4& value) {
  if (isIdentity(value)) return;
  pugi::xml_node node = parent.append_child("transform");
  node.append_attribute("name") = name;
  // All sixteen numbers, by rows.
  std::string rows;
  for (const std::array<double, 4>& row : value) {
    rows += fmt::format("{}{}", rows.empty() ? "" : "  ", fmt::join(row, " "));
  }
  node.append_child("matrix").append_attribute("value") = rows.c_str();
}

std::string xmlName(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    // No "-" at the start and no two in a row: "--" would end a comment.
    if (plain) {
      name += c;
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  // No "-" at the end either.
  if (!name.empty() && name.back() == '-') name.pop_back();
  return name;
}

std::string XmlNames::unique(const std::string& wanted, const std::string& fallback) {
  // The first of base, base-2, base-3 and so on that is not taken.
  std::string base = xmlName(wanted);
  if (base.empty()) base = fallback;
  std::string name = base;
  for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}-{}", base, i);
  return name;
}

}  // namespace wavecrest
