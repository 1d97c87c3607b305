// Small mesh files as text and bytes for the tests.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

// Two triangles in the plane z = 0 that share the edge from (1, 0, 0) to (0, 1, 0).
constexpr std::string_view kQuadPly =
    "ply\nformat ascii 1.0\ncomment two triangles\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n";
constexpr int kQuadPlyVertexLine = 11;  // of vertex 0

// Appends the bytes of a value in the given byte order.
template <class T>
void appendValue(std::string& bytes, T value, bool bigEndian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (size_t i = 0; i < sizeof(T); ++i) bytes += raw[bigEndian ? sizeof(T) - 1 - i : i];
}

// The same mesh in binary.
inline std::string binaryQuadPly(bool bigEndian) {
  std::string bytes = "ply\nformat " + std::string(bigEndian ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\nelement vertex 4\nproperty double x\nproperty float y\nproperty float z\nproperty uchar "
                      "tag\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n";
  const float corners[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (const auto& corner : corners) {
    appendValue<double>(bytes, corner[0], bigEndian);
    appendValue<float>(bytes, corner[1], bigEndian);
    appendValue<float>(bytes, 0, bigEndian);
    appendValue<uint8_t>(bytes, 7, bigEndian);
  }
  const uint32_t faces[2][3] = {{0, 1, 2}, {1, 3, 2}};
  for (const auto& face : faces) {
    appendValue<uint8_t>(bytes, 3, bigEndian);
    for (const uint32_t index : face) appendValue<uint32_t>(bytes, index, bigEndian);
  }
  return bytes;
}

inline std::string gzip(std::string_view text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

// The quad above with normals along +z and texture coordinates equal to x and y, as one mesh of a serialized file.
struct SerializedSeed {
  uint16_t version = 4;
  bool isDouble = false, normals = true, colors = false, faceNormals = false;
  float size = 1;  // of the quad's sides
};
inline std::string serializedBody(const SerializedSeed& seed = {}) {
  std::string body;
  const auto number = [&](double value) {
    if (seed.isDouble) return appendValue<double>(body, value, false);
    appendValue<float>(body, static_cast<float>(value), false);
  };
  appendValue<uint32_t>(body,
                        (seed.normals ? 1u : 0u) | 2u | (seed.colors ? 8u : 0u) | (seed.faceNormals ? 0x10u : 0u) |
                            (seed.isDouble ? 0x2000u : 0x1000u),
                        false);
  if (seed.version == 4) body += std::string("quad") + '\0';
  appendValue<uint64_t>(body, 4, false);
  appendValue<uint64_t>(body, 2, false);
  const double corners[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (const auto& corner : corners) {
    for (const double x : {corner[0], corner[1], 0.0}) number(seed.size * x);
  }
  for (int i = 0; seed.normals && i < 4; ++i) {
    for (const double x : {0.0, 0.0, 1.0}) number(x);
  }
  for (const auto& corner : corners) {
    for (const double x : corner) number(x);
  }
  for (int i = 0; seed.colors && i < 12; ++i) number(0.25 * i);
  for (const uint32_t index : {0u, 1u, 2u, 1u, 3u, 2u}) appendValue<uint32_t>(body, index, false);
  return body;
}

// The header and the compressed body of a mesh.
inline std::string serializedMeshOf(const std::string& body, uint16_t version = 4) {
  std::string file;
  appendValue<uint16_t>(file, 0x041c, false);
  appendValue<uint16_t>(file, version, false);
  std::string compressed(compressBound(static_cast<uLong>(body.size())), '\0');
  uLongf size = static_cast<uLongf>(compressed.size());
  compress(reinterpret_cast<Bytef*>(compressed.data()), &size, reinterpret_cast<const Bytef*>(body.data()),
           static_cast<uLong>(body.size()));
  return file + compressed.substr(0, size);
}
inline std::string serializedQuad(const SerializedSeed& seed = {}) {
  return serializedMeshOf(serializedBody(seed), seed.version);
}

// Meshes one after the other with the table at the end; all of the version of the table.
inline std::string serializedFile(const std::vector<std::string>& meshes, uint16_t version = 4) {
  std::string file, table;
  for (const std::string& mesh : meshes) {
    if (version == 4)
      appendValue<uint64_t>(table, file.size(), false);
    else
      appendValue<uint32_t>(table, static_cast<uint32_t>(file.size()), false);
    file += mesh;
  }
  file += table;
  appendValue<uint32_t>(file, static_cast<uint32_t>(meshes.size()), false);
  return file;
}

// `text` with line `number` (from 1) replaced.
inline std::string withLine(std::string_view text, int number, std::string_view line) {
  size_t begin = 0;
  for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
  return std::string(text.substr(0, begin)) + std::string(line) + std::string(text.substr(text.find('\n', begin)));
}

}  // namespace wavecrest
