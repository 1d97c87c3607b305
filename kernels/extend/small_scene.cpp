#include "kernels/extend/small_scene.h"

#include <algorithm>

#include "kernels/extend/find_boxes.h"
#include "kernels/extend/find_solids.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// How far rounding may move the point where a ray meets a plane, as the plane's own coordinates and the leaves see it,
// in units of rounding of the largest coordinate, per 1 / |cosine|. Here: the reciprocal of the speed and the product
// with it 8, the plane's gap 10, the point 4, its coordinates 12. There: corners 7 for being welded and 2 for being
// rounded, 4 for being taken relative to the origin, 14 for being laid across the ray.
constexpr double kDoubtUnits = 64;

// Slabs are tested where rays are, in coordinates of their own: the planes of a box are each off by two units of
// rounding of the largest coordinate, which at this many thicknesses is 0.1 % of its width. Thinner ones stay quads.
constexpr double kMostThicknesses = 4096;

// reach: the largest coordinate of points that rays start from (rayReach).
bool isThickEnough(const FoundBox& box, double reach) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if ((box.high[axis] - box.low[axis]) * kMostThicknesses < reach) return false;
  }
  return true;
}

PrimitiveKind kindOf(const PrimitiveRecord<double>& primitive) { return static_cast<PrimitiveKind>(primitive.kind); }

// The dual basis of (e1, e2) in the plane: u . e1 = 1, u . e2 = 0; both are 0 at p0.
struct DualBasis {
  D3 u, v;
  double uOffset, vOffset;
};
DualBasis dualBasis(const PrimitiveRecord<double>& primitive) {
  const D3 e1 = vec(primitive.e1), e2 = vec(primitive.e2), n = vec(primitive.normal), p0 = vec(primitive.p0);
  const D3 acrossU = cross(e2, n), acrossV = cross(n, e1);
  const D3 u = acrossU * (1 / dot(e1, acrossU)), v = acrossV * (1 / dot(e2, acrossV));
  return {u, v, -dot(u, p0), -dot(v, p0)};
}

FaceCoordinates inFloat(const DualBasis& basis) {
  FaceCoordinates coordinates;
  assign(coordinates.uAxis, basis.u);
  assign(coordinates.vAxis, basis.v);
  coordinates.uOffset = static_cast<float>(basis.uOffset);
  coordinates.vOffset = static_cast<float>(basis.vOffset);
  return coordinates;
}

}  // namespace

SmallScene::SmallScene(const PrimitiveRecord<double>* primitives, size_t count, const Box& origins) {
  const auto ofKind = [&](PrimitiveKind kind) {
    return static_cast<uint32_t>(
        std::count_if(primitives, primitives + count, [kind](const auto& p) { return kindOf(p) == kind; }));
  };
  // Primitives are sorted by kind: quads, triangles, spheres.
  view_.firstTriangle = ofKind(PrimitiveKind::quad);
  const uint32_t triangles = ofKind(PrimitiveKind::triangle);
  view_.firstSphere = view_.firstTriangle + triangles;
  view_.sphereCount = ofKind(PrimitiveKind::sphere);
  if (count == 0) return;

  // Leaves decide the rays that pass too close to an edge for the loops over planes.
  LeafMaker leaves(PrimitiveSource::of(primitives, count), inTurn);
  addLeaves(leaves);
  std::vector<Box> bounds;
  for (const Pieces* pieces : {&leaves.faces(), &leaves.spheres()}) {
    for (const Piece& piece : *pieces) bounds.push_back(piece.box());
  }
  const double reach = rayReach(unionOf(bounds.data(), bounds.size()), origins);

  // Quads that bound boxes, closed boxes first; those too thin for a ray's rounding errors stay single quads.
  std::vector<bool> taken(count, false);
  const auto take = [&taken](uint32_t face) { taken[face] = true; };
  const std::vector<FoundBox> boxes = findBoxes(primitives, view_.firstTriangle, triangles);
  for (const bool open : {false, true}) {
    for (const FoundBox& box : boxes) {
      if (box.open() != open || !isThickEnough(box, reach)) continue;
      ++(open ? view_.openBoxCount : view_.closedBoxCount);
      addBox(box);
      box.forEachQuad(take);
    }
  }
  // Faces that bound other convex solids.
  for (const FoundSolid& solid : findSolids(primitives, view_.firstTriangle, triangles, taken)) {
    if (solid.thickness * kMostThicknesses < reach) continue;
    addSolid(solid);
    solid.forEachFace(take);
  }
  for (uint32_t i = 0; i < view_.firstSphere; ++i) {
    // The remaining quads and triangles as planes; every face has coordinates for its u and v.
    coordinates_.push_back(inFloat(dualBasis(primitives[i])));
    if (taken[i]) continue;
    addPlane(primitives[i], i, reach);
    ++(i < view_.firstTriangle ? view_.quadCount : view_.triangleCount);
  }
  // All spheres.
  for (size_t i = view_.firstSphere; i < count; ++i) {
    SphereForm& sphere = spheres_.emplace_back();
    assign(sphere.center, vec(primitives[i].p0));
    sphere.radius = static_cast<float>(primitives[i].e1[0]);
  }
  // The view, now that the arrays no longer grow.
  view_.boxes = boxes_.data();
  view_.solids = solids_.data();
  view_.sides = sides_.data();
  view_.solidCount = static_cast<uint32_t>(solids_.size());
  view_.planes = planes_.data();
  view_.limits = limits_.data();
  view_.coordinates = coordinates_.data();
  view_.spheres = spheres_.data();
}

void SmallScene::addLeaves(LeafMaker& leaves) {
  // Four pieces to a leaf, in the order of the primitives.
  const auto pack = [](const Pieces& pieces, const auto& addLeaf) {
    std::vector<uint32_t> ids;
    for (const Piece& piece : pieces) ids.push_back(piece.id);
    for (size_t i = 0; i < ids.size(); i += kLeafSize) addLeaf(ids.data() + i, std::min(kLeafSize, ids.size() - i));
  };
  pack(leaves.faces(), [&](const uint32_t* ids, size_t count) { faceLeaves_.push_back(leaves.faceLeaf(ids, count)); });
  pack(leaves.spheres(),
       [&](const uint32_t* ids, size_t count) { sphereLeaves_.push_back(leaves.sphereLeaf(ids, count)); });
  view_.faceLeaves = faceLeaves_.data();
  view_.faceLeafCount = static_cast<uint32_t>(faceLeaves_.size());
  view_.sphereLeaves = sphereLeaves_.data();
  view_.sphereLeafCount = static_cast<uint32_t>(sphereLeaves_.size());
}

void SmallScene::addBox(const FoundBox& box) {
  BoxForm& form = boxes_.emplace_back();
  for (size_t axis = 0; axis < 3; ++axis) {
    SlabForm& slab = form.slabs[axis];
    assign(slab.normal, box.normal[axis]);
    slab.low = static_cast<float>(box.low[axis]);
    slab.high = static_cast<float>(box.high[axis]);
    std::copy_n(box.quad[axis], 2, form.primitives[axis]);
  }
}

void SmallScene::addSolid(const FoundSolid& solid) {
  SolidForm& form = solids_.emplace_back(SolidForm{});
  const auto add = [&](uint32_t& counter, auto belongs) {
    for (const SolidPlane& plane : solid.planes) {
      if (!belongs(plane)) continue;
      ++counter;
      SidePlane& side = sides_.emplace_back();
      assign(side.normal, plane.normal);
      side.distance = static_cast<float>(plane.distance);
      assign(side.separator, plane.separator);
      side.separatorOffset = static_cast<float>(plane.separatorOffset);
      side.face = plane.face;
      side.other = plane.other;
    }
  };
  // The order of sides is that of SolidForm.
  add(form.single, [](const SolidPlane& plane) { return !plane.open() && !plane.shared(); });
  add(form.shared, [](const SolidPlane& plane) { return plane.shared(); });
  add(form.open, [](const SolidPlane& plane) { return plane.open(); });
}

void SmallScene::addPlane(const PrimitiveRecord<double>& primitive, uint32_t index, double reach) {
  const D3 n = vec(primitive.normal);
  const bool quad = kindOf(primitive) == PrimitiveKind::quad;
  // The two maps of PlaneForm: 2 u - 1 and 2 v - 1 of a quad, 1 - u and 1 - v of a triangle.
  DualBasis basis = dualBasis(primitive);
  if (quad) {
    basis = {basis.u * 2, basis.v * 2, basis.uOffset * 2 - 1, basis.vOffset * 2 - 1};
  } else {
    basis = {basis.u * -1, basis.v * -1, 1 - basis.uOffset, 1 - basis.vOffset};
  }
  // The steepest map bounds what an error of the point does to PlaneHit::edge. For triangles 2 - u - v is a third map.
  const double steepest = std::max({length(basis.u), length(basis.v), quad ? 0 : length(basis.u + basis.v)});
  PlaneLimits& limits = limits_.emplace_back();
  limits.primitive = index;
  limits.doubt = static_cast<float>(kDoubtUnits * kUnitRoundoff * reach * steepest);
  PlaneForm& plane = planes_.emplace_back();
  assign(plane.normal, n);
  plane.distance = static_cast<float>(dot(n, vec(primitive.p0)));
  plane.inside = inFloat(basis);
}

}  // namespace wavecrest
