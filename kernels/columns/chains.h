// Markov chains of Metropolis light transport: one chain to a lane of a wave.
#pragma once

#include <array>

#include "kernels/columns/chain_paths.h"
#include "kernels/columns/wave.h"
#include "kernels/sampling/sampler.h"

namespace wavecrest {

// The state of each chain, and what its proposal of the step under way is about to be. Written by proposeMutations, by
// stages of the walks, and by acceptMutations; `source` and `length` by the engine.
struct Chains : Columns<Chains> {
  // Where the chain is.
  Column<float> red, green, blue;   // contribution over its luminance
  Column<float> target;             // luminance of the contribution; 0: nowhere yet
  Column<float> weight;             // expected visits that are not on the film yet
  Column<uint32_t> pixel;           // of the film's rectangle, row by row
  Column<uint32_t> cameraVertices;  // vertices whose numbers its path used
  Column<uint32_t> lightVertices;   // the same of the light walk
  Column<uint32_t> rejections;      // in a row, up to now
  Column<uint32_t> length;          // edges of its paths, where that is fixed
  // What it proposes.
  Column<uint32_t> source;      // ChainSamples::source
  Column<uint32_t> cameraLive;  // ChainSamples::live
  Column<uint32_t> lightLive;
  Column<float> threshold;  // accepted where the ratio of targets exceeds it
  Column<float> scale;      // factor of the contribution
  Column<float> estimate;   // of b, by a large step in path space; elsewhere that is the contribution's luminance
  Column<uint32_t> proposedPixel;
  Column<uint32_t> proposedCamera;  // vertices of the walks used so far
  Column<uint32_t> proposedLight;
  // Of multiplexed chains: how far the walks go.
  Column<uint32_t> cameraEdges, lightEdges;
  Column<uint32_t> lightGranted;   // lightEdges once there is something to join with, before that 0
  Column<uint32_t> emissionDepth;  // vertex at which emission counts; 0: none
  auto all() {
    return std::tie(red, green, blue, target, weight, pixel, cameraVertices, lightVertices, rejections, length, source,
                    cameraLive, lightLive, threshold, scale, estimate, proposedPixel, proposedCamera, proposedLight,
                    cameraEdges, lightEdges, lightGranted, emissionDepth);
  }
};

// A chain that has rejected so many proposals in a row counts as stuck. In epochs of fewer steps none does: with the
// default bootstrap from about 21,000 chains on (epochSteps).
constexpr uint32_t kStuckRejections = 100;

// What acceptMutations counts.
struct ChainCounters {
  // By Mutation.
  std::array<uint64_t, kMutationKinds> proposed{}, accepted{};
  uint64_t dark = 0;       // proposals without light
  uint64_t nonFinite = 0;  // proposals whose contribution was no number; never accepted
  uint64_t longestRejection = 0;
  uint64_t stuck = 0;  // runs of rejections that reached kStuckRejections

  ChainCounters& operator+=(const ChainCounters& other) {
    for (size_t kind = 0; kind < kMutationKinds; ++kind) {
      proposed[kind] += other.proposed[kind];
      accepted[kind] += other.accepted[kind];
    }
    dark += other.dark;
    nonFinite += other.nonFinite;
    stuck += other.stuck;
    longestRejection = longestRejection > other.longestRejection ? longestRejection : other.longestRejection;
    return *this;
  }
  uint64_t proposedOf(Mutation kind) const { return proposed[static_cast<size_t>(kind)]; }
  uint64_t acceptedOf(Mutation kind) const { return accepted[static_cast<size_t>(kind)]; }
};

// What large steps say about b, by the length of the paths that a chain is bound to; 0 where it is bound to none. Each
// is an independent sample, whether it is accepted or not (METHODS 7.3).
struct LargeStepSums {
  static constexpr size_t kLengths = 65;
  std::array<uint64_t, kLengths> count{};
  std::array<double, kLengths> sum{}, squares{};

  void add(size_t length, double estimate) {
    ++count[length];
    sum[length] += estimate;
    squares[length] += estimate * estimate;
  }
  LargeStepSums& operator+=(const LargeStepSums& other) {
    for (size_t i = 0; i < kLengths; ++i) {
      count[i] += other.count[i];
      sum[i] += other.sum[i];
      squares[i] += other.squares[i];
    }
    return *this;
  }
};

// The chains of one wave. kept: which blocks of each walk, and of how many vertices, have current numbers; a walk
// without any has none. Movable only.
struct ChainState {
  Chains columns;
  ChainSamples samples;
  ChainCounters counters;
  LargeStepSums largeSteps;
  bool multiplexed = false;  // walks stop where their strategy says
  float splatFactor = 1;     // of everything that goes to the film

  struct Kept {
    ChainBlocks blocks[2];   // camera walk, light walk
    uint32_t vertices[2]{};  // 0: the walk keeps nothing
  };

  ChainState(size_t capacity, const Kept& kept) {
    samples.blocks[0] = kept.blocks[0];
    samples.blocks[1] = kept.blocks[1];
    samples.firstColumn[1] = columnsOf(kept, 0);
    samples.stride = paddedItems(capacity);
    arena_ = Arena(bytesFor(capacity, kept));
    columns.bind(arena_, capacity);
    if (valuesOf(capacity, kept) != 0) samples.values = arena_.take<uint32_t>(valuesOf(capacity, kept));
    samples.source = columns.source;
    samples.live[0] = columns.cameraLive;
    samples.live[1] = columns.lightLive;
    bytes_ = bytesFor(capacity, kept);
  }

  // Columns of numbers that chains keep: those of the light walk follow those of the camera walk.
  static uint32_t columnsOf(const Kept& kept) { return columnsOf(kept, 0) + columnsOf(kept, 1); }
  // Memory of so many chains.
  static size_t bytesFor(size_t capacity, const Kept& kept) {
    return Chains().bytes(capacity) + valuesOf(capacity, kept) * sizeof(uint32_t) + kColumnAlignment;
  }
  size_t bytes() const { return bytes_; }

 private:
  // Columns of numbers that a walk keeps: that of the first block past its last vertex is their number.
  static uint32_t columnsOf(const Kept& kept, size_t walk) {
    if (kept.vertices[walk] == 0) return 0;
    ChainSamples layout;
    layout.blocks[walk] = kept.blocks[walk];
    return layout.column(walk, 4 * kept.vertices[walk]);
  }
  static size_t valuesOf(size_t capacity, const Kept& kept) {
    return size_t{4} * columnsOf(kept) * paddedItems(capacity);
  }

  size_t bytes_ = 0;
  Arena arena_;
};

// Vertices at which the walks of multiplexed chains end, gathered over all depths: at most one to a lane and walk.
// Contributions made here are those of the main wave, whose radiance they share.
template <class S>
struct WalkEnds {
  Wave<S> atOrigin;        // joined with the other walk's origin: a light, or the lens
  Wave<S> cameraAtVertex;  // joined with a vertex of the light walk
  Wave<S> lightAtVertex;

  WalkEnds(size_t capacity, const ColumnNeeds& needs, const Wave<S>& main)
      : atOrigin(capacity, needs), cameraAtVertex(capacity, needs), lightAtVertex(capacity, needs) {
    for (Wave<S>* wave : {&atOrigin, &cameraAtVertex, &lightAtVertex}) wave->radiance = main.radiance;
  }
  Wave<S>& atVertex(bool cameraWalk) { return cameraWalk ? cameraAtVertex : lightAtVertex; }
};

}  // namespace wavecrest
