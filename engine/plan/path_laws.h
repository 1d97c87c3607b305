// Fills the laws of path-space mutations (kernels/mutate/path_law.h) for paths of minEdges to maxEdges edges.
#pragma once

#include <vector>

#include "kernels/mutate/path_law.h"

namespace wavecrest {

// Bootstrap samples, and paths that chains propose anew: of length k + 1 to those of length k.
constexpr double kLengthRatio = 0.85;

class PathLaws {
 public:
  PathLaws() = default;
  PathLaws(uint32_t minEdges, uint32_t maxEdges);
  // The tables. Valid as long as this object, which may be moved.
  PathLaw law() const;
  uint32_t kinds = PathLaw().kinds;

 private:
  void addDeletions(uint32_t edges);

  uint32_t minEdges_ = 1, maxEdges_ = 1;
  std::vector<AliasEntry> deletions_;
  std::vector<uint32_t> ranges_, firstDeletion_;
  std::vector<float> deletionShare_, lengthsUpTo_;
};

}  // namespace wavecrest
