// Every record that stages hand to each other, declared once. S is the storage type of the precision policy: float, or
// double for the `double` policy.
//
// A path is one lane of a wave for its whole life; compaction moves its record forward in the columns, and `lane` keeps
// where it began, which is also where its radiance is summed.
#pragma once

#include "kernels/columns/vertex_details.h"

namespace wavecrest {

constexpr uint32_t kMiss = 0xffffffffu;     // Hits::primitive of a ray that left the scene
constexpr uint32_t kNoIndex = 0xffffffffu;  // an index that leads nowhere

// The front of each live path. Written by generate and scatter: origin and unit direction of the next ray. arrive moves
// the origin to the surface point in place; from there to scatter it is the position of the path's vertex and the
// direction is still that of arrival.
template <class S>
struct Rays : Columns<Rays<S>> {
  Column<S> originX, originY, originZ, directionX, directionY, directionZ;
  auto all() { return std::tie(originX, originY, originZ, directionX, directionY, directionZ); }
};

// Written by extend in ray order, one per ray; compacted by arrive. u, v: coordinates in the primitive
// (kernels/scene_view.h says which).
struct Hits : Columns<Hits> {
  Column<float> u, v;
  Column<uint32_t> primitive;  // kMiss, or an index into SceneView::primitives
  // Index into SceneView::instances, or kNoIndex: the primitive is in the world; dropped where a scene has none.
  Column<uint32_t> instance;
  auto all() { return std::tie(u, v, primitive, instance); }
};

// The vertex under each live path, written by arrive: what its position (in Rays) and primitive (in Hits) do not say.
template <class S>
struct Surfaces : Columns<Surfaces<S>>, VertexDetails<S> {
  Column<S> normalX, normalY, normalZ;  // geometric normal, unit
  Column<S> offset;                     // bound on the position's error along the normal
  auto all() { return std::tuple_cat(std::tie(normalX, normalY, normalZ, offset), this->details()); }
};

// What a path carries along. dVCM and dVC are partial sums of the MIS recursion of Georgiev's technical report
// "Implementing Vertex Connection and Merging" (2012), whose dVM follows from dVC; path tracing needs only dVCM.
template <class S>
struct PathStates : Columns<PathStates<S>> {
  Column<S> throughputR, throughputG, throughputB;
  Column<S> dVCM, dVC;  // dVC: dropped without connections
  // What makes a throughput comparable with 1 in Russian roulette: on camera paths the product of (eta_wo /
  // eta_wi)^2, on light paths the reciprocal of the first throughput. Dropped where it is always 1.
  Column<S> rouletteScale;
  Column<uint32_t> lane;
  Column<uint32_t> light;  // light that a light path began on; dropped without connections
  auto all() { return std::tie(throughputR, throughputG, throughputB, dVCM, dVC, rouletteScale, lane, light); }
};

// Segments whose visibility decides over a contribution. Pushed by nextEvent and the connecting stages, at most as many
// as there are paths; drained by occlude. The direction spans the whole segment: it is blocked iff something is hit at
// t in [0, 1).
template <class S>
struct ShadowRays : Columns<ShadowRays<S>> {
  Column<float> originX, originY, originZ, directionX, directionY, directionZ;
  Column<S> red, green, blue;  // contribution if visible, weight included
  Column<uint32_t> target;     // lane whose radiance it joins; of light walks the pixel
  // Densities of all other strategies, divided by this one's, which its weight was made from; dropped without passages.
  Column<S> others;
  auto all() {
    return std::tie(originX, originY, originZ, directionX, directionY, directionZ, red, green, blue, target, others);
  }
};

// Whether nothing blocks each shadow ray, as 1 or 0. Scratch of occlude in hierarchies, whose walks end in no order;
// dropped without one.
struct Visibility : Columns<Visibility> {
  Column<float> visible;
  auto all() { return std::tie(visible); }
};

// Of rays that have passed a surface: where they are in the wave, and the number that decides whether they pass the
// next one. Scratch of extend and occlude; dropped without passages.
struct PassageMarks : Columns<PassageMarks> {
  Column<uint32_t> index;
  Column<float> number;
  auto all() { return std::tie(index, number); }
};

// Pairs of a camera vertex and a light vertex that connectVertices is about to join. Scratch of one stage call; dropped
// without connections.
struct VertexPairs : Columns<VertexPairs> {
  Column<uint32_t> camera, light;  // light: a link (light_vertices.h); an index in Wave::sortedPairs
  auto all() { return std::tie(camera, light); }
};

// A vertex as joining it with one of the other walk reads it, sixteen numbers in one place, in float one cache line:
// what pairs it with comes to it in no order, again and again.
//   tag: index into SceneView::materials, and for light vertices the edges from the light (kernels/shade/vertex_tag.h)
//   wi: unit direction back along the path
//   dVCM, throughput, dVC: as in PathStates
template <class S>
struct alignas(kColumnAlignment) VertexRow {
  S position[3], offset;
  S wi[3], tag;
  S normal[3], dVCM;
  S throughput[3], dVC;
};
static_assert(sizeof(VertexRow<float>) == 64);

// Rows of the live paths' vertices. Written by the first stage of a depth that joins them (packVertexRows), emptied by
// those that put other vertices into the wave (arrive, takeEnds). Dropped without connections.
template <class S>
struct VertexRows : Columns<VertexRows<S>> {
  Column<VertexRow<S>> row;
  auto all() { return std::tie(row); }
};

// The cell of each live path's vertex (cell_tree.h), in the order of the vertices. Written by findCells; scatter, which
// moves paths, ends it. Dropped where nothing is learned by cell.
struct VertexCells : Columns<VertexCells> {
  Column<uint32_t> cell;
  auto all() { return std::tie(cell); }
};

// Where paths went on from vertices, for a guide to learn from. Pushed by scatter, at most one for each path and depth
// up to kRecordedDepths; read by the engine at the end of the walk, when the path's radiance is known. What the
// direction brought is (luminance of the path's radiance at the end - before) inverseThroughput. Dropped where no guide
// is learned.
constexpr uint32_t kRecordedDepths = 12;
struct DirectionRecords : Columns<DirectionRecords> {
  Column<uint32_t> lane;
  Column<uint32_t> bin;             // of a guide's histogram: cell kGuideBins + bin (guide_view.h)
  Column<float> before;             // luminance of the path's radiance when it went on
  Column<float> inverseThroughput;  // of the luminance of the throughput at the vertex
  Column<float> pdf;                // of the direction, per area of the guide's square; 0: of a delta lobe
  Column<float> slope;              // (density of the BSDF - density of the guide) / density
  Column<float> survival;           // the probability with which the path went on
  Column<float> worth;              // what the vertex is worth to the pixel (guide_view.h); 0 behind the first depth
  auto all() { return std::tie(lane, bin, before, inverseThroughput, pdf, slope, survival, worth); }
};

// Contributions of light walks and of Markov chains on their way to the film. Pushed by occlude and acceptMutations, at
// most one for each path and call; emptied into the film's sums by the engine (addSplats), which does so before a stage
// could overrun the queue. Their order changes no sum. Dropped where a method has none.
template <class S>
struct Splats : Columns<Splats<S>> {
  Column<S> red, green, blue;
  Column<uint32_t> pixel;  // of the rendered rectangle, row by row
  auto all() { return std::tie(red, green, blue, pixel); }
};

// Radiance gathered by each lane of the wave in this iteration.
template <class S>
struct Radiance : Columns<Radiance<S>> {
  Column<S> red, green, blue;
  auto all() { return std::tie(red, green, blue); }
};

}  // namespace wavecrest
