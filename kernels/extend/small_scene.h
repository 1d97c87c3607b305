// The small-scene intersector's data: every primitive in the form that costs least to test against a block of rays.
//
// Up to some hundred primitives a loop over all of them beats a hierarchy, because it has no branches and its data is
// broadcast from L1. A parallelogram is its plane n.p = d and two affine maps of space onto its own coordinates; both
// maps are centred and scaled so that the inside is max(|u|, |v|) <= 1. Five or six quads that bound a parallelepiped
// are one box, three slabs between parallel planes, at less than half the cost (kernels/extend/find_boxes.h). Other
// faces that bound a convex solid are one solid (kernels/extend/find_solids.h): a ray is inside between the last of the
// planes that it enters by and the first that it leaves by, so that no plane asks where in it a face lies.
//
// Neither wider than its primitives nor leaky: a plane takes what hits it within a bound on the rounding of u and v,
// and says how near the edge that was. Where the nearest hit was within the bound, rounding might have decided, and the
// ray is decided anew against leaves, whose neighbours agree on every edge (bvh_lanes.h). One ray in thousands is. A
// box or solid has no edges to slip through: a ray that starts inside leaves it where it leaves the first of its
// planes, whichever that is. Both planes of a slab are stored. Centre and half-width would lose precision for large
// boxes near the origin, more than kOffsetGamma allows for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/leaves.h"
#include "kernels/scene_view.h"

namespace wavecrest {

struct FoundBox;
struct FoundSolid;

// Two affine maps: u = uAxis . p + uOffset, and v likewise.
struct FaceCoordinates {
  float uAxis[3], uOffset;
  float vAxis[3], vOffset;
};
// Of a quad u and v are centred and scaled, so that the inside is max(|u|, |v|) <= 1; of a triangle they are 1 less the
// weights of two corners, so that it is max(u, v, 2 - u - v) <= 1.
struct PlaneForm {
  float normal[3], distance;
  FaceCoordinates inside;
};
// doubt: bound on the error of u and v, relative to 1 / |speed|, the ray's speed towards the plane. An error of the
// plane equation moves the hit of a grazing ray along the ray.
struct PlaneLimits {
  float doubt;
  uint32_t primitive;
};
// The points low <= normal . p <= high.
struct SlabForm {
  float normal[3], low, high;
};
struct BoxForm {
  SlabForm slabs[3];
  uint32_t primitives[3][2];  // of the faces at low and at high
};
// The points normal . p <= distance, which a solid lies among; of two faces `other` is where separator . p +
// separatorOffset > 0.
struct SidePlane {
  float normal[3], distance;
  float separator[3], separatorOffset;
  uint32_t face, other;
};
// So many of `sides`, in this order: those of one face, of two faces, and those without any.
struct SolidForm {
  uint32_t single, shared, open;
};
struct SphereForm {
  float center[3], radius;
};

// Boxes: those of six faces, then those whose face at slabs[2].high is missing. Sides: of all solids, one after the
// other. Planes: the quads that are no face of a box or solid, then such triangles. Coordinates: of all quads and
// triangles, in SceneView order, from 0 to 1 on each. Spheres follow in that order.
struct SmallSceneView {
  const BoxForm* boxes;
  const SolidForm* solids;
  const SidePlane* sides;
  const PlaneForm* planes;
  const PlaneLimits* limits;
  const FaceCoordinates* coordinates;
  const SphereForm* spheres;
  const FaceLeaf* faceLeaves;  // all quads and triangles once more
  const SphereLeaf* sphereLeaves;
  uint32_t closedBoxCount, openBoxCount, solidCount;
  uint32_t quadCount, triangleCount, sphereCount;  // of planes that are quads, and triangles; of all spheres
  uint32_t faceLeafCount, sphereLeafCount;
  uint32_t firstTriangle, firstSphere;  // in SceneView order
};

// Owner of the arrays behind a SmallSceneView.
class SmallScene {
 public:
  // primitives: sorted by kind, as in SceneView. Coordinates in double, so that the forms are right to float's last
  // place. origins: around other points that rays start from.
  SmallScene(const PrimitiveRecord<double>* primitives, size_t count, const Box& origins);
  const SmallSceneView& view() const { return view_; }

 private:
  void addBox(const FoundBox& box);
  void addSolid(const FoundSolid& solid);
  void addPlane(const PrimitiveRecord<double>& primitive, uint32_t index, double reach);
  void addLeaves(LeafMaker& leaves);

  std::vector<BoxForm> boxes_;
  std::vector<SolidForm> solids_;
  std::vector<SidePlane> sides_;
  std::vector<PlaneForm> planes_;
  std::vector<PlaneLimits> limits_;
  std::vector<FaceCoordinates> coordinates_;
  std::vector<SphereForm> spheres_;
  std::vector<FaceLeaf> faceLeaves_;
  std::vector<SphereLeaf> sphereLeaves_;
  SmallSceneView view_{};
};

}  // namespace wavecrest
