// The small-scene intersector's data: every primitive in the form that costs least to test against a block of rays.
//
// Up to some hundred primitives a loop over all of them beats a hierarchy, because it has no branches and its data is
// broadcast from L1. A parallelogram is its plane n.p = d and two affine maps of space onto its own coordinates; both
// maps are centred and scaled so that the inside is max(|u|, |v|) <= 1.
//
// Watertightness: the inside is widened by a bound on the rounding error of u and v (PlaneForm::margin), so of two
// primitives that share an edge at least one is hit by any ray through the edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/scene_view.h"

namespace wavecrest {

struct PlaneForm {
  float normal[3], distance;
  float uAxis[3], uOffset;
  float vAxis[3], vOffset;
};
// Quad: the widened inside is max(|u|, |v|) <= 1, and hits report u * uScale + 0.5.
// Triangle: u, v as they are; the inside is min(u, v, 1 - u - v) >= -margin.
// grazing: how much either inside widens per 1 / |speed|, speed being the ray's speed towards the plane. The error of
// the plane equation moves the hit of a grazing ray along the ray; where two faces meet at almost 180 degrees both
// would otherwise miss it.
struct PlaneLimits {
  float uScale, vScale, margin, grazing;
};
struct SphereForm {
  float center[3], radius;
};

// Primitives in SceneView order: quads, then triangles, then spheres.
struct SmallSceneView {
  const PlaneForm* planes;
  const PlaneLimits* limits;
  const SphereForm* spheres;
  uint32_t quadCount, triangleCount, sphereCount;
};

// Owner of the arrays behind a SmallSceneView.
class SmallScene {
 public:
  // primitives: sorted by kind as above. Coordinates in double, so that the forms are right to float's last place.
  SmallScene(const PrimitiveRecord<double>* primitives, size_t count);
  const SmallSceneView& view() const { return view_; }

 private:
  void addPlane(const PrimitiveRecord<double>& primitive, double reach);

  std::vector<PlaneForm> planes_;
  std::vector<PlaneLimits> limits_;
  std::vector<SphereForm> spheres_;
  SmallSceneView view_{};
};

}  // namespace wavecrest
