#include "engine/load/xml_document.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <pugixml.hpp>

#include "engine/load/input_file.h"
#include "engine/load/upgrade.h"
#include "engine/load/variables.h"

namespace wavecrest {

namespace {

constexpr XmlLimits kXmlLimits{};
// Further bounds on untrusted XML.
constexpr int kDeepestInclude = 15;
constexpr size_t kMostAttributes = 16;

// Tags of plugins. A <spectrum> is a plugin only if it has a type; XmlElement::isObject checks that.
constexpr std::array<std::string_view, 14> kObjectTags = {"scene",  "bsdf",    "emitter", "film",    "integrator",
                                                          "medium", "phase",   "rfilter", "sensor",  "sampler",
                                                          "shape",  "texture", "volume",  "spectrum"};

// Byte offset -> line number of one file. pugixml converts files of other encodings to UTF-8, and its offsets count
// bytes of that.
class LineIndex {
 public:
  LineIndex(const std::vector<char>& text, pugi::xml_encoding encoding) {
    const bool isUtf16 = encoding == pugi::encoding_utf16_le || encoding == pugi::encoding_utf16_be;
    const bool isUtf32 = encoding == pugi::encoding_utf32_le || encoding == pugi::encoding_utf32_be;
    const bool isBigEndian = encoding == pugi::encoding_utf16_be || encoding == pugi::encoding_utf32_be;
    const bool isConverted = isUtf16 || isUtf32 || encoding == pugi::encoding_latin1;
    const size_t unitBytes = isUtf32 ? 4 : isUtf16 ? 2 : 1;
    size_t offset = 0;
    for (size_t i = 0; i + unitBytes <= text.size(); i += unitBytes) {
      uint32_t unit = 0;
      for (size_t k = 0; k < unitBytes; ++k) {
        const uint32_t byte = static_cast<unsigned char>(text[i + (isBigEndian ? k : unitBytes - 1 - k)]);
        unit = unit << 8 | byte;
      }
      if (unit == '\n') newlines_.push_back(offset);
      offset += isConverted ? bytesInUtf8(unit) : 1;
    }
  }
  // The 1-based line; 0 for a negative offset, by which pugixml says that it knows none.
  int lineOf(ptrdiff_t offset) const {
    if (offset < 0) return 0;
    const auto before = std::lower_bound(newlines_.begin(), newlines_.end(), static_cast<size_t>(offset));
    return static_cast<int>(before - newlines_.begin()) + 1;
  }

 private:
  // Bytes of a code point in UTF-8. A surrogate of UTF-16 is half of a code point of four.
  static size_t bytesInUtf8(uint32_t unit) {
    if (unit < 0x80) return 1;
    const bool isSurrogate = unit >= 0xd800 && unit < 0xe000;
    if (unit < 0x800 || isSurrogate) return 2;
    return unit < 0x10000 ? 3 : 4;
  }

  std::vector<size_t> newlines_;
};

// Converts files to elements. Holds what all files of a scene share: variables, open includes and counts for limits.
class XmlReader {
 public:
  XmlReader(const LoadOptions& options, XmlDocument& document) : variables_(options.defines), document_(document) {}

  XmlElement readFile(const std::filesystem::path& path, const SourceLocation& namedAt);
  const Variables& variables() const { return variables_; }

 private:
  // The file that elements are being read from.
  struct OpenFile {
    std::filesystem::path path;
    const std::string* name;
    const LineIndex* lines;
    bool legacy;  // a file of version < 2: names are upgraded
  };
  XmlElement readElement(const OpenFile& file, const pugi::xml_node& node, int depth);
  void readChildren(const OpenFile& file, const pugi::xml_node& node, int depth, XmlElement& parent);
  void readPath(const OpenFile& file, const XmlElement& path);
  void readInclude(const OpenFile& file, const XmlElement& include, XmlElement& parent);
  std::filesystem::path findPath(const std::filesystem::path& from, std::string_view name) const;

  Variables variables_;
  XmlDocument& document_;
  std::vector<std::filesystem::path> openFiles_;  // include chain
  size_t elementCount_ = 0, byteCount_ = 0;
};

// The first two parts of a version.
struct Version {
  double major, minor;
};

// "3.1.0" -> 3, 1; nothing if it is no version number.
std::optional<Version> versionOf(const std::string& text) {
  if (text.empty() || !std::isdigit(static_cast<unsigned char>(text[0])) ||
      text.find_first_not_of("0123456789.") != std::string::npos || text.size() > 20) {
    return std::nullopt;
  }
  const auto part = [&](size_t at) { return std::floor(std::strtod(text.c_str() + at, nullptr)); };
  const size_t point = text.find('.');
  return Version{.major = part(0), .minor = point == std::string::npos ? 0 : part(point + 1)};
}

// The root element of a file with everything below it. `namedAt` is blamed if the file cannot be read.
XmlElement XmlReader::readFile(const std::filesystem::path& path, const SourceLocation& namedAt) {
  // Read the file. Only the scene file itself can be standard input; an included "-" is a file of that name.
  const bool fromStandardInput = openFiles_.empty() && path == kStandardInput;
  const std::vector<char> text =
      fromStandardInput ? readStandardInput(kXmlLimits.bytes) : readInputFile(path, namedAt, kXmlLimits.bytes);
  byteCount_ += text.size();
  if (byteCount_ > kXmlLimits.bytes) {
    throw LoadError(namedAt, "scene and its includes exceed 32 MiB of XML; expected a smaller description");
  }
  document_.files.push_back(path.string());
  // Parse the XML.
  pugi::xml_document xml;
  const pugi::xml_parse_result parsed = xml.load_buffer(text.data(), text.size());
  const LineIndex lines(text, parsed.encoding);
  OpenFile file{.path = path, .name = &document_.files.back(), .lines = &lines, .legacy = false};
  if (!parsed) {
    throw LoadError({*file.name, std::max(1, lines.lineOf(parsed.offset))},
                    std::string("malformed XML: ") + parsed.description() + "; expected a Mitsuba scene file");
  }
  // Check the version, which decides whether names are upgraded.
  const pugi::xml_node root = xml.document_element();
  const SourceLocation rootAt{*file.name, lines.lineOf(root.offset_debug())};
  const pugi::xml_attribute version = root.attribute("version");
  if (!version) {
    throw LoadError(rootAt,
                    std::string("<") + root.name() + "> has no version; expected for example version=\"3.0.0\"");
  }
  // Sensors of files before 0.4 are mirrored, and their fields of view are others.
  const std::optional<Version> known = versionOf(version.value());
  if (!known || known->major > 3 || (known->major == 0 && known->minor < 4)) {
    throw LoadError(rootAt, std::string("version \"") + version.value() + "\" is not supported; expected 0.4.0 to 3.x");
  }
  file.legacy = known->major < 2;
  // Convert the tree. openFiles_ holds the chain of includes, which readInclude searches for cycles.
  openFiles_.push_back(path);
  XmlElement element = readElement(file, root, 1);
  openFiles_.pop_back();
  return element;
}

// An element with its children. Variables are replaced and names of old versions are upgraded.
XmlElement XmlReader::readElement(const OpenFile& file, const pugi::xml_node& node, int depth) {
  XmlElement element;
  element.file = file.name;
  element.line = file.lines->lineOf(node.offset_debug());
  element.tag = node.name();
  // Stop hostile input.
  if (depth > kXmlLimits.nesting) {
    throw LoadError(element.location(),
                    "elements nest deeper than " + std::to_string(kXmlLimits.nesting) + "; expected a flatter scene");
  }
  if (++elementCount_ > kXmlLimits.elements) {
    throw LoadError(element.location(), "more than " + std::to_string(kXmlLimits.elements) +
                                            " elements; expected meshes to be in mesh files");
  }
  // Copy the attributes, each of which may be given once.
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    if (element.attributes.size() >= kMostAttributes) {
      throw LoadError(element.location(), "<" + element.tag + "> has more than " + std::to_string(kMostAttributes) +
                                              " attributes; expected fewer");
    }
    if (element.find(attribute.name())) {
      throw LoadError(element.location(), std::string("attribute \"") + attribute.name() + "\" of <" + element.tag +
                                              "> is given twice; expected it once");
    }
    element.attributes.emplace_back(attribute.name(), variables_.substitute(attribute.value(), element.location()));
  }
  // Upgrade the element itself, then read the children, then upgrade what spans several children.
  element.legacy = file.legacy;
  if (file.legacy) upgradeElement(element);
  readChildren(file, node, depth, element);
  if (file.legacy) upgradeChildren(element);
  return element;
}

// Appends the children of `node` to `parent`. <default>, <path> and <include> act at once and leave no element.
// A variable is defined for the elements after its <default>.
void XmlReader::readChildren(const OpenFile& file, const pugi::xml_node& node, int depth, XmlElement& parent) {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;  // comments and stray text, as in Mitsuba
    XmlElement element = readElement(file, child, depth + 1);
    if (element.tag == "default") {
      const std::string *name = element.find("name"), *value = element.find("value");
      if (!name || !value) {
        throw LoadError(element.location(), "<default> is incomplete; expected the attributes name and value");
      }
      variables_.setDefault(*name, *value, element.location());
    } else if (element.tag == "path") {
      readPath(file, element);
    } else if (element.tag == "include") {
      readInclude(file, element, parent);
    } else {
      parent.children.push_back(std::move(element));
    }
  }
}

// An included file or a folder of <path>, as Mitsuba finds it: beside the file that names it, in a <path>, the last one
// first, or beside the scene. The first that exists; if none does, the one beside the file that names it.
std::filesystem::path XmlReader::findPath(const std::filesystem::path& from, std::string_view name) const {
  std::vector<std::filesystem::path> folders = {from.parent_path()};
  folders.insert(folders.end(), document_.searchPaths.rbegin(), document_.searchPaths.rend());
  folders.push_back(openFiles_.front().parent_path());
  for (const std::filesystem::path& folder : folders) {
    std::error_code error;
    if (std::filesystem::exists(folder / name, error)) return (folder / name).lexically_normal();
  }
  return (from.parent_path() / name).lexically_normal();
}

// Adds a folder in which files are looked for.
void XmlReader::readPath(const OpenFile& file, const XmlElement& path) {
  const std::string_view value = path.get("value");
  if (value.empty()) throw LoadError(path.location(), "<path> has no value; expected a folder");
  const std::filesystem::path folder = findPath(file.path, value);
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw LoadError(path.location(), "folder \"" + folder.string() + "\" not found; expected an existing folder");
  }
  document_.searchPaths.push_back(folder);
}

// The children of an included <scene> take the place of the <include>; any other root element does so itself.
void XmlReader::readInclude(const OpenFile& file, const XmlElement& include, XmlElement& parent) {
  const std::string_view filename = include.get("filename");
  if (filename.empty()) {
    throw LoadError(include.location(), "<include> has no filename; expected the path of an XML file");
  }
  if (openFiles_.size() >= static_cast<size_t>(kDeepestInclude)) {
    throw LoadError(include.location(), "includes nest deeper than " + std::to_string(kDeepestInclude) +
                                            "; expected a flatter set of files");
  }
  // Refuse a file that is open already: it would include itself without end.
  const std::filesystem::path path = findPath(file.path, filename);
  for (const std::filesystem::path& open : openFiles_) {
    std::error_code error;
    if (open == path || std::filesystem::equivalent(open, path, error)) {
      throw LoadError(include.location(),
                      "\"" + path.string() + "\" includes itself; expected includes without a cycle");
    }
  }
  // Read the file and put its content in place of the <include>.
  XmlElement root = readFile(path, include.location());
  if (root.tag == "scene") {
    for (XmlElement& child : root.children) parent.children.push_back(std::move(child));
  } else {
    if (const std::string* name = include.find("name")) root.attributes.emplace_back("name", *name);
    std::erase_if(root.attributes, [](const auto& attribute) { return attribute.first == "version"; });
    parent.children.push_back(std::move(root));
  }
}

// Enters the objects that have an id into the table of ids. LoadError if two objects have the same id.
void collectIds(const XmlElement& element, XmlDocument& document) {
  if (element.isObject()) {
    if (const std::string* id = element.find("id"); id && !id->empty()) {
      const auto [entry, inserted] = document.ids.try_emplace(*id, &element);
      if (!inserted) {
        const SourceLocation first = entry->second->location();
        throw LoadError(element.location(), "id \"" + *id + "\" is already used at " + first.file + ":" +
                                                std::to_string(first.line) + "; expected unique ids");
      }
    }
  }
  for (const XmlElement& child : element.children) collectIds(child, document);
}

// <alias id="old" as="new"/> gives an object a second id.
void collectAliases(const XmlElement& element, XmlDocument& document) {
  if (element.tag == "alias") {
    const std::string *id = element.find("id"), *as = element.find("as");
    if (!id || !as) throw LoadError(element.location(), "<alias> is incomplete; expected the attributes id and as");
    const auto target = document.ids.find(*id);
    if (target == document.ids.end()) {
      throw LoadError(element.location(), "no object has the id \"" + *id + "\"; expected the id of an object above");
    }
    if (!document.ids.try_emplace(*as, target->second).second) {
      throw LoadError(element.location(), "id \"" + *as + "\" is already used; expected a new id in \"as\"");
    }
  }
  for (const XmlElement& child : element.children) collectAliases(child, document);
}

}  // namespace

const std::string* XmlElement::find(std::string_view attribute) const {
  for (const auto& [name, value] : attributes) {
    if (name == attribute) return &value;
  }
  return nullptr;
}

std::string_view XmlElement::get(std::string_view attribute) const {
  const std::string* value = find(attribute);
  return value ? std::string_view(*value) : std::string_view();
}

bool XmlElement::isObject() const {
  if (tag == "spectrum") return find("type") != nullptr;
  return std::find(kObjectTags.begin(), kObjectTags.end(), tag) != kObjectTags.end();
}

std::unique_ptr<XmlDocument> readXmlDocument(const std::filesystem::path& path, const LoadOptions& options) {
  auto document = std::make_unique<XmlDocument>();
  XmlReader reader(options, *document);
  document->scene = reader.readFile(path, {path.string(), 0});
  if (document->scene.tag != "scene") {
    throw LoadError(document->scene.location(), "root element is <" + document->scene.tag + ">; expected <scene>");
  }
  // A definition that the scene does not use is probably misspelt. The caller may know better, and takes its name then.
  const std::vector<std::string> unused = reader.variables().unusedDefines();
  if (options.unusedDefine) {
    for (const std::string& name : unused) options.unusedDefine(name);
  } else if (!unused.empty()) {
    std::string list;
    for (const std::string& name : unused) list += (list.empty() ? "-D " : ", -D ") + name;
    const std::string message = "the scene does not use " + list + "; expected names of its variables";
    if (!options.lenient) throw LoadError({path.string(), 0}, message);
    document->warnings.push_back(message);
  }
  // The tree is complete, so its elements have their final addresses: fill the table of ids.
  collectIds(document->scene, *document);
  collectAliases(document->scene, *document);
  return document;
}

}  // namespace wavecrest
