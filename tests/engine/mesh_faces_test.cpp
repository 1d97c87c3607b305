// Which pairs of a mesh's triangles become quads, and that faces still meet where they did.
#include "engine/compile/mesh_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/compile/primitives.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// A turned cube of half edge 1 about `center` with vertices as six decimals write them, or as they are in float.
Mesh turnedCube(double turn, bool sixDecimals, const Double3& center = {0.3, -0.2, 0.1}) {
  Mesh mesh;
  for (uint32_t i = 0; i < 8; ++i) {
    const double x = (i & 1) != 0 ? 1 : -1, y = (i & 2) != 0 ? 1 : -1, z = (i & 4) != 0 ? 1 : -1;
    const double a = turn, b = 0.7 * turn, across = x * std::cos(a) + z * std::sin(a);
    Double3 p{across * std::cos(b) - y * std::sin(b) + center[0], across * std::sin(b) + y * std::cos(b) + center[1],
              z * std::cos(a) - x * std::sin(a) + center[2]};
    if (sixDecimals) {
      for (double& c : p) c = std::round(c * 1e6) / 1e6;
    }
    mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// How many different corners the leaves of the scene have.
size_t cornersInLeaves(const Scene& scene) {
  const PrimitiveList list(scene, false, inTurn);
  LeafMaker leaves(list.source(), inTurn);
  std::set<Corner> corners;
  for (const Piece& piece : leaves.faces()) {
    const FaceLeaf leaf = leaves.faceLeaf(&piece.id, 1);
    for (const auto& corner : leaf.corner) corners.insert(Corner{corner[0][0], corner[1][0], corner[2][0]});
  }
  return corners.size();
}
size_t cornersInLeaves(const Mesh& mesh) {
  Scene scene;
  addShape(scene, mesh, addDiffuse(scene, 0.5, 0.5, 0.5));
  return cornersInLeaves(scene);
}

TEST(MeshFaces, ofACubeMeetInItsCorners) {
  for (double turn = 0.05; turn < 6; turn += 0.1) {
    for (const bool sixDecimals : {true, false}) {
      const Mesh cube = turnedCube(turn, sixDecimals);
      EXPECT_EQ(cornersInLeaves(cube), 8u) << turn;
      if (!sixDecimals) {
        EXPECT_EQ(facesOf(cube, false, {}, false, inTurn).quads.size(), 6u) << turn;
      }
    }
  }
}

// Far from the group's origin float resolves vertices less than where the copy is.
TEST(MeshFaces, ofACopiedCubeMeetInItsCorners) {
  for (double turn = 0.05; turn < 6; turn += 0.1) {
    Scene scene;
    scene.groups.push_back({.id = "cube", .source = {}});
    addShape(scene, turnedCube(turn, false, {30, -20, 10}), addDiffuse(scene, 0.5, 0.5, 0.5)).group = 0;
    scene.instances.push_back({.id = {},
                               .group = 0,
                               .toWorld = {{{1, 0, 0, -30}, {0, 1, 0, 20}, {0, 0, 1, -10}, {0, 0, 0, 1}}},
                               .source = {}});
    EXPECT_EQ(cornersInLeaves(scene), 8u) << turn;
  }
}
TEST(MeshFaces, ofACopiedCubeArePairedWhereTheyAreExact) {
  EXPECT_EQ(facesOf(turnedCube(0, false, {0, 0, 0}), false, {}, true, inTurn).quads.size(), 6u);
}

// A unit square beside one 99 times as long, whose fourth corner is farther off than the small one welds.
TEST(MeshFaces, ofSmallAndLargeSquaresMeetInTheirCorners) {
  Mesh mesh;
  mesh.positions = {{-.44344863f, -.41512799f, .33549887f}, {-.18272413f, .54612339f, .42504498f},
                    {.46567744f, -.69080132f, .64773917f},  {.72640193f, .27045009f, .73728526f},
                    {90.469162f, -27.982458f, 31.559528f},  {90.729881f, -27.021208f, 31.649075f}};
  mesh.triangles = {{0, 2, 1}, {3, 1, 2}, {2, 4, 3}, {5, 3, 4}};
  ASSERT_EQ(facesOf(mesh, false, {}, false, inTurn).quads.size(), 2u);
  EXPECT_EQ(cornersInLeaves(mesh), 6u);
}

// A square of two triangles, whose common edge is that of vertices 1 and 2 in the one, 4 and 5 in the other.
Mesh splitSquare() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 1}, {1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

TEST(MeshFaces, stayTrianglesWhereTheirSidesOfTheEdgeDiffer) {
  const auto quads = [](const Mesh& mesh) { return facesOf(mesh, true, {}, false, inTurn).quads.size(); };
  EXPECT_EQ(quads(splitSquare()), 1u);
  Mesh mesh = splitSquare();
  std::swap(mesh.uvs[4], mesh.uvs[5]);
  EXPECT_EQ(quads(mesh), 0u) << "texture coordinates";
  mesh = splitSquare();
  mesh.normals[4] = {0, 0.6f, 0.8f};
  EXPECT_EQ(quads(mesh), 0u) << "normals";
}

// A long thin triangle, with its corners in every order.
TEST(PrimitiveList, turnsThinTrianglesToAShortEdgeAtTheSecondCorner) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 1, 0}, {4, 1.01f, 0}};
  for (uint32_t first = 0; first < 3; ++first) {
    for (const uint32_t step : {1u, 2u}) {
      mesh.triangles = {{first, (first + step) % 3, (first + 2 * step) % 3}};
      Scene scene;
      addShape(scene, mesh, addDiffuse(scene, 0.5, 0.5, 0.5));
      const PrimitiveList list(scene, false, inTurn);
      const auto record = list.geometry<double>(0);
      const Double3 ab{record.e1[0], record.e1[1], record.e1[2]}, ac{record.e2[0], record.e2[1], record.e2[2]};
      const double least = std::min(dot(ab, ab), dot(ac - ab, ac - ab));
      EXPECT_LT(least, 1e-3) << first << ' ' << step;
      EXPECT_EQ(record.normal[2], step == 1 ? 1 : -1);
    }
  }
}

}  // namespace
}  // namespace wavecrest
