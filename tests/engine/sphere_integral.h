// Integrals over all directions.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace wavecrest {

// Of f(unit direction) over solid angle, by the midpoints of so many rows of equal angles from +y, and twice as many
// columns.
template <class F>
double sphereIntegral(int rows, const F& f) {
  double integral = 0;
  for (int row = 0; row < rows; ++row) {
    const double theta = (row + 0.5) / rows * std::numbers::pi;
    for (int column = 0; column < 2 * rows; ++column) {
      const double phi = (column + 0.5) / rows * std::numbers::pi;
      const std::array<double, 3> direction{std::sin(theta) * std::cos(phi), std::cos(theta),
                                            std::sin(theta) * std::sin(phi)};
      integral += f(direction) * std::sin(theta) * std::pow(std::numbers::pi / rows, 2);
    }
  }
  return integral;
}

}  // namespace wavecrest
