// Finds the parallelepipeds among a scene's quads: blocks of six faces, and rooms or blocks of five, open at one side.
//
// in: the quads and triangles of a small scene. out: which quads belong together. Fewer faces are cheaper to test one
// by one. The time it takes grows with the square of their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/double_vectors.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// The points with low[k] <= normal[k] . p <= high[k] for all k; normals have length 1.
struct FoundBox {
  D3 normal[3];
  double low[3], high[3];
  uint32_t quad[3][2];  // which quads are the faces at low and high; quad[2][1] is kNoIndex if the box is open there
  bool open() const { return quad[2][1] == kNoIndex; }
  // Calls function(quad) for every face that is there.
  template <class Function>
  void forEachQuad(Function function) const {
    for (const auto& pair : quad) {
      for (const uint32_t face : pair) {
        if (face != kNoIndex) function(face);
      }
    }
  }
};

// faces: quads, then triangles. No quad is part of two boxes. Every corner of a face lies in the box's plane to
// kFlatness units of rounding. A box that something else meets along the edges of its open side stays quads: slabs know
// nothing of their neighbours, so rays would slip between them.
std::vector<FoundBox> findBoxes(const PrimitiveRecord<double>* faces, size_t quads, size_t triangles);

}  // namespace wavecrest
