#include "scenes/generate/ply_writer.h"

#include <bit>
#include <cstring>
#include <fstream>

#include "scenes/generate/atomic_file.h"

namespace wavecrest::generate {
namespace {

static_assert(std::endian::native == std::endian::little, "the PLY bytes below are written as they are in memory");

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string header(const Mesh& mesh, const std::string& comment) {
  return "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
         std::to_string(mesh.positions.size()) +
         "\nproperty float x\nproperty float y\nproperty float z"
         "\nproperty float nx\nproperty float ny\nproperty float nz\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

void writePly(const Mesh& mesh, const std::string& comment, const std::filesystem::path& file) {
  std::string bytes = header(mesh, comment);
  bytes.reserve(bytes.size() + mesh.positions.size() * 24 + mesh.triangles.size() * 13);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    for (double x : mesh.positions[i]) append(bytes, static_cast<float>(x));
    for (double n : mesh.normals[i]) append(bytes, static_cast<float>(n));
  }
  for (const auto& triangle : mesh.triangles) {
    append(bytes, uint8_t{3});
    for (uint32_t index : triangle) append(bytes, static_cast<int32_t>(index));
  }
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
  });
}

}  // namespace wavecrest::generate
