// In no scene of ours do faces of two materials share a plane, a side and an area: rounding alone would choose between
// them, and float and double chose differently (a door frame flush with its wall made veach-door 0.1 % brighter in
// float).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/compile/compiled_scene.h"
#include "engine/scene/vector_math.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

struct Face {
  std::vector<Double3> corners;  // counterclockwise about the normal
  Double3 normal;
  uint32_t material, index;
};

// Triangles and parallelograms that are not too small a part of the scene: of meshes, none.
std::vector<Face> largeFacesOf(const CompiledScene<double>& scene, double radius) {
  const auto& list = scene.primitives;
  std::vector<Face> faces;
  for (uint32_t i = 0; i < list.counts.quads + list.counts.triangles; ++i) {
    const PrimitiveRecord<double>& record = list.records[i];
    const auto vector = [](const double(&v)[3]) { return Double3{v[0], v[1], v[2]}; };
    const Double3 p = vector(record.p0), e1 = vector(record.e1), e2 = vector(record.e2);
    if (length(cross(e1, e2)) < 1e-5 * radius * radius) continue;
    Face face{{p, p + e1}, normalized(vector(record.normal)), record.material, i};
    if (i < list.counts.quads) face.corners.push_back(p + e1 + e2);
    face.corners.push_back(p + e2);
    if (dot(cross(e1, e2), face.normal) < 0) std::reverse(face.corners.begin(), face.corners.end());
    faces.push_back(std::move(face));
  }
  return faces;
}

double areaOf(const std::vector<Double3>& polygon, const Double3& normal) {
  double sum = 0;
  for (size_t i = 2; i < polygon.size(); ++i) {
    sum += dot(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]), normal);
  }
  return sum / 2;
}

// What of a polygon lies inside of all edges of another in its plane (Sutherland and Hodgman).
double sharedArea(const Face& a, const Face& b) {
  std::vector<Double3> inside = a.corners;
  for (size_t i = 0; i < b.corners.size() && !inside.empty(); ++i) {
    const Double3 begin = b.corners[i], edge = b.corners[(i + 1) % b.corners.size()] - begin;
    const Double3 inwards = cross(b.normal, edge);
    std::vector<Double3> next;
    for (size_t k = 0; k < inside.size(); ++k) {
      const Double3 &p = inside[k], &q = inside[(k + 1) % inside.size()];
      const double atP = dot(p - begin, inwards), atQ = dot(q - begin, inwards);
      if (atP >= 0) next.push_back(p);
      if ((atP < 0) != (atQ < 0)) next.push_back(p + (atP / (atP - atQ)) * (q - p));
    }
    inside = std::move(next);
  }
  return areaOf(inside, a.normal);
}

// Faces of different materials one in the other. Not those on the scene's own box that face out of it, which nothing
// sees.
std::vector<std::string> flushFacesOf(const Scene& scene) {
  const auto compiled = compileScene<double>(scene, Accel::bvh);
  const BoundingSphere& bounds = compiled->bounds;
  const double tolerance = 1e-5 * bounds.radius;
  const auto facesOut = [&](const Face& face) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double end = face.normal[axis] < 0 ? bounds.low[axis] : bounds.high[axis];
      if (std::abs(face.normal[axis]) > 1 - 1e-9 && std::abs(face.corners[0][axis] - end) < tolerance) return true;
    }
    return false;
  };
  const std::vector<Face> faces = largeFacesOf(*compiled, bounds.radius);
  std::vector<std::string> found;
  for (size_t i = 0; i < faces.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const Face &a = faces[i], &b = faces[k];
      if (a.material == b.material || dot(a.normal, b.normal) < 1 - 1e-9 || facesOut(a)) continue;
      if (std::abs(dot(a.corners[0] - b.corners[0], a.normal)) > tolerance) continue;
      const double area = sharedArea(a, b);
      if (area < 1e-7 * bounds.radius * bounds.radius) continue;
      const Double3& at = a.corners[0];
      found.push_back(
          fmt::format("primitives {} (at {} {} {}) and {} share {}", a.index, at[0], at[1], at[2], b.index, area));
    }
  }
  return found;
}

class CoplanarFacesTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, CoplanarFacesTest,
                         testing::Values("cornell-diffuse", "cornell-mirror", "cornell-glossy", "cornell-spheres",
                                         "lafortune-room", "pool-interior", "veach-door"));
TEST_P(CoplanarFacesTest, areOfOneMaterial) {
  EXPECT_EQ(flushFacesOf(sceneFile(GetParam(), 16, 16)), std::vector<std::string>());
}

TEST(CoplanarFaces, areFound) {
  Scene scene = sceneFile("cornell-diffuse", 16, 16);
  for (const float left : {100.0f, 250.0f}) {  // two posters in the room, one partly on the other
    Mesh poster;
    poster.positions = {{left, 200, 500}, {left, 300, 500}, {left + 200, 300, 500}, {left + 200, 200, 500}};
    poster.triangles = {{0, 1, 2}, {0, 2, 3}};
    addShape(scene, poster, addDiffuse(scene, 0.1, 0.2, 0.3));
  }
  EXPECT_EQ(flushFacesOf(scene).size(), 1u);
}

}  // namespace
}  // namespace wavecrest
