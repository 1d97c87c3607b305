// Finds convex solids among a scene's faces: blocks and rooms of any planes, closed or open at some sides.
//
// in: the quads and triangles of a small scene. out: which of them bound a solid together, by plane. Parallelepipeds
// are left to find_boxes.h, whose test is cheaper. The time it takes grows with the square of the number of faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/double_vectors.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// One side: the solid lies where normal . p <= distance; the normal has length 1. Of two faces in the plane `other` is
// the one where separator . p + separatorOffset > 0.
struct SolidPlane {
  D3 normal;
  double distance;
  uint32_t face, other;  // kNoIndex: an open side has no face, most sides have one
  D3 separator;
  double separatorOffset;

  bool open() const { return face == kNoIndex; }
  bool shared() const { return other != kNoIndex; }
};

struct FoundSolid {
  std::vector<SolidPlane> planes;
  double thickness;  // the least extent across any plane

  // Calls function(face) for every face.
  template <class Function>
  void forEachFace(Function function) const {
    for (const SolidPlane& plane : planes) {
      if (!plane.open()) function(plane.face);
      if (plane.shared()) function(plane.other);
    }
  }
};

// faces: quads, then triangles; those that are `taken` bound something else. A solid's faces share all their edges but
// those around open sides, which are flat and which nothing else meets: planes know nothing of their neighbours, so
// rays would slip between them. Every corner lies in the planes of its faces to kFlatness units of rounding.
std::vector<FoundSolid> findSolids(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles,
                                   const std::vector<bool>& taken);

}  // namespace wavecrest
