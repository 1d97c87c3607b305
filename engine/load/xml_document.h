// The XML of a scene as a plain tree: includes spliced in, $variables replaced, old names upgraded.
//
// In: the XML file and the -D definitions. Out: elements with their file and line, and the table of ids.
// Everything that reads meaning into the tree (values.h and the readers) works on it and never sees pugixml.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/load/load.h"

namespace wavecrest {

// Bounds on what untrusted XML may ask for, over all files of a scene. Real scenes nest about 8 deep.
struct XmlLimits {
  int nesting = 64;
  size_t elements = 1'000'000, bytes = 32 << 20;
};

struct XmlElement {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;
  const std::string* file = nullptr;  // owned by XmlDocument::files
  int line = 0;
  bool legacy = false;  // from a file of version 0.4 to 0.6

  const std::string* find(std::string_view attribute) const;
  // The attribute's value, empty if absent.
  std::string_view get(std::string_view attribute) const;
  bool isObject() const;  // a plugin (<shape type=…>) as opposed to a value (<float …>)
  SourceLocation location() const { return {*file, line}; }
};

struct XmlDocument {
  std::deque<std::string> files;  // stable addresses
  XmlElement scene;
  std::map<std::string, const XmlElement*, std::less<>> ids;  // objects and aliases
  std::vector<std::filesystem::path> searchPaths;             // of <path value="…"/>
  std::vector<std::string> warnings;
};

// The result is heap-allocated because ids points into it.
std::unique_ptr<XmlDocument> readXmlDocument(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace wavecrest
