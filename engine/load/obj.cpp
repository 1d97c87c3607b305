// Wavefront OBJ: v, vt, vn and f lines; every other line (groups, materials, smoothing) is skipped as in Mitsuba 3. For
// files of 0.4 to 0.6 each group and each material begins a mesh that shares no vertices with the others.
#include <limits>
#include <unordered_map>

#include "engine/load/input_file.h"
#include "engine/load/mesh_files.h"
#include "engine/load/polygon.h"
#include "engine/load/text_scanner.h"
#include "engine/load/triple_hash.h"

namespace wavecrest {

namespace {

constexpr uint32_t kAbsent = std::numeric_limits<uint32_t>::max();

// A corner names its position, texture coordinates and normal separately; each distinct triple becomes one vertex.
struct Corner {
  uint32_t position = 0, uv = kAbsent, normal = kAbsent;
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  size_t operator()(const Corner& c) const { return TripleHash{}({c.position, c.uv, c.normal}); }
};

// Reads a file line by line. A face can refer only to positions, normals and coordinates above it.
class ObjReader {
 public:
  ObjReader(TextScanner scanner, bool flipTexCoords, bool separateMeshes)
      : scanner_(scanner), flipTexCoords_(flipTexCoords), separateMeshes_(separateMeshes) {}

  TriangleSoup read() {
    // Numbers that follow on a line, such as the colour of a vertex, are skipped with the rest of the line.
    while (!scanner_.atEnd()) {
      scanner_.skipBlanks();
      if (scanner_.takeWord("v")) {
        positions_.push_back(readVector<3>());
      } else if (scanner_.takeWord("vn")) {
        normals_.push_back(readVector<3>());
      } else if (scanner_.takeWord("vt")) {
        Float2 uv = readVector<2>();
        if (flipTexCoords_) uv[1] = 1 - uv[1];
        uvs_.push_back(uv);
      } else if (scanner_.takeWord("f")) {
        readFace();
      } else if (scanner_.takeWord("mtllib")) {
        hasLibrary_ = true;
      } else if (scanner_.takeWord("usemtl")) {
        usesLibrary_ = hasLibrary_;
        beginMesh();
      } else if (scanner_.takeWord("g")) {
        beginMesh();
      }
      scanner_.skipLine();
    }
    return assemble();
  }

 private:
  // Corners that follow get vertices of their own, over which normals are smoothed.
  void beginMesh() {
    // Not clear(), which takes as long as the largest mesh so far.
    if (separateMeshes_ && !vertices_.empty()) vertices_ = {};
  }

  // The next N numbers of the line.
  template <size_t N>
  std::array<float, N> readVector() {
    std::array<float, N> vector{};
    for (float& component : vector) {
      if (scanner_.atLineEnd()) scanner_.fail("line has too few numbers; expected " + std::to_string(N));
      component = scanner_.readFloat("a coordinate");
    }
    return vector;
  }

  // 1-based, or negative and counted back from the latest; 0-based on return.
  uint32_t readIndex(size_t count, const char* what) {
    const int64_t index = scanner_.readInteger("an index");
    const int64_t size = static_cast<int64_t>(count);
    if (index == 0 || index > size || index < -size) {
      scanner_.fail("face refers to " + std::string(what) + " " + std::to_string(index) + "; expected 1 to " +
                    std::to_string(size) + " or -" + std::to_string(size) + " to -1");
    }
    return static_cast<uint32_t>(index > 0 ? index - 1 : index + size);
  }

  // A corner in one of the forms v, v/vt, v//vn and v/vt/vn. An index that is missing after a slash is absent.
  Corner readCorner() {
    Corner corner;
    corner.position = readIndex(positions_.size(), "vertex");
    if (scanner_.peek() != '/') return corner;
    scanner_.advance(1);
    if (scanner_.peek() != '/' && !atCornerEnd()) corner.uv = readIndex(uvs_.size(), "texture coordinate");
    if (scanner_.peek() != '/') return corner;
    scanner_.advance(1);
    if (!atCornerEnd()) corner.normal = readIndex(normals_.size(), "normal");
    return corner;
  }
  // readIndex would skip the white space and take the number of the next corner.
  bool atCornerEnd() const {
    const char c = scanner_.peek();
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
  }

  // Reads a face and cuts it into triangles. As in Mitsuba, faces of fewer than three corners are left out.
  void readFace() {
    face_.clear();
    while (!scanner_.atLineEnd() && scanner_.peek() != '#') {
      face_.push_back(readCorner());
      if (!atCornerEnd()) scanner_.fail("face corner is malformed; expected v, v/vt, v//vn or v/vt/vn");
    }
    if (face_.size() < 3) {
      ++droppedFaces_;
      return;
    }
    faceVertices_.clear();
    for (const Corner& corner : face_) faceVertices_.push_back(vertexOf(corner));
    if (face_.size() == 3) {
      triangles_.push_back({faceVertices_[0], faceVertices_[1], faceVertices_[2]});
      return;
    }
    facePositions_.clear();
    for (const Corner& corner : face_) facePositions_.push_back(positions_[corner.position]);
    const auto triangles = cutPolygon(facePositions_);
    if (triangles.empty()) scanner_.fail(tooManyCorners(face_.size()));
    for (const auto& [a, b, c] : triangles) {
      triangles_.push_back({faceVertices_[a], faceVertices_[b], faceVertices_[c]});
    }
  }

  // The index of the vertex for a corner. Equal corners share one vertex.
  uint32_t vertexOf(const Corner& corner) {
    const auto [entry, inserted] = vertices_.try_emplace(corner, static_cast<uint32_t>(corners_.size()));
    if (inserted) corners_.push_back(corner);
    hasUvs_ = hasUvs_ || corner.uv != kAbsent;
    hasNormals_ = hasNormals_ || corner.normal != kAbsent;
    return entry->second;
  }

  // Makes a vertex of each distinct corner. There are normals and texture coordinates if any corner has them.
  TriangleSoup assemble() {
    TriangleSoup soup;
    soup.droppedFaces = droppedFaces_;
    soup.usesLibrary = usesLibrary_;
    soup.triangles = std::move(triangles_);
    soup.positions.reserve(corners_.size());
    for (const Corner& corner : corners_) {
      soup.positions.push_back(positions_[corner.position]);
      // A corner without a normal among others with one gets the smooth normal: zero stands for missing.
      if (hasNormals_) soup.normals.push_back(corner.normal == kAbsent ? Float3{0, 0, 0} : normals_[corner.normal]);
      if (hasUvs_) soup.uvs.push_back(corner.uv == kAbsent ? Float2{0, 0} : uvs_[corner.uv]);
    }
    return soup;
  }

  TextScanner scanner_;
  bool flipTexCoords_, separateMeshes_, hasUvs_ = false, hasNormals_ = false, hasLibrary_ = false, usesLibrary_ = false;
  uint64_t droppedFaces_ = 0;
  std::vector<Float3> positions_, normals_;
  std::vector<Float2> uvs_;
  std::vector<Corner> corners_;
  std::unordered_map<Corner, uint32_t, CornerHash> vertices_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  // Of the face being read.
  std::vector<Corner> face_;
  std::vector<uint32_t> faceVertices_;
  std::vector<Float3> facePositions_;
};

}  // namespace

TriangleSoup readObj(const std::filesystem::path& path, bool flipTexCoords, bool separateMeshes,
                     const SourceLocation& where) {
  std::vector<char> bytes = readInputFile(path, where);
  // TextScanner stops at newlines only.
  bytes.push_back('\n');
  const std::string file = path.string();
  return ObjReader(TextScanner({bytes.data(), bytes.size()}, file), flipTexCoords, separateMeshes).read();
}

}  // namespace wavecrest
