// What single rays are tested against: triangles and spheres, four to a leaf. The hierarchy of large scenes ends in
// leaves (bvh.h); of small scenes, leaves decide where a ray passes an edge too closely (small_scene.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/columns/memory_block.h"
#include "kernels/extend/corner_weld.h"
#include "kernels/extend/primitive_source.h"

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
// Of a point, rounded to float.
Box boxAt(const double (&point)[3]);

// What a leaf holds in a slot, and its box. Four floats may be read from `low` and from `high`.
struct alignas(16) Piece {
  float low[3];
  uint32_t id;
  float high[3];
  uint32_t unused;

  Box box() const { return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}; }
};

// Pieces of one kind of leaf.
class Pieces {
 public:
  Pieces() = default;
  explicit Pieces(size_t count) : memory_(count * sizeof(Piece), alignof(Piece)), count_(count) {}

  Piece* begin() { return reinterpret_cast<Piece*>(memory_.get()); }
  Piece* end() { return begin() + count_; }
  const Piece* begin() const { return reinterpret_cast<const Piece*>(memory_.get()); }
  const Piece* end() const { return begin() + count_; }
  size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }

 private:
  MemoryBlock memory_;
  size_t count_ = 0;
};

// Cuts a scene into pieces and packs them.
class LeafMaker {
 public:
  // primitives: in SceneView order. What they refer to must outlive this.
  LeafMaker(PrimitiveSource primitives, const ParallelFor& parallelFor);

  Pieces& faces() { return faces_; }
  Pieces& spheres() { return spheres_; }
  // The leaf of up to four pieces, given by their ids.
  FaceLeaf faceLeaf(const uint32_t* ids, size_t count) const;
  SphereLeaf sphereLeaf(const uint32_t* ids, size_t count) const;

 private:
  using Triangle = std::array<Corner, 3>;
  Triangle cornersOf(uint32_t id) const;

  PrimitiveSource primitives_;
  CornerWeld weld_;
  Pieces faces_, spheres_;
};

// Upper bound of the coordinates of all points that rays start from, relative to which intersectors bound their
// rounding: within the scene, on the box that distant light starts from, or within `origins`, around the eye and lights
// that have a place; with room to spare.
double rayReach(const Box& scene, const Box& origins);

}  // namespace wavecrest
