#include "metrics/cvvdp/pyramid.h"

#include <algorithm>
#include <array>
#include <span>

namespace wavecrest::cvvdp {
namespace {

constexpr std::array<float, 5> kFilter{0.05f, 0.25f, 0.4f, 0.25f, 0.05f};
// Expansion puts a zero after every sample, so all taps are doubled. Even rows meet samples at taps 0, 2 and 4, odd
// rows at taps 1 and 3.
constexpr std::array<float, 3> kEvenRows{0.1f, 0.8f, 0.1f};
constexpr std::array<float, 2> kOddRows{0.5f, 0.5f};

// Reflection beyond the edge sample, which is repeated.
size_t repeatedMirror(std::ptrdiff_t index, size_t length) {
  const auto count = static_cast<std::ptrdiff_t>(length);
  if (index < 0) index = -1 - index;
  if (index >= count) index = 2 * count - 1 - index;
  return static_cast<size_t>(index);
}

// The sum of rows of one width times their weights.
void weightedRow(const MetricKernels& kernels, std::span<const float* const> rows, std::span<const float> weights,
                 float* out, size_t width) {
  const float* weightList[] = {weights.data()};
  float* outputs[] = {out};
  kernels.weightedSum({.sources = rows.data(),
                       .count = rows.size(),
                       .weights = weightList,
                       .outputs = 1,
                       .out = outputs,
                       .width = width});
}

}  // namespace

Halving::Columns::Columns(size_t tapCount, size_t width)
    : taps(tapCount), stride(roundUpToLanes(width)), indices(taps * stride), weights(taps * stride) {}

// Adds a weight to a tap. Reflected taps fall on taps inside the row, which then have both weights.
void Halving::Columns::set(size_t tap, size_t column, size_t index, double weight) {
  indices[tap * stride + column] = static_cast<uint32_t>(index);
  weights[tap * stride + column] += static_cast<float>(weight);
}

GatheredSum Halving::Columns::job(const float* in, float* out) const {
  return {.in = in, .indices = indices.data(), .weights = weights.data(), .taps = taps, .stride = stride, .out = out};
}

Halving::Halving(PlaneSize fine) : fine_(fine), reducing_(reducingColumns(fine)), expanding_(expandingColumns(fine)) {}

// Five taps along the row for each column of the half size.
Halving::Columns Halving::reducingColumns(PlaneSize fine) {
  const size_t width = fine.width, outputs = (width + 1) / 2;
  Columns columns(kFilter.size(), outputs);
  for (size_t x = 0; x < outputs; ++x) {
    // Taps inside the row; one beyond its left edge is reflected and falls on another tap.
    for (size_t tap = 0; tap < kFilter.size(); ++tap) {
      const auto at = static_cast<std::ptrdiff_t>(2 * x + tap) - 2;
      if (at >= static_cast<std::ptrdiff_t>(width)) continue;
      const size_t index = repeatedMirror(at, width);
      columns.set(index + 2 - 2 * x, x, index, double{kFilter[tap]});
    }
  }
  // At the right edge the original asks whether the number of rows is odd, where columns were meant. Where one of the
  // two is odd, the last column differs from a reflection. Kept, as the scores of such sizes depend on it.
  const size_t last = outputs - 1, centre = 2 * last;
  if (fine.height % 2 == 1) {
    columns.set(width - 1 + 2 - centre, last, width - 1, double{kFilter[3]});
    columns.set(width - 2 + 2 - centre, last, width - 2, double{kFilter[4]});
  } else {
    columns.set(width - 1 + 2 - centre, last, width - 1, double{kFilter[4]});
  }
  return columns;
}

// Three taps for even columns, two for odd ones. Columns beyond the edge are the edge column.
Halving::Columns Halving::expandingColumns(PlaneSize fine) {
  const size_t coarseWidth = (fine.width + 1) / 2;
  Columns columns(kEvenRows.size(), fine.width);
  for (size_t x = 0; x < fine.width; ++x) {
    const size_t middle = x / 2, right = std::min(middle + 1, coarseWidth - 1);
    if (x % 2 == 0) {
      columns.set(0, x, middle > 0 ? middle - 1 : 0, double{kEvenRows[0]});
      columns.set(1, x, middle, double{kEvenRows[1]});
      columns.set(2, x, right, double{kEvenRows[2]});
    } else {
      columns.set(0, x, middle, double{kOddRows[0]});
      columns.set(1, x, right, double{kOddRows[1]});
    }
  }
  return columns;
}

// Down the columns into scratch, then along the row.
void Halving::reduceRow(const MetricKernels& kernels, const Plane& fine, size_t y, float* scratch, float* out) const {
  std::array<const float*, kFilter.size()> rows{};
  for (size_t tap = 0; tap < rows.size(); ++tap)
    rows[tap] = fine.row(repeatedMirror(static_cast<std::ptrdiff_t>(2 * y + tap) - 2, fine_.height));
  weightedRow(kernels, rows, kFilter, scratch, fine_.width);
  kernels.gatheredSum(reducing_.job(scratch, out));
}

// Down the columns into scratch, then along the row. Rows beyond the edge are the edge row.
void Halving::expandRow(const MetricKernels& kernels, const Plane& coarse, size_t y, float* scratch, float* out) const {
  const size_t middle = y / 2, below = std::min(middle + 1, coarse.height() - 1);
  if (y % 2 == 0) {
    const std::array rows{coarse.row(middle > 0 ? middle - 1 : 0), coarse.row(middle), coarse.row(below)};
    weightedRow(kernels, rows, kEvenRows, scratch, coarse.width());
  } else {
    const std::array rows{coarse.row(middle), coarse.row(below)};
    weightedRow(kernels, rows, kOddRows, scratch, coarse.width());
  }
  kernels.gatheredSum(expanding_.job(scratch, out));
}

}  // namespace wavecrest::cvvdp
