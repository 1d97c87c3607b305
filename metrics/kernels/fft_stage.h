// One stage of a batch of 16 Fourier transforms that run side by side, one in each lane.
//
// Layout of a batch: element k of all 16 transforms is 32 floats at 32 k, first the real parts, then the imaginary
// ones. A stage is Stockham's self-sorting step with decimation in frequency (see Van Loan, Computational Frameworks
// for the Fast Fourier Transform, 1992, section 1.7): with sub-transforms of `length` = radix * m and `stride` of them
// done,
//   out[q + stride (radix p + k)] = w^(p k) sum_j in[q + stride (p + m j)] e^(-2 pi i j k / radix),  w = e^(-2 pi i /
//   length)
// for 0 <= p < m, 0 <= q < stride. Swapping real and imaginary parts of input and output gives the inverse transform.
#pragma once

#include <cstddef>
#include <vector>

namespace wavecrest {

constexpr size_t kFftBatch = 16;
constexpr size_t kFftElement = 2 * kFftBatch;  // floats per element

enum class FftDirection { forward, inverse };

struct FftStage {
  size_t radix, m, stride;
  std::vector<float> twiddles;  // w^(p k) for k = 1..radix-1, as re, im pairs, for each p
  std::vector<float> roots;     // e^(-2 pi i j / radix) as re, im pairs: for radices without a kernel of their own
};

}  // namespace wavecrest
