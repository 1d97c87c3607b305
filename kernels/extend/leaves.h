// What single rays are tested against: triangles and spheres, four to a leaf. The hierarchy of large scenes ends in
// leaves (bvh.h); of small scenes, leaves decide where a ray passes an edge too closely (small_scene.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/corner_weld.h"
#include "kernels/scene_view.h"

namespace wavecrest {

constexpr size_t kLeafSize = 4;  // primitives of a leaf

// What a hit's coordinates mean: a quad is two triangles, cut from (u, v) = (0, 0) to (1, 1).
enum class FaceKind : uint32_t { triangle, lowerHalf, upperHalf, sphere };
constexpr uint32_t kFaceKindShift = 30, kFacePrimitiveMask = (1u << kFaceKindShift) - 1;

// Slots past the last primitive repeat it. id: index into SceneView::primitives, FaceKind in the upper two bits.
struct alignas(32) FaceLeaf {
  float corner[3][3][kLeafSize];  // [corner][axis][slot]
  uint32_t id[kLeafSize];
};
struct alignas(32) SphereLeaf {
  float center[3][kLeafSize], radius[kLeafSize];
  uint32_t id[kLeafSize];
};

struct Box {
  float low[3], high[3];
};
Box unionOf(const Box* boxes, size_t count);

// Pieces of one kind of leaf: their ids and the box of each.
struct Pieces {
  std::vector<uint32_t> ids;
  std::vector<Box> boxes;

  bool empty() const { return ids.empty(); }
  Box bounds() const { return unionOf(boxes.data(), boxes.size()); }
};

// Cuts a scene into pieces and packs them.
class LeafMaker {
 public:
  // primitives: in SceneView order, and in double so that faces which share a corner agree on its float. They must
  // outlive this.
  LeafMaker(const PrimitiveRecord<double>* primitives, size_t count);

  const Pieces& faces() const { return faces_; }
  const Pieces& spheres() const { return spheres_; }
  // The leaf of up to four pieces, given by their places among the pieces.
  FaceLeaf faceLeaf(const uint32_t* items, size_t count) const;
  SphereLeaf sphereLeaf(const uint32_t* items, size_t count) const;

 private:
  using Triangle = std::array<Corner, 3>;
  Triangle cornersOf(uint32_t id) const;
  void addFace(size_t primitive, FaceKind kind);

  const PrimitiveRecord<double>* primitives_;
  CornerWeld weld_;
  Pieces faces_, spheres_;
};

// Upper bound of the coordinates of all points that rays start from, relative to which intersectors bound their
// rounding: within the scene, at the eye, or on the disc that distant light starts from, two diameters away.
double rayReach(const Box& scene, const double (&eye)[3]);

}  // namespace wavecrest
