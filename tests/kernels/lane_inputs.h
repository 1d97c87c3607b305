// Numbers that lane operations are tried on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace wavecrest {

// Values around the ones that rounding, signs and comparisons stumble over, then random ones of all sizes.
template <class T>
std::vector<T> realInputs(size_t count, unsigned seed) {
  std::vector<T> values{T(0.5), T(-0.5), T(1.5), T(-2.5), T(2), T(-2),        T(0.49999997),
                        T(7),   T(-7),   T(1),   T(1),    T(3), T(1048575.5), T(-1048576.5)};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<T> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-40, 40);
  while (values.size() < count) values.push_back(std::ldexp(mantissa(random), exponent(random)));
  std::shuffle(values.begin(), values.end(), random);
  return values;
}

inline std::vector<uint32_t> uintInputs(size_t count, unsigned seed) {
  std::vector<uint32_t> values{0, 0, 1, 1, 2, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff, 0xffffffff};
  std::mt19937 random(seed);
  while (values.size() < count) values.push_back(static_cast<uint32_t>(random()));
  std::shuffle(values.begin(), values.end(), random);
  return values;
}

}  // namespace wavecrest
