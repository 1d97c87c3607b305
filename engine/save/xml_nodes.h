// Elements of Mitsuba's scene format as pugixml nodes. Numbers are written with the fewest digits that read back the
// same.
#pragma once

#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace wavecrest {

// <TAG type="TYPE">, with a name or an id where they are not empty.
pugi::xml_node addObject(pugi::xml_node parent, const char* tag, const char* type, const std::string& id = {},
                         const char* name = "");
void addRef(pugi::xml_node parent, const std::string& id, const char* name = "");

void addFloat(pugi::xml_node parent, const char* name, double value);
void addInteger(pugi::xml_node parent, const char* name, int64_t value);
void addBoolean(pugi::xml_node parent, const char* name, bool value);
void addString(pugi::xml_node parent, const char* name, const std::string& value);
void addRgb(pugi::xml_node parent, const char* name, const Rgb& value);
// A colour that may be above 1 where Mitsuba takes no such <rgb>: a <spectrum>.
void addUnbounded(pugi::xml_node parent, const char* name, const Rgb& value);
void addPoint(pugi::xml_node parent, const char* name, const Double3& value);
void addVector(pugi::xml_node parent, const char* name, const Double3& value);
// Nothing for the identity, which is every transform's default.
void addTransform(pugi::xml_node parent, const char* name, const Matrix4& value);

// Text as it may stand in an id or a comment: letters, digits and -; others become -.
std::string xmlName(std::string_view text);

// Ids of one file: each is given out once.
class XmlNames {
 public:
  // `wanted` with a number behind it if it is taken; `fallback` instead where it is empty.
  std::string unique(const std::string& wanted, const std::string& fallback);

 private:
  std::set<std::string> taken_;
};

}  // namespace wavecrest
