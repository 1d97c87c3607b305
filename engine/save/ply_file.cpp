#include "engine/save/ply_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "engine/load/matrix.h"
#include "engine/load/mesh_build.h"
#include "engine/save/preimage.h"

namespace wavecrest {

namespace {

// Values are copied as they are in memory.
static_assert(std::endian::native == std::endian::little);

// Whether the file has texture coordinates. An attribute replaces those that were baked from it.
bool hasUvs(const Mesh& mesh, const PlyContent& content) {
  return content.attribute.channels == 0 && !mesh.uvs.empty();
}

std::string header(const Mesh& mesh, const PlyContent& content) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      mesh.positions.size());
  if (content.normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (hasUvs(mesh, content)) text += "property float u\nproperty float v\n";
  // Properties have the attribute's name without vertex_ or face_, and a number for each channel.
  const std::string property = content.attribute.name.substr(content.attribute.name.find('_') + 1);
  for (size_t c = 0; c < content.attribute.channels; ++c) text += fmt::format("property float {}_{}\n", property, c);
  return text +
         fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
}

template <class Value>
void append(std::vector<unsigned char>& bytes, const Value& value) {
  unsigned char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.insert(bytes.end(), raw, raw + sizeof(Value));
}

// The vector from which the loader makes a normal to the bit. A component of -0 would be lost: a transform, even the
// identity, adds products, and -0 plus 0 is 0. The smallest negative number is written instead, in a vector of about
// length 4, where division by the length rounds it to -0.
Float3 normalToWrite(const Float3& normal) {
  static const Matrix4 kInPlace = normalMatrix(identityMatrix());
  const auto isNegativeZero = [](float v) { return v == 0 && std::signbit(v); };
  const float scale = std::any_of(normal.begin(), normal.end(), isNegativeZero) ? 4.0f : 1.0f;
  const auto written = [&](const Float3& candidate) {
    Float3 vector{};
    for (size_t i = 0; i < 3; ++i) {
      vector[i] = isNegativeZero(normal[i]) ? -std::numeric_limits<float>::denorm_min() : scale * candidate[i];
    }
    return vector;
  };
  return written(
      unitPreimage(normal, 1.0f / 2048, [&](const Float3& n) { return placedNormal(kInPlace, written(n)); }));
}

}  // namespace

std::vector<unsigned char> plyBytes(const Mesh& mesh, const PlyContent& content) {
  // The header, and room for all bytes.
  const std::string text = header(mesh, content);
  const size_t channels = content.attribute.channels;
  const bool uvs = hasUvs(mesh, content);
  const size_t vertexFloats = 3 + (content.normals ? 3 : 0) + (uvs ? 2 : 0) + channels;
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() + vertexFloats * 4 * mesh.positions.size() + (1 + 3 * 4) * mesh.triangles.size());
  bytes.insert(bytes.end(), text.begin(), text.end());
  // Vertices, in the order of the header's properties.
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append(bytes, mesh.positions[i]);
    if (content.normals) append(bytes, normalToWrite(mesh.normals[i]));
    if (uvs) append(bytes, mesh.uvs[i]);
    for (size_t c = 0; c < channels; ++c) append(bytes, content.attribute.values[i * channels + c]);
  }
  // Triangles, as lists of three indices.
  for (const std::array<uint32_t, 3>& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle);
  }
  return bytes;
}

}  // namespace wavecrest
