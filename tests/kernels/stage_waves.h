// Waves for the tests of stages: poisoned tails and comparison column by column.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/columns/wave.h"

namespace wavecrest {

// Calls function(name, queue of a, queue of b) for every queue of two waves.
template <class S, class Function>
void forEachQueue(Wave<S>& a, Wave<S>& b, Function&& function) {
  function("rays", a.rays, b.rays);
  function("hits", a.hits, b.hits);
  function("surfaces", a.surfaces, b.surfaces);
  function("paths", a.paths, b.paths);
  function("shadowRays", a.shadowRays, b.shadowRays);
  function("pairs", a.pairs, b.pairs);
  function("sortedPairs", a.sortedPairs, b.sortedPairs);
  function("radiance", a.radiance, b.radiance);
}

// Calls function(index, column of a, column of b) for every column that is not dropped.
template <class Queue, class Function>
void forEachColumn(Queue& a, Queue& b, Function&& function) {
  auto columnsA = a.all();
  auto columnsB = b.all();
  [&]<size_t... kIndex>(std::index_sequence<kIndex...>) {
    const auto visit = [&](size_t index, auto& x, auto& y) {
      if (x.needed()) function(index, x, y);
    };
    (visit(kIndex, std::get<kIndex>(columnsA), std::get<kIndex>(columnsB)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(columnsA)>>());
}

template <class T>
T* items(Column<T>& column) {
  return column;
}

// Fills everything past the size of each queue with values that show when they are used: NaN, and indices that lead
// nowhere.
template <class S>
void poisonTails(Wave<S>& wave) {
  forEachQueue(wave, wave, [](const char*, auto& queue, auto&) {
    forEachColumn(queue, queue, [&](size_t, auto& column, auto&) {
      using T = std::remove_pointer_t<decltype(items(column))>;
      const T poison = std::is_integral_v<T> ? static_cast<T>(0xffffffffu) : std::numeric_limits<T>::quiet_NaN();
      std::fill(items(column) + queue.size, items(column) + paddedItems(queue.capacity()), poison);
    });
  });
}

// Size of a typical item of each column, in the order of forEachQueue: what absolute errors are measured against. NaN
// for a column that holds nothing but poison, because no stage has written it.
using ColumnScales = std::vector<double>;
template <class S>
ColumnScales columnScales(Wave<S>& wave) {
  ColumnScales scales;
  forEachQueue(wave, wave, [&](const char*, auto& queue, auto&) {
    forEachColumn(queue, queue, [&](size_t, auto& column, auto&) {
      std::vector<double> sizes;
      for (size_t i = 0; i < queue.size; ++i) {
        const auto size = std::abs(static_cast<double>(items(column)[i]));
        if (size == size) sizes.push_back(size);
      }
      if (sizes.empty()) {
        scales.push_back(queue.size == 0 ? 0 : std::numeric_limits<double>::quiet_NaN());
        return;
      }
      const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
      std::nth_element(sizes.begin(), middle, sizes.end());
      scales.push_back(*middle);
    });
  });
  return scales;
}

// Equal sizes, equal integers, and numbers that differ by at most `ulps` units of rounding of their own size plus that
// of a typical item (sums that cancel keep the error of their terms).
template <class S>
void expectSameWave(Wave<S>& expected, Wave<S>& actual, const ColumnScales& scales, double ulps,
                    const std::string& where) {
  size_t scale = 0;
  forEachQueue(expected, actual, [&](const char* name, auto& want, auto& got) {
    EXPECT_EQ(want.size, got.size) << where << ": " << name;
    if (want.size != got.size) return;
    forEachColumn(want, got, [&](size_t index, auto& x, auto& y) {
      using T = std::remove_pointer_t<decltype(items(x))>;
      const double typical = scales[scale++];
      if (std::isnan(typical)) return;
      for (size_t i = 0; i < want.size; ++i) {
        const T a = items(x)[i], b = items(y)[i];
        if constexpr (std::is_integral_v<T>) {
          ASSERT_EQ(a, b) << where << ": " << name << " column " << index << " item " << i;
        } else {
          const double unit = std::numeric_limits<T>::epsilon() / 2;
          const double tolerance = ulps * unit * (std::abs(static_cast<double>(a)) + typical);
          ASSERT_NEAR(a, b, tolerance) << where << ": " << name << " column " << index << " item " << i;
        }
      }
    });
  });
}

}  // namespace wavecrest
