// The median of what pilots find: few outliers change nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace wavecrest {

// The upper one of two; 0 of no values.
inline double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace wavecrest
