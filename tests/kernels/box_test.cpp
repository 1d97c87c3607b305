// Which quads findBoxes takes for the faces of one parallelepiped, and that the intersector hits these boxes as it hits
// their faces: at edges and corners, through an open side, and along the axes.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/extend/find_boxes.h"
#include "kernels/extend/offset.h"
#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

using Quads = std::vector<PrimitiveRecord<double>>;

struct Frame {
  const char* name;
  Point center, edge[3];
};

const std::vector<Frame>& frames() {
  static const std::vector<Frame> list{
      {"unit", {0.5, 0.5, 0.5}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {"turned", {0.1, -0.2, 0.3}, {turned({2, 0, 0}), turned({0, 2, 0}), turned({0, 0, 2})}},
      {"mirrored", {0.1, -0.2, 0.3}, {turned({-2, 0, 0}), turned({0, 2, 0}), turned({0, 0, 2})}},
      {"flat", {3, 1, -2}, {turned({5, 0, 0}), turned({0, 0.01, 0}), turned({0, 0, 0.7})}},
      {"sheared", {3, 1, -2}, {turned({1, 0.5, 0}), turned({0.3, 1, 0.2}), turned({0, 0.4, 1})}},
      {"huge", {3e5, 1e5, -2e5}, {turned({1e6, 0, 0}), turned({0, 1e6, 0}), turned({0, 0, 1e6})}},
      {"tiny", {3e-5, 1e-5, -2e-5}, {turned({1e-4, 0, 0}), turned({0, 1e-4, 0}), turned({0, 0, 1e-4})}},
  };
  return list;
}

// Face 2 k + side, from a corner and in an orientation that differ from face to face.
PrimitiveRecord<double> faceOf(const Frame& frame, size_t k, size_t side) {
  Point u = frame.edge[(k + 1) % 3], v = frame.edge[(k + 2) % 3];
  if (k == 1) u = u * -1;
  if (side == 1) std::swap(u, v);
  const Point middle = frame.center + frame.edge[k] * (side == 0 ? -0.5 : 0.5);
  return facePrimitive(PrimitiveKind::quad, middle - (u + v) * 0.5, u, v);
}
Quads facesOf(const Frame& frame) {
  Quads faces;
  for (size_t face = 0; face < 6; ++face) faces.push_back(faceOf(frame, face / 2, face % 2));
  return faces;
}
Quads joined(Quads a, const Quads& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
std::vector<FoundBox> boxesOf(const Quads& quads) { return findBoxes(quads.data(), quads.size(), 0); }

// Every quad that belongs to some box, sorted.
std::vector<uint32_t> claimed(const std::vector<FoundBox>& boxes) {
  std::vector<uint32_t> list;
  for (const FoundBox& box : boxes) box.forEachQuad([&list](uint32_t quad) { list.push_back(quad); });
  std::sort(list.begin(), list.end());
  return list;
}

class FindBoxesTest : public testing::TestWithParam<Frame> {};

TEST_P(FindBoxesTest, sixFacesAreABoxWhateverTheirOrder) {
  Quads quads = facesOf(GetParam());
  for (size_t turn = 0; turn < 6; ++turn) {
    std::rotate(quads.begin(), quads.begin() + 1, quads.end());
    const std::vector<FoundBox> boxes = boxesOf(quads);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_FALSE(boxes[0].open());
    EXPECT_EQ(claimed(boxes), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  }
}

TEST_P(FindBoxesTest, boxesKnowWhichFaceLiesWhere) {
  const Quads quads = facesOf(GetParam());
  const std::vector<FoundBox> boxes = boxesOf(quads);
  ASSERT_EQ(boxes.size(), 1u);
  for (size_t axis = 0; axis < 3; ++axis) {
    const Point normal = boxes[0].normal[axis];
    EXPECT_LT(boxes[0].low[axis], boxes[0].high[axis]);
    for (size_t side = 0; side < 2; ++side) {
      const auto& quad = quads[boxes[0].quad[axis][side]];
      const double bound = side == 0 ? boxes[0].low[axis] : boxes[0].high[axis];
      for (const Point& p : {corner(quad, 0, 0), corner(quad, 1, 0), corner(quad, 0, 1), corner(quad, 1, 1)}) {
        EXPECT_NEAR(dot(normal, p), bound, 1e-12 * length(p));
      }
    }
  }
}

TEST_P(FindBoxesTest, fiveFacesAreABoxThatIsOpenAtTheSixth) {
  for (size_t missing = 0; missing < 6; ++missing) {
    Quads quads = facesOf(GetParam());
    const PrimitiveRecord<double> lid = quads[missing];
    quads.erase(quads.begin() + static_cast<std::ptrdiff_t>(missing));
    const std::vector<FoundBox> boxes = boxesOf(quads);
    ASSERT_EQ(boxes.size(), 1u);
    ASSERT_TRUE(boxes[0].open());
    EXPECT_EQ(claimed(boxes), (std::vector<uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_NEAR(dot(boxes[0].normal[2], corner(lid, 0.3, 0.6)), boxes[0].high[2],
                1e-12 * length(corner(lid, 0.3, 0.6)));
  }
}

// Slabs know nothing of their neighbours; quads and triangles agree on the edges that they share.
TEST_P(FindBoxesTest, fiveFacesAreNoneWhereSomethingMeetsTheRimOfTheOpenSide) {
  for (size_t missing = 0; missing < 6; ++missing) {
    Quads faces = facesOf(GetParam());
    const PrimitiveRecord<double> lid = faces[missing];
    const Point p = corner(lid, 0, 0), u = corner(lid, 1, 0), v = corner(lid, 0, 1), wider = u * 2 - p;
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(missing));
    for (const auto& other : {trianglePrimitive(p, u, v),                                     // a part of a lid
                              trianglePrimitive(p * 2 - u, wider, p * 3 - u - v),             // wider, beside it
                              trianglePrimitive(p * 0.5 + u * 0.5, wider, u * 3 - v - p)}) {  // along a part of the rim
      Quads all = faces;
      all.push_back(other);
      EXPECT_TRUE(findBoxes(all.data(), 5, 1).empty());
    }
    // The ground around a block without a bottom, and something within the opening, leave the rim alone.
    Quads ground = faces;
    const Point middle = corner(lid, 0.5, 0.5), e1 = u - p, e2 = v - p;
    ground.push_back(trianglePrimitive(middle - (e1 + e2) * 4, middle + e1 * 9 - e2 * 4, middle + e2 * 9 - e1 * 4));
    EXPECT_EQ(findBoxes(ground.data(), 5, 1).size(), 1u);
    Quads inside = faces;
    inside.push_back(trianglePrimitive(corner(lid, 0.2, 0.2), corner(lid, 0.7, 0.2), corner(lid, 0.2, 0.7)));
    EXPECT_EQ(findBoxes(inside.data(), 5, 1).size(), 1u);
  }
}

TEST_P(FindBoxesTest, fourFacesAreNone) {
  for (size_t missing = 0; missing < 5; ++missing) {
    Quads quads = facesOf(GetParam());
    quads.erase(quads.begin() + static_cast<std::ptrdiff_t>(missing),
                quads.begin() + static_cast<std::ptrdiff_t>(missing) + 2);
    EXPECT_TRUE(boxesOf(quads).empty());
  }
}

// Off by 16 units of rounding, four times what corners may be, the sixth face stays a quad.
TEST_P(FindBoxesTest, aFaceThatIsOffStaysAQuad) {
  const Frame& frame = GetParam();
  const double reach = length(frame.center) + length(frame.edge[0]) + length(frame.edge[1]) + length(frame.edge[2]);
  const double step = 16 * 0x1p-24 * reach;
  for (size_t face = 0; face < 6; ++face) {
    const Point outward = normalized(frame.edge[face / 2]), along = normalized(frame.edge[(face / 2 + 1) % 3]);
    const PrimitiveRecord<double> right = faceOf(frame, face / 2, face % 2);
    const Point p = corner(right, 0, 0), u = corner(right, 1, 0), v = corner(right, 0, 1);
    const Quads wrong{quadPrimitive(p + outward * step, u + outward * step, v + outward * step),  // moved out
                      quadPrimitive(p, u + outward * step, v),                                    // tilted
                      quadPrimitive(p + along * step, u + along * step, v + along * step)};       // moved aside
    for (size_t i = 0; i < wrong.size(); ++i) {
      Quads quads = facesOf(frame);
      quads[face] = wrong[i];
      const std::vector<uint32_t> list = claimed(boxesOf(quads));
      EXPECT_EQ(std::count(list.begin(), list.end(), face), 0) << "face " << face << " case " << i;
    }
  }
}

TEST_P(FindBoxesTest, stackedBoxesAreTwo) {
  const Frame& lower = GetParam();
  Frame upper = lower;
  upper.center = upper.center + upper.edge[2];
  const std::vector<FoundBox> boxes = boxesOf(joined(facesOf(lower), facesOf(upper)));
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(claimed(boxes), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

INSTANTIATE_TEST_SUITE_P(Kernels, FindBoxesTest, testing::ValuesIn(frames()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(FindBoxesTest, roomsOfTheOtherTestsAreBoxes) {
  for (const double scale : {1e-4, 1.0, 1e4, 1e6}) {
    EXPECT_EQ(boxesOf(turnedCube(scale, {0.1 * scale, -0.2 * scale, 0.3 * scale}, false).walls).size(), 1u) << scale;
  }
}

// ---- hits -----------------------------------------------------------------------------------------------------------

class BoxHitTest : public testing::TestWithParam<std::tuple<Intersector, Frame>> {
 protected:
  const Intersector& intersector() const { return std::get<0>(GetParam()); }
  const Frame& frame() const { return std::get<1>(GetParam()); }
  Point at(const Point& unit) const {  // [-1, 1]^3 to the box
    return frame().center + (frame().edge[0] * unit[0] + frame().edge[1] * unit[1] + frame().edge[2] * unit[2]) * 0.5;
  }
  // Hits are moved inwards by kInset, and off by 32 units of rounding of a coordinate, more where a flat box is met at
  // a slant.
  double tolerance() const {
    const auto [shortest, longest] =
        std::minmax({length(frame().edge[0]), length(frame().edge[1]), length(frame().edge[2])});
    const double rounding = 32 * kUnitRoundoff * (length(frame().center) + 2 * longest);
    return 2 * double{kInset} * longest + rounding * (longest / shortest);
  }
};

// Embree and the hierarchy need corners that all faces share in float; boxes do not.
std::vector<Intersector> smallIntersectors() {
  std::vector<Intersector> list = allIntersectors();
  std::erase_if(list, [](const Intersector& intersector) { return !intersector.name.starts_with("small"); });
  return list;
}

// Which face of an edge it is may be decided by rounding, but not where.
TEST_P(BoxHitTest, raysFromInsideMeetTheEdgeTheyAreAimedAt) {
  const StageScene<float> scene(facesOf(frame()));
  RandomPoints random(31);
  RayBatch batch;
  std::vector<Point> targets;
  const auto run = [&] {
    ASSERT_EQ(batch.extend(intersector(), scene.view), 0u) << "leaks";
    for (size_t i = 0; i < targets.size(); ++i) {
      const auto& hit = scene.precise[batch.wave.hits.primitive[i]];
      const double error = length(corner(hit, batch.wave.hits.u[i], batch.wave.hits.v[i]) - targets[i]);
      ASSERT_LT(error, tolerance()) << i;
    }
  };
  for (size_t round = 0; round < effort(100, 5); ++round) {
    targets.clear();
    for (batch.clear(); !batch.full(); batch.push(aimedRay(at(random.inCube(0.5)), targets.back()))) {
      Point unit = random.inCube(1);
      const size_t free = batch.wave.rays.size % 4;  // 3: a corner
      for (size_t axis = 0; axis < 3; ++axis) {
        if (axis != free) unit[axis] = unit[axis] < 0 ? -1 : 1;
      }
      targets.push_back(at(unit));
    }
    run();
  }
}

// A wall of two triangles closes the open side: nothing gets out along its edges.
TEST_P(BoxHitTest, nothingGetsOutBesideWhatClosesAnOpenBox) {
  RandomPoints random(32);
  RayBatch batch;
  for (size_t face = 0; face < 6; ++face) {
    Quads walls = facesOf(frame());
    const PrimitiveRecord<double> lid = walls[face];
    walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(face));
    walls.push_back(trianglePrimitive(corner(lid, 0, 0), corner(lid, 1, 0), corner(lid, 0, 1)));
    walls.push_back(trianglePrimitive(corner(lid, 1, 1), corner(lid, 0, 1), corner(lid, 1, 0)));
    const StageScene<float> scene(walls);
    for (size_t round = 0; round < effort(20, 2); ++round) {
      for (batch.clear(); !batch.full();) {
        const double along = random.uniform(0, 1), end = random.uniform(0, 1) < 0.5 ? 0 : 1;
        const Point edge = batch.wave.rays.size % 2 == 0 ? corner(lid, along, end) : corner(lid, end, along);
        // On the edge or just beside it, within the box's wall or beyond.
        const double beside = std::exp2(random.uniform(-26, -8)) * (random.uniform(0, 1) < 0.5 ? -1 : 1);
        const Point target = edge + frame().edge[face / 2] * beside;
        batch.push(aimedRay(at(random.inCube(0.9)), target));
      }
      ASSERT_EQ(batch.extend(intersector(), scene.view), 0u) << "face " << face;
    }
  }
}

// From outside into the open side, and past the box: as through the five faces alone.
TEST_P(BoxHitTest, openSidesLetRaysIn) {
  RandomPoints random(33);
  RayBatch batch;
  for (size_t face = 0; face < 6; ++face) {
    Quads walls = facesOf(frame());
    walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(face));
    const StageScene<float> scene(walls);
    const size_t axis = face / 2;
    const double side = face % 2 == 0 ? -1 : 1;
    batch.clear();
    while (!batch.full()) {
      Point from = random.inCube(0.5), to = random.inCube(0.9);
      from[axis] = 3 * side;
      to[axis] = -side;
      batch.push(aimedRay(at(from), at(to)));
    }
    EXPECT_EQ(batch.extend(intersector(), scene.view), 0u) << "face " << face;
    const auto opposite = static_cast<uint32_t>(face % 2 == 0 ? face : face - 1);  // its index after the removal
    size_t through = 0;
    for (size_t i = 0; i < RayBatch::kCapacity; ++i) through += batch.wave.hits.primitive[i] == opposite ? 1 : 0;
    EXPECT_EQ(through, RayBatch::kCapacity) << "face " << face;
    batch.clear();
    while (!batch.full()) {  // out again by the way that is open
      Point to = random.inCube(0.9);
      to[axis] = side;
      batch.push(aimedRay(at(random.inCube(0.5)), at(to)));
    }
    EXPECT_EQ(batch.extend(intersector(), scene.view), RayBatch::kCapacity) << "face " << face;
  }
}

std::string nameOfFrame(const testing::TestParamInfo<std::tuple<Intersector, Frame>>& instance) {
  return std::get<0>(instance.param).name + "_" + std::get<1>(instance.param).name;
}
INSTANTIATE_TEST_SUITE_P(Kernels, BoxHitTest,
                         testing::Combine(testing::ValuesIn(smallIntersectors()), testing::ValuesIn(frames())),
                         nameOfFrame);

}  // namespace
}  // namespace wavecrest
