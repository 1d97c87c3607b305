// The generator matrices of the third and fourth Sobol dimension, for 2^32 points, computed from their primitive
// polynomials.
//
// A column is kept with its bits reversed (the first binary digit of the number is bit 0), the order in which the
// scrambling hash of sobol_lanes.h works. Initial numbers: Joe and Kuo, "Constructing Sobol Sequences with Better
// Two-Dimensional Projections", 2008.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace wavecrest {

// The sequence of one path starts over with fresh scrambles after 2^20 points: enough for any image, and each bit less
// saves work in every call.
constexpr uint32_t kPathSetBits = 20;

constexpr size_t kSobolBits = 32;
using SobolColumns = std::array<uint32_t, kSobolBits>;

// Column j of the matrix is m_j 2^-(j+1); m follows the recurrence of the polynomial x^degree + ... + 1, whose inner
// coefficients are the bits of `inner` (Sobol 1967; Bratley and Fox 1988, eq. 4).
constexpr SobolColumns sobolColumns(size_t degree, uint32_t inner, std::array<uint32_t, 3> initial) {
  SobolColumns m{};
  SobolColumns reversed{};
  for (size_t j = 0; j < kSobolBits; ++j) {
    if (j < degree) {
      m[j] = initial[j];
    } else {
      m[j] = m[j - degree] ^ (m[j - degree] << degree);
      for (size_t k = 1; k < degree; ++k) {
        if ((inner >> (degree - 1 - k) & 1) != 0) m[j] ^= m[j - k] << k;
      }
    }
    for (size_t digit = 0; digit <= j; ++digit) reversed[j] |= (m[j] >> (j - digit) & 1) << digit;
  }
  return reversed;
}

// Dimension 0 is the identity (van der Corput); dimension 1 is Pascal's triangle, which sobol_lanes.h evaluates by
// shifts.
inline constexpr SobolColumns kSobolDimension2 = sobolColumns(2, 1, {1, 3, 0});
inline constexpr SobolColumns kSobolDimension3 = sobolColumns(3, 1, {1, 3, 1});

}  // namespace wavecrest
