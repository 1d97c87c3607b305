// How much work a test does: all of it where the code runs at speed, less under sanitizers and without optimisation,
// where the same rays would take minutes and prove nothing more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace wavecrest {

#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
inline constexpr bool kFullSpeed = true;
#else
inline constexpr bool kFullSpeed = false;
#endif

constexpr size_t effort(size_t full, size_t reduced) { return kFullSpeed ? full : reduced; }

// How many rays, draws or renders a statistical test takes: all with WAVECREST_THOROUGH in the environment
// (`./check --steps thorough`), else a quarter of them, which sees biases of twice the size.
inline size_t samples(size_t full, size_t reduced) {
  static const bool thorough = std::getenv("WAVECREST_THOROUGH") != nullptr;
  return effort(thorough ? full : std::max(full / 4, reduced), reduced);
}

}  // namespace wavecrest
