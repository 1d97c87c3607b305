// The laws by which mutations of paths choose what to delete and how much to put in its place (METHODS 7.6), as tables
// that a render fills once (engine/plan/path_laws.h).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/scene_view.h"

namespace wavecrest {

// Vertices added beyond those deleted: half of the time as many, seldom many more or fewer (Veach and Guibas 1997).
constexpr int kMostAdded = 6;
constexpr std::array<float, 2 * kMostAdded + 1> kAddedLaw{
    0.003125f, 0.00625f, 0.0125f, 0.025f, 0.05f, 0.15f, 0.5f, 0.15f, 0.05f, 0.025f, 0.0125f, 0.00625f, 0.003125f};

struct PathLaw {
  uint32_t minEdges = 1, maxEdges = 1;  // of the chains' paths
  // Deletions (l, m) of paths of k edges: entries [firstDeletion[k], firstDeletion[k + 1]) of an alias table, and what
  // they delete, l + 1 in the lower half and m in the upper.
  const AliasEntry* deletions = nullptr;
  const uint32_t* ranges = nullptr;
  const uint32_t* firstDeletion = nullptr;
  // Probability of each deletion of m - l edges from a path of k: [k * deletionStride() + m - l].
  const float* deletionShare = nullptr;
  // Probability of lengths up to k, from k = 0, of paths that are made anew.
  const float* lengthsUpTo = nullptr;
  // Bits of what is proposed besides large steps: each kind by itself leaves the distribution of paths as it is.
  static constexpr uint32_t kFromEye = 1, kBidirectional = 2, kCaustic = 4;
  uint32_t kinds = kFromEye | kBidirectional | kCaustic;

  uint32_t deletionStride() const { return maxEdges + 3; }
};

// Block of a step's random numbers (ChainUse::step) that chooses the pixel among those whose filters reach a path;
// proposePaths uses blocks 0 and 1.
constexpr uint32_t kPixelBlock = 2;
// The one that decides which surfaces the edge between both walks passes.
constexpr uint32_t kPassageBlock = 3;

// Raster perturbations: offsets between these, in pixels, the logarithm of the offset being uniform. The larger circle
// has a twentieth of the image's area.
constexpr double kLensSmallest = 0.1, kLensShare = 0.05;
// Angles of multi-chain perturbations, in radians: 0.0001 to 0.1 degrees.
constexpr double kAngleSmallest = 1.7453293e-6, kAngleLargest = 1.7453293e-3;
// No caustic perturbation turns further than this.
constexpr double kAngleLimit = 1.5;

}  // namespace wavecrest
