// The guide of a render: for each cell of the scene the directions in which paths find light.
//
// in: records of directions that camera walks leave (kernels/columns/records.h). out: what kernels draw directions from
// (kernels/columns/guide_view.h). Records are added to integer sums, and fold() turns the sums into the histograms of
// the next block, a pure function of them. METHODS 12.1 to 12.3.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "engine/learn/cell_tree.h"
#include "engine/learn/learned_directions.h"
#include "engine/state/state_stream.h"
#include "kernels/columns/guide_view.h"
#include "kernels/columns/wave.h"

namespace wavecrest {

// What a histogram is proportional to. radiance: the light that comes from a direction, times BSDF and cosine.
// variance: the root of the second moment of that, which also goes where it is noisy (Rath et al. 2020). off: paths are
// those of path tracing. automatic: radiance or off, whichever trials find better (engine/trials/choose_method.h); a
// guide that is made has one of the others.
enum class GuideTarget { automatic, radiance, variance, off };
constexpr std::array<std::string_view, 4> kGuideTargetNames{"auto", "radiance", "variance", "off"};

// What a guide has learned so far, as --stats reports it.
struct GuideStatistics {
  uint64_t folds = 0;
  size_t cells = 0;        // that the scene is divided into,
  size_t taught = 0;       // and of them those with a histogram
  uint64_t records = 0;    // of directions: those of the latest block whole, of each before half as many as of the next
  double guidedShare = 0;  // of the directions that were recorded before the latest fold: how many the guide would draw
  uint64_t saturated = 0;  // sums that held their limit when they were folded
  size_t bytes = 0;
};

class Guide {
 public:
  // bytes: the memory budget. typical: the brightness of a typical pixel, 0 where it is not known; it sets the unit of
  // the integer sums, which is far below it.
  Guide(const double (&center)[3], const double (&halfExtent)[3], GuideTarget target, size_t bytes, double typical);

  const CellTreeView& cellTree() const { return tree_.view(); }
  const GuideView& view() const { return view_; }

  // Adds the records of a walk that is over. Safe from several threads.
  template <class S>
  void gather(const DirectionRecords& records, const Radiance<S>& radiance);

  // From sums to histograms. Nothing may be gathering. Runs on the threads of the current arena.
  void fold();

  GuideStatistics statistics() const;
  LearnedDirections learnedIn(uint32_t cell) const;
  void save(StateWriter& out) const;
  // Throws StateError.
  void restore(StateReader& in);

  // What it holds of a budget of so many bytes.
  static size_t bytesFor(size_t bytes) { return cellsFor(bytes) * bytesOfCell(); }

 private:
  // Sums over the records of a cell.
  struct CellSums {
    uint64_t records = 0;
    // Of what records weigh: times slope where that is positive; times -slope where negative; times slope^2.
    uint64_t up = 0, down = 0, curvature = 0;
    // Visits of recorded vertices, in units of 2^-kVisitBits: a path that survived with probability q counts as 1 / q
    // visits. Over them the squares of values. Nothing is recorded where the direction carries no light (f = 0), behind
    // depth kRecordedDepths, and in iterations that do not gather (engine/learn/blocks.h).
    uint64_t visits = 0, squares = 0;

    // What a half of a cell begins with, and what a block leaves to the next: half of all but the sums of slopes.
    CellSums halved() const { return {.records = records / 2, .visits = visits / 2, .squares = squares / 2}; }
  };
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  template <class T>
  using Zeros = std::unique_ptr<T[], Free>;  // pages that nothing was written to take no memory

  static size_t bytesOfCell();
  static size_t cellsFor(size_t bytes);
  template <class T>
  static Zeros<T> zeros(size_t count);

  void chooseShare(size_t cell);
  void splitCells();
  void makeHistogram(size_t cell);

  CellTree tree_;
  GuideTarget target_;
  double unit_, squareUnit_;  // units in 1, of values and of their squares
  Zeros<uint64_t> binSums_;   // kGuideBins to a cell
  Zeros<CellSums> cellSums_;
  Zeros<uint32_t> bins_;  // the histograms, as kernels read them
  Zeros<float> share_;
  Zeros<float> roots_;  // root mean square of values
  GuideView view_;
  uint64_t folds_ = 0, saturated_ = 0;
  double guidedShare_ = 0;
};

}  // namespace wavecrest
