// How meshes are placed: normals, orientation, triangles without area. Expectations as observed in Mitsuba 3.9.
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <numbers>

#include "engine/load/mesh_build.h"
#include "kernels/columns/parallel_ranges.h"
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// A corner of a cube: two triangles at a right angle sharing only vertex 0.
constexpr std::string_view kCorner =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0\n3 0 1 2\n3 0 3 4\n";
// One triangle whose normals face away from its winding.
constexpr std::string_view kBackward =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
    "property float ny\nproperty float nz\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n";

Scene sceneOfMesh(std::string_view ply, std::string_view options) {
  const Folder folder;
  folder.write("mesh.ply", ply);
  return load(folder, sceneXml(R"(<shape type="ply"><string name="filename" value="mesh.ply"/>)" +
                               std::string(options) + "</shape>" + std::string(kSensor)));
}
Mesh meshOf(std::string_view ply, std::string_view options = "") {
  return std::get<Mesh>(sceneOfMesh(ply, options).shapes.at(0).kind);
}
// z of the geometric normal of triangle 0, up to a positive factor.
float facingZ(const Mesh& mesh) {
  const auto& t = mesh.triangles.at(0);
  const Float3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

constexpr std::string_view kFaceNormals = R"(<boolean name="face_normals" value="true"/>)";
constexpr std::string_view kFlipped = R"(<boolean name="flip_normals" value="true"/>)";
constexpr std::string_view kMirrored = R"(<transform name="to_world"><scale x="-1"/></transform>)";

TEST(MeshNormals, AreMadeFromFacesWeightedByAngle) {
  const Mesh mesh = meshOf(kCorner);
  EXPECT_NEAR(mesh.normals[0][1], std::sqrt(0.5), 1e-7);
  EXPECT_NEAR(mesh.normals[0][2], std::sqrt(0.5), 1e-7);
  // Vertices 1 and 4 are at the same place but are two vertices: no welding.
  EXPECT_EQ(mesh.normals[1], (Float3{0, 0, 1}));
  EXPECT_EQ(mesh.normals[4], (Float3{0, 1, 0}));
}

// A sphere of many triangles without its poles; those near them are long and thin.
Mesh sphereMesh() {
  constexpr uint32_t kRings = 128, kAround = 256;
  Mesh mesh;
  for (uint32_t ring = 0; ring <= kRings; ++ring) {
    for (uint32_t i = 0; i < kAround; ++i) {
      const double theta = std::numbers::pi * ring / kRings, phi = 2 * std::numbers::pi * i / kAround;
      mesh.positions.push_back({static_cast<float>(std::sin(theta) * std::cos(phi)),
                                static_cast<float>(std::sin(theta) * std::sin(phi)),
                                static_cast<float>(std::cos(theta))});
      const uint32_t here = ring * kAround + i, next = ring * kAround + (i + 1) % kAround;
      if (ring == 0 || ring + 2 > kRings) continue;
      mesh.triangles.push_back({here, here + kAround, next});
      mesh.triangles.push_back({next, here + kAround, next + kAround});
    }
  }
  return mesh;
}

TEST(MeshNormals, OfASpherePointOutwards) {
  const Mesh mesh = sphereMesh();
  const std::vector<Float3> normals = smoothNormals(mesh);
  for (size_t i = 512; i < mesh.positions.size() - 512; ++i) {  // but of the poles and the mesh's two borders
    const Float3 &n = normals[i], &p = mesh.positions[i];
    ASSERT_GT(double{n[0]} * p[0] + double{n[1]} * p[1] + double{n[2]} * p[2], 1 - 1e-3) << i;
  }
}

TEST(MeshNormals, DoNotDependOnThreads) {
  const Mesh mesh = sphereMesh();
  ASSERT_GT(mesh.triangles.size(), 3 * kRange);
  std::vector<Float3> one, two;
  oneapi::tbb::task_arena(1).execute([&] { one = smoothNormals(mesh); });
  oneapi::tbb::task_arena(2).execute([&] { two = smoothNormals(mesh); });
  EXPECT_EQ(one, two);
}

TEST(MeshNormals, AreDroppedWithFaceNormals) {
  EXPECT_TRUE(meshOf(kCorner, kFaceNormals).normals.empty());
  EXPECT_TRUE(meshOf(kBackward, kFaceNormals).normals.empty());
}

TEST(MeshNormals, TransformByTheInverseTranspose) {
  const Mesh mesh = meshOf(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\n"
      "property float ny\nproperty float nz\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0.6 0 0.8\n1 0 0 0.6 0 0.8\n0 1 0 0.6 0 0.8\n3 0 1 2\n",
      R"(<transform name="to_world"><scale x="2"/></transform>)");
  // (0.6 / 2, 0, 0.8) normalised
  EXPECT_NEAR(mesh.normals[0][0], 0.3 / std::sqrt(0.73), 1e-7);
  EXPECT_NEAR(mesh.normals[0][2], 0.8 / std::sqrt(0.73), 1e-7);
}

TEST(MeshNormals, ZeroNormalOfTheFileIsReplacedByTheSmoothOne) {
  std::string text(kBackward);
  text.replace(text.find("0 0 0 0 0 -1"), 12, "0 0 0 0 0  0");
  EXPECT_EQ(std::abs(meshOf(text).normals[0][2]), 1);
}

TEST(MeshOrientation, WindingDecidesWithoutNormals) {
  EXPECT_GT(facingZ(meshOf(kCorner)), 0);
  EXPECT_LT(facingZ(meshOf(kCorner, kFlipped)), 0);
}

TEST(MeshOrientation, MirrorTurnsAMeshWithoutNormalsInsideOut) {
  EXPECT_LT(facingZ(meshOf(kCorner, kMirrored)), 0);
  EXPECT_LT(meshOf(kCorner, kMirrored).normals[1][2], 0);
  EXPECT_LT(facingZ(meshOf(kCorner, std::string(kMirrored) + std::string(kFaceNormals))), 0);
}

TEST(MeshOrientation, NormalsOfTheFileDecide) {
  EXPECT_LT(facingZ(meshOf(kBackward)), 0);
  EXPECT_LT(facingZ(meshOf(kBackward, kMirrored)), 0);
  EXPECT_GT(facingZ(meshOf(kBackward, kFlipped)), 0);
}

TEST(MeshOrientation, FaceNormalsForgetTheNormalsOfTheFile) { EXPECT_GT(facingZ(meshOf(kBackward, kFaceNormals)), 0); }

TEST(MeshOrientation, FlipNormalsTurnsVertexNormalsToo) {
  EXPECT_EQ(meshOf(kBackward, kFlipped).normals[0], (Float3{0, 0, 1}));
}

TEST(MeshTriangles, WithoutAreaAreLeftOutAndCounted) {
  const Scene scene = sceneOfMesh(withLine(kQuadPly, kQuadPlyVertexLine + 5, "3 1 3 1"), "");
  EXPECT_EQ(std::get<Mesh>(scene.shapes.at(0).kind).triangles.size(), 1u);
  EXPECT_EQ(scene.droppedTriangles, 1u);
}

TEST(MeshTriangles, OnOneLineHaveNoArea) {
  // 0.1, 0.2, 0.3 are not exact in float, so the cross product is a rounding residue.
  const Scene scene = sceneOfMesh(
      withLine(withLine(withLine(kQuadPly, kQuadPlyVertexLine, "0.1 0.1 0.1"), kQuadPlyVertexLine + 1, "0.2 0.2 0.2"),
               kQuadPlyVertexLine + 2, "0.3 0.3 0.3"),
      "");
  EXPECT_EQ(scene.droppedTriangles, 1u);
}

TEST(MeshTriangles, ThinOnesStay) {
  EXPECT_EQ(sceneOfMesh(withLine(kQuadPly, kQuadPlyVertexLine + 2, "0 1e-6 0"), "").droppedTriangles, 0u);
}

TEST(MeshPositions, BeyondFloatRangeAreAnError) {
  const Folder folder;
  folder.write("mesh.ply", withLine(kQuadPly, kQuadPlyVertexLine + 1, "1e30 0 0"));
  expectError(folder,
              sceneXml("\n<shape type=\"ply\"><string name=\"filename\" value=\"mesh.ply\"/><transform "
                       "name=\"to_world\"><scale value=\"1e30\"/></transform></shape>" +
                       std::string(kSensor)),
              2, "beyond the range of float");
}

}  // namespace
}  // namespace wavecrest
