// Which faces findSolids takes for the sides of a convex solid, and that the intersector hits solids as the hierarchy
// hits their faces, from inside and outside, through open sides and at the edges.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/extend/find_solids.h"
#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

using Faces = std::vector<PrimitiveRecord<double>>;

// Quads before triangles, as findSolids expects them.
std::vector<FoundSolid> solidsOf(Faces faces) {
  std::stable_partition(faces.begin(), faces.end(),
                        [](const auto& face) { return face.kind == static_cast<uint32_t>(PrimitiveKind::quad); });
  const auto quads = static_cast<size_t>(std::count_if(faces.begin(), faces.end(), [](const auto& face) {
    return face.kind == static_cast<uint32_t>(PrimitiveKind::quad);
  }));
  return findSolids(faces.data(), quads, faces.size() - quads, std::vector<bool>(faces.size(), false));
}
size_t facesIn(const FoundSolid& solid) {
  size_t count = 0;
  solid.forEachFace([&count](uint32_t) { ++count; });
  return count;
}
size_t openSidesOf(const FoundSolid& solid) {
  return static_cast<size_t>(
      std::count_if(solid.planes.begin(), solid.planes.end(), [](const SolidPlane& side) { return side.open(); }));
}

struct Body {
  const char* name;
  Faces faces;
  size_t planes, openSides;
  Point middle;
  double half;  // a cube of this half side around the middle lies inside
};

// A pyramid without its tip, over a base of `sides` corners; each side and each end as triangles from its first corner.
// Ends have more than two triangles where they have more than four corners, so they are left out there.
Body frustum(const char* name, size_t sides, double scale, const Point& center, bool bottom, bool top) {
  std::vector<Point> low, high;
  for (size_t i = 0; i < sides; ++i) {
    const double a = 6.283185307179586 * (static_cast<double>(i) + 0.2) / static_cast<double>(sides);
    low.push_back(roundedToFloat(center + turned({std::cos(a) * scale, std::sin(a) * scale, -scale})));
    high.push_back(roundedToFloat(center + turned({0.7 * std::cos(a) * scale, 0.7 * std::sin(a) * scale, scale})));
  }
  Body body{name, {}, sides + 2, (bottom ? 0u : 1u) + (top ? 0u : 1u), center, 0.2 * scale};
  for (size_t i = 0; i < sides; ++i) {
    const size_t j = (i + 1) % sides;
    body.faces.push_back(trianglePrimitive(low[i], low[j], high[j]));
    body.faces.push_back(trianglePrimitive(low[i], high[j], high[i]));
  }
  const auto cap = [&](const std::vector<Point>& rim) {
    for (size_t i = 1; i + 1 < sides; ++i) body.faces.push_back(trianglePrimitive(rim[0], rim[i], rim[i + 1]));
  };
  if (bottom) cap(low);
  if (top) cap(high);
  return body;
}

Body cornell(bool closed) {
  const ClosedBody shell = cornellShell();
  Body body{closed ? "cornellShell" : "cornellRoom", shell.walls, 7, closed ? 0u : 1u, shell.center, shell.reach};
  if (!closed) body.faces.erase(body.faces.begin() + 8, body.faces.begin() + 10);  // the front
  return body;
}

Body tetrahedron() {
  const Point a = roundedToFloat({0, 0, 0}), b = roundedToFloat(turned({1, 0, 0})),
              c = roundedToFloat(turned({0, 1, 0})), d = roundedToFloat(turned({0, 0, 1}));
  return {
      "tetrahedron",
      {trianglePrimitive(a, b, c), trianglePrimitive(a, b, d), trianglePrimitive(a, c, d), trianglePrimitive(b, c, d)},
      4,
      0,
      (a + b + c + d) * 0.25,
      0.05};
}

const std::vector<Body>& bodies() {
  static const std::vector<Body> list{cornell(true),
                                      cornell(false),
                                      tetrahedron(),
                                      frustum("wedge", 3, 1, {0.1, 0.2, -0.3}, true, true),
                                      frustum("block", 4, 1, {0.1, 0.2, -0.3}, true, true),
                                      frustum("hugeBlock", 4, 1e6, {1e5, 2e5, -3e5}, true, true),
                                      frustum("tinyBlock", 4, 1e-4, {1e-5, 2e-5, -3e-5}, true, true),
                                      frustum("bottomless", 4, 1, {0.1, 0.2, -0.3}, false, true),
                                      frustum("pipe", 7, 1, {0.1, 0.2, -0.3}, false, false)};
  return list;
}

class FindSolidsTest : public testing::TestWithParam<Body> {};

TEST_P(FindSolidsTest, facesAroundAConvexBodyAreASolidWhateverTheirOrder) {
  Faces faces = GetParam().faces;
  for (size_t turn = 0; turn < 4; ++turn) {
    std::rotate(faces.begin(), faces.begin() + 3, faces.end());
    const auto solids = solidsOf(faces);
    ASSERT_EQ(solids.size(), 1u);
    EXPECT_EQ(facesIn(solids[0]), faces.size());
    EXPECT_EQ(openSidesOf(solids[0]), GetParam().openSides);
    if (std::string(GetParam().name).starts_with("cornell") || GetParam().faces.size() == 4) {
      EXPECT_EQ(solids[0].planes.size(), GetParam().planes);
    }
    for (const SolidPlane& side : solids[0].planes) EXPECT_LT(dot(side.normal, GetParam().middle), side.distance);
  }
}

TEST_P(FindSolidsTest, aDentOrAMeetingFaceMakesThemNone) {
  const Faces& faces = GetParam().faces;
  Faces dented = faces;  // one corner moved inwards, in all faces that have it
  const Point tip = corner(faces[0], 0, 0), moved = tip + (GetParam().middle - tip) * 0.9;
  for (auto& face : dented) {
    Point corners[] = {corner(face, 0, 0), corner(face, 1, 0), corner(face, 0, 1)};
    if (face.kind == static_cast<uint32_t>(PrimitiveKind::quad)) continue;
    for (Point& p : corners) p = length(p - tip) < 1e-9 * length(moved - tip) ? moved : p;
    face = trianglePrimitive(corners[0], corners[1], corners[2]);
  }
  if (faces.size() > 4) {
    EXPECT_TRUE(solidsOf(dented).empty());
  }
  Faces met = faces;  // a fin along an edge
  met.push_back(trianglePrimitive(tip, corner(faces[0], 1, 0), tip + (tip - GetParam().middle)));
  EXPECT_TRUE(solidsOf(met).empty());
}

TEST_P(FindSolidsTest, facesThatAreTakenAreLeftOut) {
  const Faces& faces = GetParam().faces;
  const auto quads = static_cast<size_t>(std::count_if(faces.begin(), faces.end(), [](const auto& face) {
    return face.kind == static_cast<uint32_t>(PrimitiveKind::quad);
  }));
  if (quads != 0) return;
  EXPECT_TRUE(findSolids(faces.data(), 0, faces.size(), std::vector<bool>(faces.size(), true)).empty());
}

INSTANTIATE_TEST_SUITE_P(Kernels, FindSolidsTest, testing::ValuesIn(bodies()),
                         [](const auto& instance) { return std::string(instance.param.name); });

// ---- hits -----------------------------------------------------------------------------------------------------------

class SolidHitTest : public testing::TestWithParam<std::tuple<Isa, Body>> {
 protected:
  Intersector named(const std::string& name) const {
    for (const Intersector& one : allIntersectors()) {
      if (one.name == name + "_" + std::string(toString(std::get<0>(GetParam())))) return one;
    }
    throw std::logic_error("no intersector of that name");
  }
  const Body& body() const { return std::get<1>(GetParam()); }
  double size() const { return length(corner(body().faces[0], 0, 0) - body().middle); }
};

TEST_P(SolidHitTest, raysFromInsideMeetTheEdgesTheyAreAimedAt) {
  const StageScene<float> scene(body().faces);
  ASSERT_EQ(scene.view.small->solidCount, 1u);
  RandomPoints random(51);
  for (size_t round = 0; round < effort(50, 4); ++round) {
    RayBatch batch;
    std::vector<Point> targets;
    while (!batch.full()) {
      const auto& face = body().faces[targets.size() % body().faces.size()];
      const double along = random.uniform(0.02, 0.98);
      const Point target = targets.size() % 3 == 0 ? corner(face, along, 0) : corner(face, along, 1 - along);
      targets.push_back(target);
      batch.push(aimedRay(body().middle + random.inCube(body().half), target));
    }
    batch.extend(named("small"), scene.view);
    for (size_t i = 0; i < targets.size(); ++i) {
      const uint32_t primitive = batch.wave.hits.primitive[i];
      if (primitive == kMiss) {  // past the rim
        ASSERT_NE(body().openSides, 0u) << "leaks";
        continue;
      }
      const Point found = corner(scene.precise[primitive], batch.wave.hits.u[i], batch.wave.hits.v[i]);
      ASSERT_LT(length(found - targets[i]), 1e-4 * size()) << i;
    }
  }
}

// From anywhere around: the same face in the same place, and the same segments are blocked.
TEST_P(SolidHitTest, raysMeetWhatTheyMeetOfTheFaces) {
  const StageScene<float> scene(body().faces);
  ASSERT_EQ(scene.view.small->solidCount, 1u);
  RandomPoints random(52);
  size_t hits = 0;
  for (size_t round = 0; round < effort(50, 4); ++round) {
    RayBatch batch;
    while (!batch.full()) {
      const double reach = batch.wave.rays.size % 2 == 0 ? 3 * size() : body().half;
      batch.push(aimedRay(body().middle + random.inCube(reach), body().middle + random.inCube(1.2 * size())));
    }
    batch.extend(named("bvh"), scene.view);
    std::vector<uint32_t> primitives;
    std::vector<Point> places;
    for (size_t i = 0; i < RayBatch::kCapacity; ++i) {
      const uint32_t primitive = primitives.emplace_back(batch.wave.hits.primitive[i]);
      places.push_back(
          primitive == kMiss ? Point{} : corner(scene.precise[primitive], batch.wave.hits.u[i], batch.wave.hits.v[i]));
      hits += primitive != kMiss ? 1 : 0;
    }
    batch.extend(named("small"), scene.view);
    for (size_t i = 0; i < RayBatch::kCapacity; ++i) {
      const uint32_t primitive = batch.wave.hits.primitive[i];
      ASSERT_EQ(primitive == kMiss, primitives[i] == kMiss) << i;
      if (primitive == kMiss) continue;
      const Point found = corner(scene.precise[primitive], batch.wave.hits.u[i], batch.wave.hits.v[i]);
      ASSERT_LT(length(found - places[i]), 1e-3 * size()) << i;
    }
    for (const double part : {0.3, 1.0, 4.0}) {
      const auto segment = static_cast<float>(part * size());
      ASSERT_EQ(batch.occluded(named("small"), scene.view, segment), batch.occluded(named("bvh"), scene.view, segment));
    }
  }
  EXPECT_GT(hits, effort(50, 4) * RayBatch::kCapacity / 3);
}

INSTANTIATE_TEST_SUITE_P(Kernels, SolidHitTest,
                         testing::Combine(testing::ValuesIn(availableIsas()), testing::ValuesIn(bodies())),
                         [](const auto& instance) {
                           return std::string(toString(std::get<0>(instance.param))) + "_" +
                                  std::get<1>(instance.param).name;
                         });

}  // namespace
}  // namespace wavecrest
