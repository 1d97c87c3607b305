#include "scenes/generate/dragon.h"

#include <zlib.h>

#include <charconv>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace wavecrest::generate {
namespace {

std::string readGzipped(const std::filesystem::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw std::runtime_error("cannot open " + file.string());
  std::string bytes;
  char block[1 << 16];
  int count = 0;
  while ((count = gzread(in.get(), block, sizeof block)) > 0) bytes.append(block, static_cast<size_t>(count));
  if (count < 0) throw std::runtime_error("cannot decompress " + file.string());
  return bytes;
}

// A cursor over the text that yields lines of the header and numbers of the body.
class Scanner {
 public:
  Scanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  std::string_view line() {
    const size_t end = text_.find('\n');
    if (end == std::string_view::npos) fail("end_header");
    std::string_view result = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    if (!result.empty() && result.back() == '\r') result.remove_suffix(1);
    return result;
  }

  template <class Number>
  Number number() {
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
    Number value{};
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number");
    text_.remove_prefix(static_cast<size_t>(end - text_.data()));
    return value;
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw std::runtime_error(file_ + ": not the PLY of the dragon scan; expected " + expected);
  }

 private:
  std::string_view text_;
  std::string file_;
};

size_t countAfter(std::string_view line, std::string_view prefix, const Scanner& scanner) {
  size_t count = 0;
  line.remove_prefix(prefix.size());
  if (std::from_chars(line.data(), line.data() + line.size(), count).ec != std::errc()) scanner.fail("a count");
  return count;
}

Mesh withoutUnusedVertices(const Mesh& mesh) {
  constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> newIndex(mesh.positions.size(), kUnused);
  for (const auto& triangle : mesh.triangles)
    for (uint32_t index : triangle) newIndex[index] = 0;
  Mesh result;
  for (size_t i = 0; i < newIndex.size(); ++i) {
    if (newIndex[i] == kUnused) continue;
    newIndex[i] = static_cast<uint32_t>(result.positions.size());
    result.positions.push_back(mesh.positions[i]);
  }
  for (const auto& [a, b, c] : mesh.triangles) result.addTriangle(newIndex[a], newIndex[b], newIndex[c]);
  return result;
}

// A vertex's normal is the sum of its triangles' cross products, so larger triangles count for more. Where they cancel,
// as at a fold, the last triangle's normal stands in.
std::vector<Vec3> areaWeightedNormals(const Mesh& mesh) {
  std::vector<Vec3> sum(mesh.positions.size(), Vec3{0, 0, 0}), last(mesh.positions.size(), Vec3{0, 1, 0});
  for (const auto& triangle : mesh.triangles) {
    const Vec3 origin = mesh.positions[triangle[0]];
    const Vec3 weighted = cross(mesh.positions[triangle[1]] - origin, mesh.positions[triangle[2]] - origin);
    if (length(weighted) == 0) continue;
    for (uint32_t index : triangle) {
      sum[index] = sum[index] + weighted;
      last[index] = normalize(weighted);
    }
  }
  constexpr double kCancelled = 1e-12;  // of a model of size 2 with triangles of area 1e-6 and more
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = length(sum[i]) > kCancelled ? normalize(sum[i]) : last[i];
  return sum;
}

}  // namespace

Mesh readScan(const std::filesystem::path& file) {
  const std::string text = readGzipped(file);
  Scanner scanner(text, file.string());
  if (scanner.line() != "ply") scanner.fail("'ply' on the first line");
  if (scanner.line() != "format ascii 1.0") scanner.fail("'format ascii 1.0'");
  size_t vertexCount = 0, triangleCount = 0;
  for (std::string_view line = scanner.line(); line != "end_header"; line = scanner.line()) {
    if (line.starts_with("element vertex ")) vertexCount = countAfter(line, "element vertex ", scanner);
    if (line.starts_with("element face ")) triangleCount = countAfter(line, "element face ", scanner);
  }
  // Every vertex and face takes at least six characters, so wrong counts are found before memory is reserved for them.
  if (vertexCount > text.size() / 6 || triangleCount > text.size() / 6) scanner.fail("as many elements as announced");

  Mesh mesh;
  mesh.positions.resize(vertexCount);
  mesh.triangles.resize(triangleCount);
  for (Vec3& position : mesh.positions)
    for (double& x : position) x = scanner.number<double>();
  for (auto& triangle : mesh.triangles) {
    if (scanner.number<uint32_t>() != 3) scanner.fail("triangles only");
    for (uint32_t& index : triangle) {
      index = scanner.number<uint32_t>();
      if (index >= vertexCount) scanner.fail("vertex indices below " + std::to_string(vertexCount));
    }
  }
  return mesh;
}

Mesh prepareDragon(const Mesh& scan) {
  constexpr Vec3 kUnderFeet{-0.0059, 0.0527, -0.0046};  // of the scan: centre in x and z, lowest point in y
  constexpr double kScale = 10;
  constexpr Vec3 kLift{0, 0.002, 0};  // so that feet and floor do not touch
  Mesh mesh = withoutUnusedVertices(scan);
  for (Vec3& position : mesh.positions) position = kScale * (position - kUnderFeet) + kLift;
  mesh.normals = areaWeightedNormals(mesh);
  return mesh;
}

}  // namespace wavecrest::generate
