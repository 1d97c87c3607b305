// The floating-point mode in which kernels run.
#pragma once

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace wavecrest {

// Denormal numbers count as zero while kernels run: they are far below anything an image can show, and slow.
class FlushToZero {
 public:
  FlushToZero() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); }
  ~FlushToZero() { _mm_setcsr(saved_); }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  unsigned saved_;
};

}  // namespace wavecrest
