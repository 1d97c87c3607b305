// Arguments of rounded functions that give a wanted result to the bit: what to write so that reading gives the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wavecrest {

// About a multiple of a unit vector, at most 1 + 256 * step times as long, of which `normalize` makes that vector. The
// vector itself if it is one, or if none is found: rounding then changes a last bit.
template <class Number, class Normalize>
std::array<Number, 3> unitPreimage(const std::array<Number, 3>& unit, Number step, Normalize normalize) {
  for (int i = 0; i <= 256; ++i) {
    const Number scale = 1 + static_cast<Number>(i) * step;
    std::array<Number, 3> candidate{scale * unit[0], scale * unit[1], scale * unit[2]};
    for (int nudges = 0; nudges < 4; ++nudges) {
      const std::array<Number, 3> result = normalize(candidate);
      if (result == unit) return candidate;
      for (size_t c = 0; c < 3; ++c) {
        if (result[c] != unit[c])
          candidate[c] = std::nextafter(candidate[c], candidate[c] + (unit[c] - result[c]) * 16);
      }
    }
  }
  return unit;
}

// An x with f(x) == target, where f adds numbers to x and rounds after each step, or the nearest one found.
template <class Function>
double sumPreimage(double target, Function f) {
  const double offset = f(0.0), guess = target - offset;
  const double largest = std::max({std::abs(target), std::abs(offset), std::abs(guess)});
  const double step = 0.25 * largest * std::numeric_limits<double>::epsilon();
  for (int i = 0; i <= 16; ++i) {
    for (const double x : {guess + i * step, guess - i * step}) {
      if (f(x) == target) return x;
    }
  }
  return guess;
}

// An x with f(x) == target, where f multiplies x and rounds.
template <class Function>
double productPreimage(double target, Function f) {
  const double guess = target / f(1.0);
  for (int i = -4; i <= 4; ++i) {
    const double x = guess * (1 + i * 0.5 * std::numeric_limits<double>::epsilon());
    if (f(x) == target) return x;
  }
  return guess;
}

}  // namespace wavecrest
