#include "engine/plan/path_laws.h"

#include <algorithm>
#include <cmath>

#include "engine/compile/pick_table.h"

namespace wavecrest {
namespace {

// Preference for deletions by their edges (Veach and Guibas 1997, 5.3.1).
double deletionWeight(uint32_t edges) {
  if (edges == 1) return 0.25;
  if (edges == 2) return 0.5;
  return std::exp2(-static_cast<double>(edges));
}

}  // namespace

PathLaws::PathLaws(uint32_t minEdges, uint32_t maxEdges) : minEdges_(minEdges), maxEdges_(maxEdges) {
  // Make the tables of deletions, one length after the other.
  deletionShare_.resize(size_t{maxEdges + 1} * (maxEdges + 3), 0.0f);
  firstDeletion_.resize(maxEdges + 2, 0);
  for (uint32_t edges = 0; edges <= maxEdges; ++edges) {
    firstDeletion_[edges] = static_cast<uint32_t>(ranges_.size());
    addDeletions(edges);
  }
  firstDeletion_[maxEdges + 1] = static_cast<uint32_t>(ranges_.size());
  // Lengths of paths that are made anew follow a geometric law from minEdges on. The table is cumulative.
  double sum = 0;
  std::vector<double> upTo(maxEdges + 1, 0);
  for (uint32_t edges = 0; edges <= maxEdges; ++edges) {
    if (edges >= minEdges) sum += std::pow(kLengthRatio, edges - minEdges);
    upTo[edges] = sum;
  }
  for (const double value : upTo) lengthsUpTo_.push_back(static_cast<float>(value / sum));
}

// All ranges (l, m) but the whole path, which large steps delete. l = 0 and m = k are left out: next to a pinhole and
// to a light's point that is made anew, l = -1 and m = k + 1 do as much.
void PathLaws::addDeletions(uint32_t edges) {
  if (edges < 2) return;
  // List the ranges as l + 1 and m, and count those that delete m - l edges.
  std::vector<uint32_t> kept;
  std::vector<uint32_t> counts(edges + 3, 0);
  for (uint32_t lightKept = 0; lightKept <= edges; ++lightKept) {
    if (lightKept == 1) continue;
    for (uint32_t eyeFrom = std::max(lightKept, 1u); eyeFrom <= edges + 1; ++eyeFrom) {
      if (eyeFrom == edges || (lightKept == 0 && eyeFrom == edges + 1)) continue;
      kept.push_back(lightKept | eyeFrom << 16);
      ++counts[eyeFrom + 1 - lightKept];
    }
  }
  // Ranges that delete the same number of edges share the preference for that number evenly.
  double sum = 0;
  for (uint32_t deleted = 1; deleted <= edges + 2; ++deleted) sum += counts[deleted] != 0 ? deletionWeight(deleted) : 0;
  std::vector<double> weights;
  for (const uint32_t range : kept) {
    const uint32_t deleted = (range >> 16) + 1 - (range & 0xffffu);
    weights.push_back(deletionWeight(deleted) / sum / counts[deleted]);
  }
  // Entries of the alias table name each other relative to the first deletion of this length. Shares are those of the
  // table; ranges that delete the same number of edges have the same, but for rounding.
  const std::vector<AliasEntry> table = makeAliasTable(weights);
  const std::vector<double> shares =
      sharesOf(table, std::vector<double>(table.size(), 1 / static_cast<double>(table.size())));
  for (size_t i = 0; i < kept.size(); ++i) {
    const uint32_t deleted = (kept[i] >> 16) + 1 - (kept[i] & 0xffffu);
    deletionShare_[size_t{edges} * (maxEdges_ + 3) + deleted] = static_cast<float>(shares[i]);
  }
  deletions_.insert(deletions_.end(), table.begin(), table.end());
  ranges_.insert(ranges_.end(), kept.begin(), kept.end());
}

PathLaw PathLaws::law() const {
  return {.minEdges = minEdges_,
          .maxEdges = maxEdges_,
          .deletions = deletions_.data(),
          .ranges = ranges_.data(),
          .firstDeletion = firstDeletion_.data(),
          .deletionShare = deletionShare_.data(),
          .lengthsUpTo = lengthsUpTo_.data(),
          .kinds = kinds};
}

}  // namespace wavecrest
