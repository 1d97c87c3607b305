// The parameters of one object (<bsdf>, <shape>, …), read by name and type.
//
// In: the element and the loading context. Out: values, defaults where the file is silent, and errors at the line that
// is wrong. What a reader never asks for is reported by finish(), with the list of what it did ask for: no parameter
// is ignored in silence, and the names a plugin knows are written down once, where they are read.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/context.h"
#include "engine/load/matrix.h"

namespace wavecrest {

class Parameters {
 public:
  Parameters(LoadContext& context, const XmlElement& object);

  bool has(std::string_view name);
  double real(std::string_view name, double fallback);
  double requiredReal(std::string_view name);
  double positiveReal(std::string_view name, double fallback);  // > 0
  int64_t integer(std::string_view name, int64_t fallback, int64_t lowest, int64_t highest);
  bool boolean(std::string_view name, bool fallback);
  std::string string(std::string_view name, std::string_view fallback);
  std::string requiredString(std::string_view name);
  std::optional<Double3> vector(std::string_view name);  // <point> or <vector>
  std::optional<Matrix4> transform(std::string_view name);
  // An index of refraction: a number, or the name of a substance (ior_table.h).
  double ior(std::string_view name, std::string_view fallback);
  // The element that gives `name` (a value, an object, or what a <ref> points to); null if there is none.
  const XmlElement* element(std::string_view name);

  // The first (or every) object of the given tag among the children, whatever its name; <ref>s followed.
  std::vector<const XmlElement*> objects(std::string_view tag);
  // Exactly one such object.
  const XmlElement& onlyObject(std::string_view tag);

  // Accepts and ignores parameters that cannot change an image.
  void ignore(std::initializer_list<std::string_view> names);
  // Accepts parameters that may change it a little; a note says so where one is given.
  void leaveOut(std::initializer_list<std::string_view> names, const std::string& effect);
  // Accepts what is left, or of that only parameters of these names, and returns its names, "a, b", for a note.
  std::string takeOthers();
  std::string takeOthers(std::span<const std::string_view> names);
  // Reports what is left over.
  void finish();

  // Where the parameter stands, or the object if it is absent.
  SourceLocation locationOf(std::string_view name) const;
  SourceLocation location() const { return object_.location(); }
  const XmlElement& object() const { return object_; }
  std::string describe() const;  // bsdf "diffuse"

 private:
  struct Child {
    const XmlElement* site;    // as written
    const XmlElement* target;  // <ref> followed
    std::string_view name;
    bool used = false;
  };
  Child* take(std::string_view name, const ParameterFallback& fallback = {});
  // The text of a value element of one of the given tags.
  const std::string* valueOf(std::string_view name, std::initializer_list<std::string_view> tags,
                             const ParameterFallback& fallback);

  LoadContext& context_;
  const XmlElement& object_;
  std::vector<Child> children_;
  std::vector<std::string> known_;  // names asked for, for the message of finish()
};

}  // namespace wavecrest
