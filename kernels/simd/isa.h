// The instruction sets that kernels are compiled for, and which of them this machine can run.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace wavecrest {

// In order of preference, worst first. scalar is the width-1 twin: plain C++, the oracle of the kernel tests.
enum class Isa { scalar, sse4, avx2, avx512 };

constexpr std::array<Isa, 4> kAllIsas{Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512};

// "scalar", "sse4", "avx2" or "avx512": the spelling of --isa.
std::string_view toString(Isa isa);

// The instruction sets that are both compiled into this binary and supported by this CPU and operating system, worst
// first. Throws std::runtime_error where there is none: a build for few instruction sets on another machine.
const std::vector<Isa>& availableIsas();

// The last of availableIsas().
Isa bestIsa();

}  // namespace wavecrest
