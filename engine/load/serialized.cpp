// Mitsuba's `serialized` meshes, versions 3 and 4: many meshes in one file, each a zlib stream of its own.
//
// Layout (little-endian): per mesh a header of u16 0x041C and u16 version, then compressed: u32 flags, in version 4 a
// name that ends with a zero byte, u64 vertices, u64 triangles, positions, normals, texture coordinates and colours as
// the flags say, u32 indices. The file ends with the meshes' offsets (u32, in version 4 u64) and their u32 count.
// Arrays are inflated straight into the mesh; only doubles pass through a buffer.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/load/input_file.h"
#include "engine/load/mesh_files.h"

namespace wavecrest {

namespace {

// Bits of the flags of a mesh.
enum SerializedFlag : uint32_t {
  kHasNormals = 0x1,
  kHasTexCoords = 0x2,
  kHasColors = 0x8,
  kFaceNormals = 0x10,
  kDoublePrecision = 0x2000
};

// Inflates the zlib stream of a mesh piece by piece, into memory of the caller.
class DeflatedStream {
 public:
  DeflatedStream(std::span<const char> bytes, const SourceLocation& where) : left_(bytes), where_(where) {
    if (inflateInit(&stream_) != Z_OK) fail("cannot start zlib; expected enough memory for its window");
  }
  ~DeflatedStream() { inflateEnd(&stream_); }
  DeflatedStream(const DeflatedStream&) = delete;
  DeflatedStream& operator=(const DeflatedStream&) = delete;

  // Inflates exactly `bytes` bytes. LoadError if the stream is damaged or ends early.
  void read(void* out, size_t bytes) {
    // zlib counts in 32 bits: hand it slices.
    constexpr size_t kSlice = std::numeric_limits<uInt>::max() / 2;
    auto* target = static_cast<Bytef*>(out);
    while (bytes > 0) {
      const uInt given = static_cast<uInt>(std::min(kSlice, left_.size()));
      const uInt room = static_cast<uInt>(std::min(kSlice, bytes));
      stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(left_.data()));
      stream_.avail_in = given;
      stream_.next_out = target;
      stream_.avail_out = room;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      const size_t produced = room - stream_.avail_out;
      left_ = left_.subspan(given - stream_.avail_in);
      target += produced;
      bytes -= produced;
      if (status != Z_OK && !(status == Z_STREAM_END && bytes == 0)) {
        fail(std::string("damaged or truncated mesh data (") + (stream_.msg ? stream_.msg : "stream ends early") +
             "); expected an intact zlib stream");
      }
    }
  }
  template <class T>
  T value() {
    T result;
    read(&result, sizeof result);
    return result;
  }
  [[noreturn]] void fail(const std::string& message) const { throw LoadError(where_, message); }

 private:
  z_stream stream_{};
  std::span<const char> left_;
  const SourceLocation& where_;
};

// The little-endian number at byte `at`. The caller has checked that the file is long enough.
template <class T>
T valueAt(std::span<const char> bytes, size_t at) {
  T result;
  std::memcpy(&result, bytes.data() + at, sizeof result);
  return result;
}

// The version of the mesh at `offset`. LoadError if there is no mesh, or one of another version than 3 and 4.
uint16_t readHeader(std::span<const char> file, uint64_t offset, const SourceLocation& where) {
  constexpr uint16_t kMagic = 0x041c;
  if (offset > file.size() || file.size() - offset < 4 || valueAt<uint16_t>(file, offset) != kMagic) {
    throw LoadError(where, "no mesh at byte " + std::to_string(offset) + "; expected a serialized mesh of Mitsuba");
  }
  const uint16_t version = valueAt<uint16_t>(file, offset + 2);
  if (version != 3 && version != 4) {
    throw LoadError(where, "serialized mesh of version " + std::to_string(version) + "; expected 3 or 4");
  }
  return version;
}

// The first mesh is at the start, so that a file of one mesh needs no table.
uint64_t offsetOfMesh(std::span<const char> file, uint16_t version, uint32_t index, const SourceLocation& where) {
  if (index == 0) return 0;
  const size_t entrySize = version == 4 ? sizeof(uint64_t) : sizeof(uint32_t);
  const uint32_t count = valueAt<uint32_t>(file, file.size() - sizeof(uint32_t));
  if (index >= count || uint64_t{count} * entrySize + sizeof(uint32_t) > file.size()) {
    throw LoadError(where, "no mesh " + std::to_string(index) + " in the file; expected a shape_index below " +
                               std::to_string(count));
  }
  const size_t at = file.size() - sizeof(uint32_t) - (count - index) * entrySize;
  return version == 4 ? valueAt<uint64_t>(file, at) : valueAt<uint32_t>(file, at);
}

// `count` vectors of floats or doubles.
template <size_t N>
void readVectors(DeflatedStream& stream, uint64_t count, bool isDouble, std::vector<std::array<float, N>>& out) {
  out.resize(count);
  if (!isDouble) return stream.read(out.data(), count * sizeof out[0]);
  constexpr size_t kChunk = 4096;
  std::vector<std::array<double, N>> buffer(std::min<size_t>(count, kChunk));
  for (uint64_t first = 0; first < count; first += kChunk) {
    const size_t some = std::min<size_t>(count - first, kChunk);
    stream.read(buffer.data(), some * sizeof buffer[0]);
    for (size_t i = 0; i < some; ++i) {
      for (size_t j = 0; j < N; ++j) out[first + i][j] = static_cast<float>(buffer[i][j]);
    }
  }
}

template <size_t N>
bool allFinite(const std::array<float, N>& v) {
  return std::all_of(v.begin(), v.end(), [](float x) { return std::isfinite(x); });
}

// LoadError for coordinates that are not finite and indices that are out of range.
void checkMesh(TriangleSoup& soup, const DeflatedStream& stream) {
  for (size_t i = 0; i < soup.positions.size(); ++i) {
    if (!allFinite(soup.positions[i])) {
      stream.fail("vertex " + std::to_string(i) + " is not finite; expected finite coordinates");
    }
  }
  // Exporters leave such normals at vertices of degenerate triangles; zero stands for missing.
  for (Float3& normal : soup.normals) {
    if (!allFinite(normal)) normal = {0, 0, 0};
  }
  for (size_t i = 0; i < soup.uvs.size(); ++i) {
    if (!allFinite(soup.uvs[i])) {
      stream.fail("texture coordinates of vertex " + std::to_string(i) + " are not finite; expected finite numbers");
    }
  }
  for (const std::array<uint32_t, 3>& triangle : soup.triangles) {
    const uint32_t highest = std::max({triangle[0], triangle[1], triangle[2]});
    if (highest >= soup.positions.size()) {
      stream.fail("triangle refers to vertex " + std::to_string(highest) + "; expected less than " +
                  std::to_string(soup.positions.size()));
    }
  }
}

}  // namespace

SerializedMesh readSerialized(std::span<const char> file, const std::string& name, uint32_t index) {
  const SourceLocation where{name, 0};
  // Find the mesh. The version of the first mesh gives the size of the entries of the table.
  const uint64_t offset = offsetOfMesh(file, readHeader(file, 0, where), index, where);
  const uint16_t version = readHeader(file, offset, where);
  const std::span<const char> compressed = file.subspan(offset + 4);
  DeflatedStream stream(compressed, where);
  // Read the flags, and skip the name that version 4 has.
  const auto flags = stream.value<uint32_t>();
  if (version == 4) {
    constexpr int kLongestName = 1 << 16;
    int length = 0;
    while (stream.value<char>() != 0) {
      if (++length > kLongestName) stream.fail("name of a mesh has no end; expected at most 65536 characters");
    }
  }
  // Refuse counts that no mesh has in a stream of this size, before memory is allocated for them.
  const auto vertices = stream.value<uint64_t>(), triangles = stream.value<uint64_t>();
  const uint64_t most = kHighestRatio * compressed.size() + (size_t{1} << 20);
  if (vertices > most / sizeof(Float3) || triangles > most / sizeof(Float3) - vertices) {
    stream.fail("mesh announces " + std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
                " triangles in " + std::to_string(compressed.size()) + " bytes; expected fewer");
  }
  // Read the arrays. Colours are not used, but they must be inflated to get to the indices behind them.
  const bool isDouble = (flags & kDoublePrecision) != 0;
  SerializedMesh mesh{.soup = {}, .faceNormals = (flags & kFaceNormals) != 0};
  TriangleSoup& soup = mesh.soup;
  readVectors(stream, vertices, isDouble, soup.positions);
  if (flags & kHasNormals) readVectors(stream, vertices, isDouble, soup.normals);
  if (flags & kHasTexCoords) readVectors(stream, vertices, isDouble, soup.uvs);
  if (flags & kHasColors) {
    std::vector<Float3> colors;
    readVectors(stream, vertices, isDouble, colors);
  }
  soup.triangles.resize(triangles);
  stream.read(soup.triangles.data(), triangles * sizeof soup.triangles[0]);
  checkMesh(soup, stream);
  return mesh;
}

}  // namespace wavecrest
