#include "engine/load/parameters.h"

#include <algorithm>
#include <array>
#include <set>

#include "engine/load/ior_table.h"
#include "engine/load/transform.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// Tags of values. A <spectrum> with a type is an object instead.
constexpr std::array<std::string_view, 12> kValueTags = {"boolean", "integer", "float",    "string",
                                                         "point",   "vector",  "spectrum", "blackbody",
                                                         "rgb",     "srgb",    "color",    "transform"};

// A tag as files write it, for messages.
std::string article(std::string_view tag) { return "<" + std::string(tag) + ">"; }

// What an element of Mitsuba 0.6 asks for that wavecrest lacks altogether, for messages; empty of others.
std::string_view lackingSupport(std::string_view tag) {
  if (tag == "subsurface") return "subsurface scattering is not supported; expected surfaces only";
  if (tag == "animation") return "motion is not supported; expected a <transform>";
  return {};
}

// A value has a name, and only a <transform> has children.
void checkValueElement(const XmlElement& element) {
  if (element.get("name").empty()) {
    throw LoadError(element.location(), article(element.tag) + " has no name; expected the name of a parameter");
  }
  if (element.tag != "transform" && !element.children.empty()) {
    throw LoadError(element.children.front().location(),
                    article(element.children.front().tag) + " inside " + article(element.tag) + "; expected no child");
  }
}

}  // namespace

Parameters::Parameters(LoadContext& context, const XmlElement& object) : context_(context), object_(object) {
  checkAttributes(object, {"type", "id", "name", "version"});
  std::set<std::string_view> names;
  // Children are values, objects and <ref>s. An <alias> stands in the table of ids already. All else is unknown.
  for (const XmlElement& child : object.children) {
    const bool isValue =
        !child.isObject() && std::find(kValueTags.begin(), kValueTags.end(), child.tag) != kValueTags.end();
    if (isValue) {
      checkValueElement(child);
    } else if (child.tag == "alias") {
      continue;
    } else if (const std::string_view lacking = lackingSupport(child.tag); !lacking.empty()) {
      context.unsupported(child.location(), article(child.tag) + " in " + describe() + ": " + std::string(lacking));
      continue;
    } else if (child.tag != "ref" && !child.isObject()) {
      context.unsupported(child.location(), "unknown element " + article(child.tag) + " in " + describe() +
                                                "; expected a parameter or an object of Mitsuba's scene format");
      continue;
    }
    if (child.tag == "ref") checkAttributes(child, {"id", "name"});
    // No two children have the same name, but any number of objects may have none.
    const std::string_view name = child.get("name");
    if (!name.empty() && !names.insert(name).second) {
      throw LoadError(child.location(),
                      "parameter " + inQuotes(name) + " of " + describe() + " is given twice; expected it once");
    }
    // References are followed here, so that an unknown id is an error whether or not a reader asks for the child.
    children_.push_back({.site = &child, .target = &context.resolve(child), .name = name});
  }
}

// Marks the child of that name as used and returns it; null if there is none. finish() lists the name as a known one.
Parameters::Child* Parameters::take(std::string_view name, const ParameterFallback& fallback) {
  if (context_.options.asked) context_.options.asked({object_.tag, object_.get("type"), name, fallback});
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
  for (Child& child : children_) {
    if (child.name != name) continue;
    child.used = true;
    return &child;
  }
  return nullptr;
}

// This marks the parameter as used, so a reader that asks must also read it or refuse it.
bool Parameters::has(std::string_view name) { return take(name) != nullptr; }

const XmlElement* Parameters::element(std::string_view name) {
  const Child* child = take(name);
  return child ? child->target : nullptr;
}

// Null if the parameter is absent. LoadError if its tag is not one of `tags`.
const std::string* Parameters::valueOf(std::string_view name, std::initializer_list<std::string_view> tags,
                                       const ParameterFallback& fallback) {
  const Child* child = take(name, fallback);
  if (!child) return nullptr;
  // Values have no ids, so a <ref> in place of one is refused by its tag.
  const XmlElement& element = *child->site;
  if (std::find(tags.begin(), tags.end(), element.tag) == tags.end()) {
    std::string expected;
    for (const std::string_view tag : tags) expected += (expected.empty() ? "" : " or ") + article(tag);
    throw LoadError(element.location(),
                    "parameter " + inQuotes(name) + " is a " + article(element.tag) + "; expected " + expected);
  }
  checkAttributes(element, {"name", "value"});
  const std::string* value = element.find("value");
  if (!value) throw LoadError(element.location(), article(element.tag) + " has no value; expected the attribute value");
  return value;
}

// A whole number may be written as an <integer>.
double Parameters::real(std::string_view name, double fallback) {
  const std::string* value = valueOf(name, {"float", "integer"}, fallback);
  return value ? parseReal(*value, locationOf(name)) : fallback;
}

double Parameters::requiredReal(std::string_view name) {
  if (!has(name)) {
    throw LoadError(location(), describe() + " has no " + inQuotes(name) + "; expected a <float> of that name");
  }
  return real(name, 0);
}

double Parameters::positiveReal(std::string_view name, double fallback) {
  const double value = real(name, fallback);
  if (!(value > 0)) throw LoadError(locationOf(name), inQuotes(name) + " is not positive; expected a number above 0");
  return value;
}

// The range from `lowest` to `highest` includes both ends.
int64_t Parameters::integer(std::string_view name, int64_t fallback, int64_t lowest, int64_t highest) {
  const std::string* text = valueOf(name, {"integer"}, fallback);
  if (!text) return fallback;
  const int64_t value = parseInteger(*text, locationOf(name));
  if (value < lowest || value > highest) {
    throw LoadError(locationOf(name), inQuotes(name) + " is " + std::to_string(value) + "; expected " +
                                          std::to_string(lowest) + " to " + std::to_string(highest));
  }
  return value;
}

bool Parameters::boolean(std::string_view name, bool fallback) {
  const std::string* value = valueOf(name, {"boolean"}, fallback);
  return value ? parseBoolean(*value, locationOf(name)) : fallback;
}

std::string Parameters::string(std::string_view name, std::string_view fallback) {
  const std::string* value = valueOf(name, {"string"}, fallback);
  return value ? *value : std::string(fallback);
}

// An empty string counts as absent.
std::string Parameters::requiredString(std::string_view name) {
  std::string value = string(name, "");
  if (value.empty()) {
    throw LoadError(locationOf(name), describe() + " has no " + inQuotes(name) + "; expected a <string> of that name");
  }
  return value;
}

// <point> and <vector> are interchangeable here.
std::optional<Double3> Parameters::vector(std::string_view name) {
  const Child* child = take(name);
  if (!child) return std::nullopt;
  if (child->site->tag != "point" && child->site->tag != "vector") {
    throw LoadError(child->site->location(), "parameter " + inQuotes(name) + " is a " + article(child->site->tag) +
                                                 "; expected <point> or <vector>");
  }
  checkAttributes(*child->site, {"name", "x", "y", "z", "value"});
  return readVectorAttributes(*child->site, 0);
}

// An absent transform is not the identity: some readers allow another parameter in its place.
std::optional<Matrix4> Parameters::transform(std::string_view name) {
  const Child* child = take(name);
  if (!child) return std::nullopt;
  if (child->site->tag != "transform") {
    throw LoadError(child->site->location(),
                    "parameter " + inQuotes(name) + " is a " + article(child->site->tag) + "; expected <transform>");
  }
  return readTransform(context_, *child->site);
}

double Parameters::ior(std::string_view name, std::string_view fallback) {
  const Child* child = take(name);
  // A number. The fallback of 1 is not used, since the child exists.
  if (child && child->site->tag != "string") {
    return positiveReal(name, 1);
  }
  // The name of a substance, or the default substance.
  const std::string substance = string(name, fallback);
  if (const std::optional<double> value = findIor(substance)) return *value;
  throw LoadError(locationOf(name),
                  "unknown substance " + inQuotes(substance) + "; expected a number or one of " + listIorNames());
}

// Nested objects are found by their tag alone, since their names are free.
std::vector<const XmlElement*> Parameters::objects(std::string_view tag) {
  std::vector<const XmlElement*> found;
  for (Child& child : children_) {
    if (!child.target->isObject() || child.target->tag != tag) continue;
    child.used = true;
    found.push_back(child.target);
  }
  return found;
}

const XmlElement& Parameters::onlyObject(std::string_view tag) {
  const std::vector<const XmlElement*> found = objects(tag);
  if (found.size() != 1) {
    throw LoadError(location(), describe() + " contains " + std::to_string(found.size()) + " objects " + article(tag) +
                                    "; expected exactly 1");
  }
  return *found.front();
}

void Parameters::ignore(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) take(name);
}

void Parameters::leaveOut(std::initializer_list<std::string_view> names, const std::string& effect) {
  for (const std::string_view name : names) {
    if (take(name)) context_.note(locationOf(name), inQuotes(name) + " of " + describe(), effect);
  }
}

// Objects without a name are listed by their tag.
std::string Parameters::takeOthers() {
  std::string names;
  for (Child& child : children_) {
    if (child.used) continue;
    child.used = true;
    names += (names.empty() ? "" : ", ") + (child.name.empty() ? article(child.target->tag) : std::string(child.name));
  }
  return names;
}

std::string Parameters::takeOthers(std::span<const std::string_view> names) {
  std::string taken;
  for (Child& child : children_) {
    if (child.used || std::ranges::find(names, child.name) == names.end()) continue;
    child.used = true;
    taken += (taken.empty() ? "" : ", ") + std::string(child.name);
  }
  return taken;
}

// The first child that is left over is an error. With --lenient there is a warning for each.
void Parameters::finish() {
  for (const Child& child : children_) {
    if (child.used) continue;
    // Participating media have a message of their own.
    if (child.target->tag == "medium" || child.target->tag == "phase" || child.target->tag == "volume") {
      context_.unsupported(child.site->location(),
                           article(child.target->tag) + " in " + describe() +
                               ": light transport in media is not supported; expected surfaces only");
      continue;
    }
    // As Mitsuba 0.6 did, in its files.
    if (object_.legacy && !child.target->isObject()) {
      context_.note(child.site->location(), "parameter " + inQuotes(child.name) + " of " + describe(),
                    "left out, since wavecrest does not know it");
      continue;
    }
    // For anything else, the message lists the names that the reader has asked for.
    std::string list;
    for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
    if (list.empty()) list = "no parameters";
    const std::string what =
        child.target->isObject() ? "object " + article(child.target->tag) : "parameter " + inQuotes(child.name);
    context_.unsupported(child.site->location(), "unknown " + what + " of " + describe() + "; expected " + list);
  }
}

SourceLocation Parameters::locationOf(std::string_view name) const {
  for (const Child& child : children_) {
    if (child.name == name) return child.site->location();
  }
  return location();
}

std::string Parameters::describe() const {
  const std::string_view type = object_.get("type");
  return object_.tag + (type.empty() ? "" : " " + inQuotes(type));
}

}  // namespace wavecrest
