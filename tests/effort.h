// How much work a test does: all of it where the code runs at speed, less under sanitizers and without optimisation,
// where the same rays would take minutes and prove nothing more.
#pragma once

#include <cstddef>

namespace wavecrest {

#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
inline constexpr bool kFullSpeed = true;
#else
inline constexpr bool kFullSpeed = false;
#endif

constexpr size_t effort(size_t full, size_t reduced) { return kFullSpeed ? full : reduced; }

}  // namespace wavecrest
