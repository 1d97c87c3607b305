// The body of a PLY file: vertices and faces, read by one routine over two kinds of source, text and binary.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "engine/load/input_file.h"
#include "engine/load/mesh_files.h"
#include "engine/load/ply_header.h"
#include "engine/load/ply_source.h"
#include "engine/load/polygon.h"
#include "engine/load/text_scanner.h"
#include "engine/load/triple_hash.h"
#include "engine/tasks/parallel_for.h"
#include "kernels/columns/parallel_ranges.h"

namespace wavecrest {

namespace {

// The number of items of a list property.
template <class Source>
uint64_t readCount(Source& source, const PlyProperty& property) {
  const int64_t count = source.integer(property.countType);
  if (count < 0) source.fail("list has a negative length; expected 0 or more");
  if (!source.canHold(property.type, static_cast<uint64_t>(count))) {
    source.fail("list has " + std::to_string(count) + " items but the file ends; expected the announced elements");
  }
  return static_cast<uint64_t>(count);
}

// A row holds the properties of one vertex. Slots 0 to 2 are the position, 3 to 5 the normal, 6 and 7 the texture
// coordinates, and 9 to 11 the attribute. All properties that are not needed have slot 8, which is not read.
constexpr int kNormalSlot = 3, kUvSlot = 6, kNoSlot = 8, kAttributeSlot = 9, kRowSlots = 12;

bool isFinite(const float* values, int count) {
  return std::all_of(values, values + count, [](float v) { return std::isfinite(v); });
}

// The property of that name, or nullptr. Lists do not count.
const PlyProperty* propertyOf(const PlyElement& element, std::string_view name) {
  const auto found = std::ranges::find_if(
      element.properties, [&](const PlyProperty& property) { return !property.isList && property.name == name; });
  return found == element.properties.end() ? nullptr : &*found;
}

// Names of the properties that are u and v.
using UvNames = std::array<std::string_view, 2>;

// The names that PLY files commonly use, of the first pair that is complete. Empty: there is none.
UvNames uvNamesOf(const PlyElement& element) {
  static constexpr UvNames kPairs[] = {{"u", "v"}, {"texture_u", "texture_v"}, {"s", "t"}, {"texture_s", "texture_t"}};
  for (const UvNames& pair : kPairs) {
    if (propertyOf(element, pair[0]) != nullptr && propertyOf(element, pair[1]) != nullptr) return pair;
  }
  return {};
}

// The slot of a property, by its name.
int slotOf(const PlyProperty& property, const UvNames& uvNames) {
  const std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz", uvNames[0], uvNames[1]};
  if (property.isList) return kNoSlot;
  const auto* const found = std::ranges::find(names, property.name);
  return found == std::end(names) ? kNoSlot : static_cast<int>(found - names);
}

// Channel of the attribute that a property is, or -1.
int attributeChannel(const MeshAttribute& attribute, const PlyProperty& property) {
  return property.isList ? -1 : attribute.channelOf(property.name);
}

// Finds the properties that are the attribute. Sets attribute.channels: 3 if all three are present, 1 if only some are
// but the first is among them. Without the first there is no attribute, and it stays 0.
void startAttribute(const PlyElement& element, bool ofFaces, MeshAttribute& attribute) {
  if (attribute.perFace() != ofFaces) return;
  for (const AttributeFields& fields : attribute.possibleFields()) {
    const PlyProperty* const first = propertyOf(element, fields[0]);
    if (first == nullptr) continue;
    attribute.fields = fields;
    attribute.ofWholeNumbers = first->type != PlyType::float32 && first->type != PlyType::float64;
    attribute.channels = propertyOf(element, fields[1]) != nullptr && propertyOf(element, fields[2]) != nullptr ? 3 : 1;
    attribute.values.reserve(element.count * attribute.channels);
    return;
  }
}

// Adds the attribute of one vertex or triangle. `values` holds soup.attribute.channels numbers.
template <class Source>
void appendAttribute(const Source& source, const float* values, TriangleSoup& soup) {
  if (!isFinite(values, static_cast<int>(soup.attribute.channels))) {
    source.fail("attribute " + inQuotes(soup.attribute.name) + " is not finite; expected finite numbers");
  }
  soup.attribute.values.insert(soup.attribute.values.end(), values, values + soup.attribute.channels);
}

// Reads the element "vertex": positions, and what there is of normals, texture coordinates and a vertex attribute.
template <class Source>
void readVertices(Source& source, const PlyElement& element, const SourceLocation& where, TriangleSoup& soup) {
  // Find the slot of each property.
  std::vector<int> slots;
  bool present[kRowSlots] = {};
  startAttribute(element, false, soup.attribute);
  const UvNames uvNames = uvNamesOf(element);
  for (const PlyProperty& property : element.properties) {
    const int channel = attributeChannel(soup.attribute, property);
    slots.push_back(channel < 0 ? slotOf(property, uvNames) : kAttributeSlot + channel);
    present[slots.back()] = true;
  }
  if (!present[0] || !present[1] || !present[2]) {
    throw LoadError({where.file, element.line}, "PLY vertices lack a coordinate; expected the properties x, y and z");
  }
  // Normals and texture coordinates are used only if all their components are present.
  const bool hasNormals = present[3] && present[4] && present[5], hasUvs = present[6] && present[7];
  soup.positions.reserve(element.count);
  if (hasNormals) soup.normals.reserve(element.count);
  if (hasUvs) soup.uvs.reserve(element.count);
  // Read the rows. Properties that are not needed are skipped; all lists are among them.
  float row[kRowSlots] = {};
  for (uint64_t i = 0; i < element.count; ++i) {
    for (size_t j = 0; j < slots.size(); ++j) {
      const PlyProperty& property = element.properties[j];
      if (slots[j] != kNoSlot) {
        row[slots[j]] = source.real(property.type);
      } else {
        source.skip(property.type, property.isList ? readCount(source, property) : 1);
      }
    }
    if (!isFinite(row, 3)) source.fail("vertex " + std::to_string(i) + " is not finite; expected finite coordinates");
    soup.positions.push_back({row[0], row[1], row[2]});
    if (hasNormals) {
      if (!isFinite(row + kNormalSlot, 3)) {
        source.fail("normal of vertex " + std::to_string(i) + " is not finite; expected a finite vector");
      }
      soup.normals.push_back({row[kNormalSlot], row[kNormalSlot + 1], row[kNormalSlot + 2]});
    }
    if (hasUvs) {
      if (!isFinite(row + kUvSlot, 2)) {
        source.fail("texture coordinates of vertex " + std::to_string(i) + " are not finite; expected finite numbers");
      }
      soup.uvs.push_back({row[kUvSlot], row[kUvSlot + 1]});
    }
    if (soup.attribute.channels != 0 && !soup.attribute.perFace()) appendAttribute(source, row + kAttributeSlot, soup);
  }
}

// One face of the file: vertices and texture coordinates of its corners, these with u and v in turn.
struct PlyFace {
  std::vector<uint32_t> vertices;
  std::vector<float> uvs;
  std::vector<Float3> positions;  // of the vertices, if there are more than three
};

// Reads the vertices of a face.
template <class Source>
void readCorners(Source& source, const PlyProperty& property, uint64_t vertexCount, std::vector<uint32_t>& vertices) {
  const uint64_t corners = readCount(source, property);
  if (corners < 3) source.fail("face has " + std::to_string(corners) + " corners; expected at least 3");
  vertices.resize(corners);
  for (uint32_t& vertex : vertices) {
    const int64_t index = source.integer(property.type);
    if (index < 0 || static_cast<uint64_t>(index) >= vertexCount) {
      source.fail("face refers to vertex " + std::to_string(index) + "; expected 0 to " +
                  std::to_string(static_cast<int64_t>(vertexCount) - 1));
    }
    vertex = static_cast<uint32_t>(index);
  }
}

// Reads the texture coordinates of a face's corners. A face without a texture may have none.
template <class Source>
void readCornerUvs(Source& source, const PlyProperty& property, std::vector<float>& uvs) {
  uvs.resize(readCount(source, property));
  for (float& coordinate : uvs) coordinate = source.real(property.type);
  if (!isFinite(uvs.data(), static_cast<int>(uvs.size()))) {
    source.fail("texture coordinates of a face are not finite; expected finite numbers");
  }
}

// Gives the corners of faces vertices with their texture coordinates: the vertex itself to the first corner that is
// there, and copies to those that differ from it.
class CornerVertices {
 public:
  explicit CornerVertices(TriangleSoup& soup) : soup_(soup), taken_(soup.positions.size()) {
    soup.uvs.assign(soup.positions.size(), Float2{});
    soup.vertexOf.resize(soup.positions.size());
    std::iota(soup.vertexOf.begin(), soup.vertexOf.end(), 0);
  }

  uint32_t operator()(uint32_t vertex, const Float2& uv) {
    const std::array<uint32_t, 3> corner{vertex, std::bit_cast<uint32_t>(uv[0]), std::bit_cast<uint32_t>(uv[1])};
    const auto [entry, inserted] = known_.try_emplace(corner, vertex);
    if (!inserted) return entry->second;
    if (!taken_[vertex]) {
      taken_[vertex] = true;
      soup_.uvs[vertex] = uv;
      return vertex;
    }
    // A copy of the vertex with all that it has.
    entry->second = static_cast<uint32_t>(soup_.positions.size());
    soup_.positions.push_back(Float3{soup_.positions[vertex]});
    if (!soup_.normals.empty()) soup_.normals.push_back(Float3{soup_.normals[vertex]});
    soup_.uvs.push_back(uv);
    soup_.vertexOf.push_back(vertex);
    MeshAttribute& attribute = soup_.attribute;
    for (size_t c = 0; !attribute.perFace() && c < attribute.channels; ++c) {
      attribute.values.push_back(float{attribute.values[vertex * attribute.channels + c]});
    }
    return entry->second;
  }

 private:
  TriangleSoup& soup_;
  std::vector<bool> taken_;
  std::unordered_map<std::array<uint32_t, 3>, uint32_t, TripleHash> known_;
};

// Cuts a face into triangles.
template <class Source>
void addFace(const Source& source, PlyFace& face, CornerVertices* cornerVertices, TriangleSoup& soup) {
  std::vector<uint32_t>& vertices = face.vertices;
  if (cornerVertices != nullptr) {
    if (!face.uvs.empty() && face.uvs.size() != 2 * vertices.size()) {
      source.fail("face of " + std::to_string(vertices.size()) + " corners has " + std::to_string(face.uvs.size()) +
                  " texture coordinates; expected u and v for each corner");
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
      vertices[i] =
          (*cornerVertices)(vertices[i], face.uvs.empty() ? Float2{} : Float2{face.uvs[2 * i], face.uvs[2 * i + 1]});
    }
  }
  if (vertices.size() == 3) {
    soup.triangles.push_back({vertices[0], vertices[1], vertices[2]});
    return;
  }
  face.positions.clear();
  for (const uint32_t vertex : vertices) face.positions.push_back(soup.positions[vertex]);
  const auto triangles = cutPolygon(face.positions);
  if (triangles.empty()) source.fail(tooManyCorners(vertices.size()));
  for (const auto& [a, b, c] : triangles) soup.triangles.push_back({vertices[a], vertices[b], vertices[c]});
}

// Faces as most files have them: a count in one byte, three indices of four bytes each, and nothing else. Reads them
// side by side and returns true if all of them are such triangles of existing vertices; else it reads nothing.
bool readTriangles(AsciiSource&, const PlyElement&, uint64_t, TriangleSoup&) { return false; }
bool readTriangles(BinarySource& source, const PlyElement& element, uint64_t vertexCount, TriangleSoup& soup) {
  constexpr size_t kRow = 1 + 3 * sizeof(uint32_t);
  const PlyProperty& property = element.properties.front();
  const bool plain = element.properties.size() == 1 && byteSize(property.countType) == 1 &&
                     (property.type == PlyType::int32 || property.type == PlyType::uint32);
  // The header's reader has checked that the file can hold the announced elements, so the product is small enough.
  const char* const rows = plain ? source.peek(element.count * kRow) : nullptr;
  if (rows == nullptr) return false;
  soup.triangles.resize(element.count);
  std::atomic<bool> complete{true};
  forEachRange(parallelFor, element.count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && complete; ++i) {
      std::memcpy(soup.triangles[i].data(), rows + i * kRow + 1, 3 * sizeof(uint32_t));
      // A negative index is a large one here.
      const uint32_t largest = std::max({soup.triangles[i][0], soup.triangles[i][1], soup.triangles[i][2]});
      if (rows[i * kRow] != 3 || largest >= vertexCount) complete = false;
    }
  });
  if (complete) {
    source.skip(PlyType::uint8, element.count * kRow);
  } else {
    soup.triangles.clear();
  }
  return complete;
}

bool isIndices(const PlyProperty& property) {
  return property.isList && (property.name == "vertex_indices" || property.name == "vertex_index");
}
// Texture coordinates of corners, as MeshLab names them.
bool isCornerUvs(const PlyProperty& property) { return property.isList && property.name == "texcoord"; }

// Reads the element "face". All triangles of a face have its attribute.
template <class Source>
void readFaces(Source& source, const PlyElement& element, uint64_t vertexCount, const SourceLocation& where,
               TriangleSoup& soup) {
  // One list gives the corners of a face.
  if (std::ranges::count_if(element.properties, isIndices) != 1) {
    throw LoadError({where.file, element.line},
                    "PLY faces have no vertices; expected one list property vertex_indices or vertex_index");
  }
  if (vertexCount == 0 && element.count > 0) {
    throw LoadError({where.file, element.line},
                    "PLY file has no vertices before its faces; expected the vertices first");
  }
  soup.triangles.reserve(element.count);
  startAttribute(element, true, soup.attribute);
  const bool hasAttribute = soup.attribute.channels != 0 && soup.attribute.perFace();
  if (!hasAttribute && readTriangles(source, element, vertexCount, soup)) return;
  // Read the rows. What belongs to corners and faces may stand in any order, so a face is added at the end of its row.
  std::optional<CornerVertices> cornerVertices;
  if (std::ranges::any_of(element.properties, isCornerUvs)) cornerVertices.emplace(soup);
  PlyFace face;
  float values[3] = {};
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (const int channel = hasAttribute ? attributeChannel(soup.attribute, property) : -1; channel >= 0) {
        values[channel] = source.real(property.type);
      } else if (isIndices(property)) {
        readCorners(source, property, vertexCount, face.vertices);
      } else if (isCornerUvs(property)) {
        readCornerUvs(source, property, face.uvs);
      } else {
        source.skip(property.type, property.isList ? readCount(source, property) : 1);
      }
    }
    const size_t firstTriangle = soup.triangles.size();
    addFace(source, face, cornerVertices ? &*cornerVertices : nullptr, soup);
    for (size_t t = firstTriangle; hasAttribute && t < soup.triangles.size(); ++t)
      appendAttribute(source, values, soup);
  }
}

// Skips the rows of an element that is not needed.
template <class Source>
void skipElement(Source& source, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      source.skip(property.type, property.isList ? readCount(source, property) : 1);
    }
  }
}

// Reads the elements in the order of the header, which has one "vertex" and one "face".
template <class Source>
TriangleSoup readBody(Source source, const PlyHeader& header, const std::string& file, const std::string& attribute) {
  TriangleSoup soup;
  soup.attribute.name = attribute;
  const SourceLocation where{file, header.bodyLine};
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      readVertices(source, element, where, soup);
    } else if (element.name == "face") {
      readFaces(source, element, soup.positions.size(), where, soup);
    } else {
      skipElement(source, element);
    }
  }
  if (!source.atEnd()) source.fail("PLY file goes on after its last element; expected the end of the file");
  return soup;
}

}  // namespace

TriangleSoup readPly(const std::filesystem::path& path, bool flipTexCoords, const SourceLocation& where,
                     const std::string& attribute) {
  std::vector<char> bytes = readInputFile(path, where);
  const size_t size = bytes.size();
  // Text must end with a newline: TextScanner and readPlyHeader stop there.
  bytes.push_back('\n');
  const std::string file = path.string();
  const std::string_view text(bytes.data(), bytes.size());
  const PlyHeader header = readPlyHeader(text, file);
  TriangleSoup soup;
  if (header.format == PlyFormat::ascii) {
    soup = readBody(AsciiSource(TextScanner(text.substr(header.bodyOffset), file, header.bodyLine)), header, file,
                    attribute);
  } else {
    // A binary body ends where the file does, before the added newline.
    static_assert(std::endian::native == std::endian::little);
    const std::string_view body = text.substr(0, size).substr(std::min(size, header.bodyOffset));
    soup =
        readBody(BinarySource(body, header.format == PlyFormat::binaryBigEndian, SourceLocation{file, header.bodyLine}),
                 header, file, attribute);
  }
  if (flipTexCoords) {
    for (Float2& uv : soup.uvs) uv[1] = 1 - uv[1];
  }
  return soup;
}

}  // namespace wavecrest
