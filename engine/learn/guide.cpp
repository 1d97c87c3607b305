#include "engine/learn/guide.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/learn/alias_table.h"
#include "engine/learn/integer_sums.h"
#include "engine/scene/vector_math.h"
#include "engine/tasks/for_each.h"

namespace wavecrest {
namespace {

// A value of 2^e, e the exponent of a typical pixel's brightness, has 2^20 units, its square 2^22; a visit has 2^8. So
// kAddendLimit cuts squares of values above 2^14.5 x 2^e, which is 11,600 to 23,200 times the typical brightness, and
// those of values below 2^-11.5 x 2^e round to 0.
constexpr int kUnitBits = 20, kSquareUnitBits = 22, kVisitBits = 8;
// A cell with more records is split, one with fewer than kLeastRecords keeps to the BSDF.
constexpr uint64_t kSplitRecords = 8192, kLeastRecords = 512;
// Before it knows better a cell asks BSDF and guide alike.
constexpr float kFirstShare = 0.5f;
// One block moves a share by at most so much: sums of a block are noisy.
constexpr double kMostStep = 0.2;
constexpr size_t kCellsOfTask = 16;
// Sums are fetched so many records before they are added to.
constexpr size_t kAhead = 12;

// The bin next to (x, y), one step outside of the square at most: over an edge the square goes on at its mirror image
// about the edge's middle.
size_t wrappedBin(int x, int y) {
  constexpr int kLast = kGuideSide - 1;
  if (x < 0 || x > kLast) {
    x = std::clamp(x, 0, kLast);
    y = kLast - y;
  }
  if (y < 0 || y > kLast) {
    y = std::clamp(y, 0, kLast);
    x = kLast - x;
  }
  return static_cast<size_t>(y) * kGuideSide + static_cast<size_t>(x);
}

// Each bin is blended with its neighbours: weights 64, 8 and 1. A lone bright bin keeps 64 % of its weight; its
// neighbours get the rest, so that light on the other side of an edge is found.
std::array<double, kGuideBins> smoothed(const uint64_t* sums) {
  std::array<double, kGuideBins> out{};
  for (int y = 0; y < static_cast<int>(kGuideSide); ++y) {
    for (int x = 0; x < static_cast<int>(kGuideSide); ++x) {
      const auto weightOf = [](int step) { return step == 0 ? 8 : 1; };
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          sum += weightOf(dx) * weightOf(dy) * static_cast<double>(sums[wrappedBin(x + dx, y + dy)]);
        }
      }
      out[static_cast<size_t>(y) * kGuideSide + static_cast<size_t>(x)] = sum;
    }
  }
  return out;
}

template <class S>
double luminanceOf(const Radiance<S>& radiance, uint32_t lane) {
  return luminance({static_cast<double>(radiance.red[lane]), static_cast<double>(radiance.green[lane]),
                    static_cast<double>(radiance.blue[lane])});
}

}  // namespace

size_t Guide::bytesOfCell() {
  return CellTree::bytesOfCell() + sizeof(CellSums) + 2 * sizeof(float) +
         kGuideBins * (sizeof(uint64_t) + sizeof(uint32_t));
}

// Kernels read indices of bins as signed numbers of 32 bits.
size_t Guide::cellsFor(size_t bytes) {
  return std::clamp<size_t>(bytes / bytesOfCell(), kCellRoots, size_t{1} << (31 - kGuideBinBits));
}

template <class T>
Guide::Zeros<T> Guide::zeros(size_t count) {
  auto* const items = static_cast<T*>(std::calloc(count, sizeof(T)));
  if (items == nullptr) throw std::bad_alloc();
  return Zeros<T>(items);
}

Guide::Guide(const double (&center)[3], const double (&halfExtent)[3], GuideTarget target, size_t bytes, double typical)
    : tree_(center, halfExtent, cellsFor(bytes)), target_(target) {
  const int exponent = typical > 0 ? std::ilogb(typical) : 0;
  unit_ = std::ldexp(1.0, kUnitBits - exponent);
  squareUnit_ = std::ldexp(1.0, kSquareUnitBits - 2 * exponent);
  const size_t cells = tree_.mostCells();
  binSums_ = zeros<uint64_t>(cells * kGuideBins);
  cellSums_ = zeros<CellSums>(cells);
  bins_ = zeros<uint32_t>(cells * kGuideBins);
  share_ = zeros<float>(cells);
  roots_ = zeros<float>(cells);
  std::fill_n(share_.get(), tree_.cells(), 1.0f);
  view_ = {.share = share_.get(), .bins = bins_.get(), .roots = roots_.get()};
}

template <class S>
void Guide::gather(const DirectionRecords& records, const Radiance<S>& radiance) {
  const bool squares = target_ == GuideTarget::variance;
  for (size_t i = 0; i < records.size; ++i) {
    if (i + kAhead < records.size) __builtin_prefetch(&binSums_[records.bin[i + kAhead]], 1);
    const uint32_t bin = records.bin[i];
    CellSums& cell = cellSums_[bin >> kGuideBinBits];
    addTo(cell.records, 1);
    // A path that went on stands for those that ended there, too.
    const double survival = static_cast<double>(records.survival[i]);
    addTo(cell.visits, toAddend(std::ldexp(1 / survival, kVisitBits)));
    const double brought = luminanceOf(radiance, records.lane[i]) - static_cast<double>(records.before[i]);
    const double value = brought * static_cast<double>(records.inverseThroughput[i]);
    if (!(value > 0) || !std::isfinite(value)) continue;
    addTo(cell.squares, toAddend(value * value * survival * squareUnit_));
    // The sum of values is the integral of what comes from the bin, that of value^2 density of its square.
    const double pdf = static_cast<double>(records.pdf[i]);
    const double weight = squares ? value * value * squareUnit_ : value * unit_;
    if (pdf > 0) addTo(binSums_[bin], toAddend(squares ? weight * pdf : weight));
    const double slope = static_cast<double>(records.slope[i]);
    if (slope == 0) continue;
    addTo(slope > 0 ? cell.up : cell.down, toAddend(weight * std::abs(slope)));
    addTo(cell.curvature, toAddend(weight * slope * slope));
  }
}
template void Guide::gather(const DirectionRecords&, const Radiance<float>&);
template void Guide::gather(const DirectionRecords&, const Radiance<double>&);

// One step of Newton's method to the share of the BSDF that makes the mixture most like the target: it makes the sum of
// weight times log p(share) greatest, which is a concave function of the share.
void Guide::chooseShare(size_t cell) {
  const CellSums& sums = cellSums_[cell];
  float& share = share_[cell];
  if (sums.curvature == 0 || share >= 1) return;
  const double slope = static_cast<double>(sums.up) - static_cast<double>(sums.down);
  const double step = std::clamp(slope / static_cast<double>(sums.curvature), -kMostStep, kMostStep);
  share = static_cast<float>(
      std::clamp(static_cast<double>(share) + step, double{kLeastBsdfShare}, double{kMostBsdfShare}));
}

// Both halves of a cell begin with half of its sums.
void Guide::splitCells() {
  for (uint32_t cell = 0; cell < tree_.cells(); ++cell) {
    while (cellSums_[cell].records > kSplitRecords && tree_.canSplit(cell)) {
      const uint32_t added = tree_.split(cell);
      cellSums_[cell] = cellSums_[added] = cellSums_[cell].halved();
      share_[added] = share_[cell];
      roots_[added] = roots_[cell];
      uint64_t* const from = &binSums_[cell * size_t{kGuideBins}];
      for (size_t bin = 0; bin < kGuideBins; ++bin) from[bin] /= 2;
      std::copy_n(from, kGuideBins, &binSums_[added * size_t{kGuideBins}]);
    }
  }
  tree_.publish();
}

// The histogram of the cell's sums, of which half are kept for the next one.
void Guide::makeHistogram(size_t cell) {
  CellSums& sums = cellSums_[cell];
  uint64_t* const bins = &binSums_[cell * kGuideBins];
  std::array<double, kGuideBins> weights = smoothed(bins);
  if (target_ == GuideTarget::variance) {
    for (double& weight : weights) weight = std::sqrt(weight);
  }
  const bool any = std::any_of(weights.begin(), weights.end(), [](double weight) { return weight > 0; });
  if (!any || sums.records < kLeastRecords) {
    share_[cell] = 1;
  } else {
    if (share_[cell] >= 1) share_[cell] = kFirstShare;
    makeAliasTable(unitsOf(weights), &bins_[cell * kGuideBins]);
  }
  for (size_t bin = 0; bin < kGuideBins; ++bin) bins[bin] /= 2;
  if (sums.records >= kLeastRecords) {
    const double mean = std::ldexp(static_cast<double>(sums.squares), kVisitBits) / static_cast<double>(sums.visits);
    roots_[cell] = static_cast<float>(std::sqrt(mean / squareUnit_));
  }
  sums = sums.halved();
}

void Guide::fold() {
  // Count, before sums change.
  double guided = 0, all = 0;
  for (size_t cell = 0; cell < tree_.cells(); ++cell) {
    const CellSums& sums = cellSums_[cell];
    const auto records = static_cast<double>(sums.records);
    guided += records * (1 - static_cast<double>(share_[cell]));
    all += records;
    for (const uint64_t sum : {sums.up, sums.down, sums.curvature, sums.squares}) {
      saturated_ += sum >= kSumLimit ? 1 : 0;
    }
    for (size_t bin = 0; bin < kGuideBins; ++bin) saturated_ += binSums_[cell * kGuideBins + bin] >= kSumLimit ? 1 : 0;
  }
  guidedShare_ = all > 0 ? guided / all : 0;
  for (size_t cell = 0; cell < tree_.cells(); ++cell) chooseShare(cell);
  splitCells();
  const size_t cells = tree_.cells();
  forEach((cells + kCellsOfTask - 1) / kCellsOfTask, [&](size_t task) {
    const size_t end = std::min(cells, (task + 1) * kCellsOfTask);
    for (size_t cell = task * kCellsOfTask; cell < end; ++cell) makeHistogram(cell);
  });
  ++folds_;
}

LearnedDirections Guide::learnedIn(uint32_t cell) const {
  LearnedDirections learned{.cell = cell, .cells = tree_.cells(), .guidedShare = 1 - double{share_[cell]}};
  if (learned.guidedShare == 0) return learned;
  for (size_t bin = 0; bin < kGuideBins; ++bin) {
    const auto units = static_cast<float>(GuideBin::of(bins_[cell * size_t{kGuideBins} + bin]).units);
    learned.squareDensity[bin] = units * kGuideDensityOfUnit;
  }
  return learned;
}

GuideStatistics Guide::statistics() const {
  GuideStatistics out{.folds = folds_,
                      .cells = tree_.cells(),
                      .guidedShare = guidedShare_,
                      .saturated = saturated_,
                      .bytes = tree_.mostCells() * bytesOfCell()};
  for (size_t cell = 0; cell < tree_.cells(); ++cell) {
    out.taught += share_[cell] < 1 ? 1 : 0;
    out.records += cellSums_[cell].records;
  }
  return out;
}

void Guide::save(StateWriter& out) const {
  const size_t cells = tree_.cells();
  tree_.save(out);
  out.value(unit_);
  out.value(folds_);
  out.value(saturated_);
  out.value(guidedShare_);
  out.items(binSums_.get(), cells * kGuideBins);
  out.items(cellSums_.get(), cells);
  out.items(bins_.get(), cells * kGuideBins);
  out.items(share_.get(), cells);
  out.items(roots_.get(), cells);
}

void Guide::restore(StateReader& in) {
  tree_.restore(in);
  if (in.value<double>() != unit_) throw StateError("what it has learned is in other units");
  folds_ = in.value<uint64_t>();
  saturated_ = in.value<uint64_t>();
  guidedShare_ = in.value<double>();
  const size_t cells = tree_.cells();
  in.items(binSums_.get(), cells * kGuideBins);
  in.items(cellSums_.get(), cells);
  in.items(bins_.get(), cells * kGuideBins);
  in.items(share_.get(), cells);
  in.items(roots_.get(), cells);
  for (size_t cell = 0; cell < cells; ++cell) {
    const bool taught = share_[cell] < 1;
    const bool sound = share_[cell] >= kLeastBsdfShare && share_[cell] <= 1 && roots_[cell] >= 0 &&
                       std::isfinite(roots_[cell]) && (!taught || isAliasTable(&bins_[cell * size_t{kGuideBins}]));
    if (!sound) {
      throw StateError("what it has learned is damaged");
    }
  }
}

}  // namespace wavecrest
