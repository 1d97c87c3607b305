// What a render's seconds are: those that pass, or CPU time.
#pragma once

#include <array>
#include <string_view>

namespace wavecrest {

// cpu: the CPU time of the process over the number of its threads. On a machine of its own it is the same as wall, and
// on a shared one it does not count what other processes took.
enum class ClockKind { wall, cpu };
constexpr std::array<std::string_view, 2> kClockNames{"wall", "cpu"};

}  // namespace wavecrest
