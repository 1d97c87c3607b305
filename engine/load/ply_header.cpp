#include "engine/load/ply_header.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/load/values.h"

namespace wavecrest {

namespace {

// PLY files name a type after C (uchar) or by its size (uint8). Nothing if the name is unknown.
std::optional<PlyType> findType(std::string_view name) {
  struct Entry {
    std::string_view name;
    PlyType type;
  };
  static constexpr Entry kTypes[] = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  for (const Entry& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

PlyType parseType(std::string_view name, const SourceLocation& where) {
  if (const std::optional<PlyType> type = findType(name)) return *type;
  throw LoadError(where, "unknown PLY type " + inQuotes(name) + "; expected for example float, double, uchar or int");
}

// From the words of a line "format ENCODING 1.0".
PlyFormat parseFormat(const std::vector<std::string_view>& words, const SourceLocation& where) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyFormat::ascii;
    if (words[1] == "binary_little_endian") return PlyFormat::binaryLittleEndian;
    if (words[1] == "binary_big_endian") return PlyFormat::binaryBigEndian;
  }
  throw LoadError(where, "unknown PLY format; expected ascii, binary_little_endian or binary_big_endian, version 1.0");
}

// From the words of a line "element NAME COUNT". Its properties follow on lines of their own.
PlyElement parseElement(const std::vector<std::string_view>& words, const SourceLocation& where) {
  if (words.size() != 3) throw LoadError(where, "bad PLY element line; expected \"element NAME COUNT\"");
  const int64_t count = parseInteger(words[2], where);
  if (count < 0 || count >= std::numeric_limits<uint32_t>::max()) {
    throw LoadError(where, "PLY element count " + inQuotes(words[2]) + " is out of range; expected 0 to 2^32 - 2");
  }
  return {.name = std::string(words[1]), .count = static_cast<uint64_t>(count), .properties = {}, .line = where.line};
}

// From the words of a line "property TYPE NAME" or "property list COUNT_TYPE ITEM_TYPE NAME".
PlyProperty parseProperty(const std::vector<std::string_view>& words, const SourceLocation& where) {
  if (words.size() == 3) return {.name = std::string(words[2]), .type = parseType(words[1], where)};
  if (words.size() != 5 || words[1] != "list") {
    throw LoadError(where,
                    "bad PLY property line; expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
  }
  const PlyType countType = parseType(words[2], where);
  if (countType == PlyType::float32 || countType == PlyType::float64) {
    throw LoadError(where, "PLY list is counted by a " + std::string(words[2]) + "; expected an integer type");
  }
  return {.name = std::string(words[4]), .type = parseType(words[3], where), .isList = true, .countType = countType};
}

// The fewest bytes a row can take: in ASCII a digit and a separator per property, in binary the scalars and the counts.
uint64_t smallestRow(const PlyElement& element, PlyFormat format) {
  uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += format == PlyFormat::ascii ? 2 : byteSize(property.isList ? property.countType : property.type);
  }
  return bytes;
}

// Throws unless the file has one element of vertices and one of faces.
void checkElements(const PlyHeader& header, std::string_view file) {
  const auto countOf = [&](std::string_view name) {
    return std::ranges::count(header.elements, name, &PlyElement::name);
  };
  const auto vertices = countOf("vertex"), faces = countOf("face");
  if (vertices == 1 && faces == 1) return;
  throw LoadError({std::string(file), 1}, "PLY file has " + std::to_string(vertices) + " elements \"vertex\" and " +
                                              std::to_string(faces) + " \"face\"; expected one of each");
}

// Throws if the file is too short for the announced rows, before a reader reserves memory for them.
void checkCounts(const PlyHeader& header, size_t fileSize, std::string_view file) {
  // Counts below 2^32 and at most 10,000 properties of at most 8 bytes cannot overflow 64 bits.
  uint64_t needed = header.bodyOffset;
  for (const PlyElement& element : header.elements) {
    needed += smallestRow(element, header.format) * element.count;
    // The last separator of an ASCII file may be missing.
    if (needed <= fileSize + 1) continue;
    throw LoadError({std::string(file), element.line},
                    "file of " + std::to_string(fileSize) + " bytes is too short for " + std::to_string(element.count) +
                        " rows of element " + inQuotes(element.name) + "; expected at least " + std::to_string(needed));
  }
}

}  // namespace

size_t byteSize(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

PlyHeader readPlyHeader(std::string_view text, std::string_view file) {
  // Bounds the work on a file whose header does not end.
  constexpr int kLongestHeader = 10'000;  // lines
  PlyHeader header;
  bool hasFormat = false;
  SourceLocation where{std::string(file), 0};
  for (size_t begin = 0;;) {
    ++where.line;
    if (begin >= text.size() || where.line > kLongestHeader) {
      throw LoadError(where, "PLY header does not end; expected the line \"end_header\"");
    }
    // Take the next line; where.line is its number.
    const size_t end = text.find('\n', begin);
    const std::vector<std::string_view> words = splitTokens(text.substr(begin, end - begin), " \t\r");
    begin = end + 1;
    // The first line is the magic word.
    if (where.line == 1) {
      if (words.size() != 1 || words[0] != "ply") throw LoadError(where, "not a PLY file; expected \"ply\" as line 1");
      continue;
    }
    // The others declare the content. A property belongs to the last element above it.
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      header.format = parseFormat(words, where);
      hasFormat = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parseElement(words, where));
    } else if (words[0] == "property") {
      if (header.elements.empty()) throw LoadError(where, "PLY property without an element; expected an element first");
      header.elements.back().properties.push_back(parseProperty(words, where));
    } else if (words[0] == "end_header") {
      header.bodyOffset = begin;
      header.bodyLine = where.line + 1;
      break;
    } else {
      throw LoadError(where, "unknown PLY header line " + inQuotes(words[0]) +
                                 "; expected format, comment, element, property or end_header");
    }
  }
  // Check the header as a whole.
  if (!hasFormat) throw LoadError(where, "PLY header has no format; expected a line \"format … 1.0\"");
  checkElements(header, file);
  checkCounts(header, text.size() - 1, file);  // without the added newline
  return header;
}

}  // namespace wavecrest
