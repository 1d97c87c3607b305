// How the hierarchy of large scenes is built: its boxes hold what lies below them, whoever builds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <map>
#include <thread>

#include "kernels/extend/bvh.h"
#include "tests/effort.h"
#include "tests/kernels/closed_bodies.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

// ---- the boxes ------------------------------------------------------------------------------------------------------

struct Bounds {
  double low[3], high[3];
};

class Contents {
 public:
  // Visits everything below the reference; all of it must lie strictly within the boxes.
  void check(const BvhView& bvh, uint32_t reference, std::vector<Bounds> boxes) {
    switch (entryOf(reference)) {
      case BvhEntry::node: {
        ++nodes;
        const auto& node = bvh.at<BvhNode>(reference);
        for (size_t i = 0; i < kBvhWidth && node.children[i] != kBvhEnd; ++i) {
          Bounds box;
          for (size_t axis = 0; axis < 3; ++axis) {
            const auto plane = [&](size_t row) {
              return double{node.corner[axis]} + double{node.scale[axis]} * node.bounds[axis][row][i];
            };
            box.low[axis] = plane(0);
            box.high[axis] = plane(1);
            EXPECT_EQ(plane(2), plane(0)) << "rays of either direction find both planes in rows side by side";
          }
          boxes.push_back(box);
          check(bvh, node.children[i], boxes);
          boxes.pop_back();
        }
        break;
      }
      case BvhEntry::faces: {
        const auto& faces = bvh.at<FaceLeaf>(reference);
        for (size_t slot = 0; slot < kLeafSize; ++slot) {
          ++slots[faces.id[slot]];
          for (const auto& corner : faces.corner) {
            for (size_t axis = 0; axis < 3; ++axis) checkPoint(boxes, axis, corner[axis][slot], corner[axis][slot]);
          }
        }
        break;
      }
      case BvhEntry::spheres: {
        const auto& spheres = bvh.at<SphereLeaf>(reference);
        for (size_t slot = 0; slot < kLeafSize; ++slot) {
          ++slots[spheres.id[slot]];
          for (size_t axis = 0; axis < 3; ++axis) {
            const double c = spheres.center[axis][slot], r = spheres.radius[slot];
            checkPoint(boxes, axis, c - r, c + r);
          }
        }
        break;
      }
      case BvhEntry::end:
        ADD_FAILURE() << "the end is no child";
    }
  }
  std::map<uint32_t, size_t> slots;  // how many hold each id
  size_t nodes = 0;

 private:
  static void checkPoint(const std::vector<Bounds>& boxes, size_t axis, double low, double high) {
    for (const Bounds& box : boxes) {
      ASSERT_LT(box.low[axis], low);
      ASSERT_GT(box.high[axis], high);
    }
  }
};

TEST(BvhTest, boxesHoldEverythingBelowThem) {
  for (const size_t count : {size_t{1}, size_t{2}, size_t{4}, size_t{5}, size_t{30}, effort(3000, 500)}) {
    const auto list = crowd(count);
    const StageScene<float> scene(list);
    Contents contents;
    contents.check(scene.bvh->view(), scene.bvh->view().root, {});
    size_t quads = 0;
    for (const auto& record : list) quads += record.kind == static_cast<uint32_t>(PrimitiveKind::quad) ? 1 : 0;
    EXPECT_EQ(contents.slots.size(), count + quads) << "each quad is two triangles, and nothing else is missing";
    for (const auto& [id, times] : contents.slots) EXPECT_LE(times, kLeafSize);
    EXPECT_EQ(contents.nodes, scene.bvh->nodes()) << count;
  }
}

// ---- what the hierarchy depends on ----------------------------------------------------------------------------------

void expectSame(const BvhView& a, uint32_t atA, const BvhView& b, uint32_t atB) {
  ASSERT_EQ(atA, atB);
  switch (entryOf(atA)) {
    case BvhEntry::node: {
      const auto &x = a.at<BvhNode>(atA), &y = b.at<BvhNode>(atB);
      ASSERT_TRUE(std::ranges::equal(x.children, y.children) && std::ranges::equal(x.corner, y.corner) &&
                  std::ranges::equal(x.scale, y.scale));
      ASSERT_EQ(std::memcmp(x.bounds, y.bounds, sizeof(x.bounds)), 0);
      for (const uint32_t child : x.children) expectSame(a, child, b, child);
      break;
    }
    case BvhEntry::faces:
      ASSERT_EQ(std::memcmp(a.address(atA), b.address(atB), sizeof(FaceLeaf)), 0);
      break;
    case BvhEntry::spheres:
      ASSERT_EQ(std::memcmp(a.address(atA), b.address(atB), sizeof(SphereLeaf)), 0);
      break;
    case BvhEntry::end:
      break;
  }
}

TEST(BvhTest, doesNotDependOnWhoBuildsIt) {
  const auto list =
      bumpySphere(160, 0.2).walls;  // enough triangles for several tasks on every level of the first three
  const Box origins = boxAt({0, 0, 0});
  const ParallelFor backwards = [](size_t count, const std::function<void(size_t)>& body) {
    for (size_t i = count; i-- > 0;) body(i);
  };
  const ParallelFor byThreads = [](size_t count, const std::function<void(size_t)>& body) {
    std::atomic<size_t> next{0};
    const auto work = [&] {
      for (size_t i = next++; i < count; i = next++) body(i);
    };
    std::thread other(work);
    work();
    other.join();
  };
  const PrimitiveSource source = PrimitiveSource::of(list.data(), list.size());
  const Bvh inOrder(source, origins, inTurn);
  for (const ParallelFor& parallelFor : {backwards, byThreads}) {
    const Bvh other(source, origins, parallelFor);
    expectSame(inOrder.view(), inOrder.view().root, other.view(), other.view().root);
  }
}

}  // namespace
}  // namespace wavecrest
