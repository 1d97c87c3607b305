// The processors that this process may run on: those of its affinity mask, which taskset, launchers and containers set.
//
// std::thread::hardware_concurrency() does not ask the mask with every C library: glibc 2.36 counts the machine's.
#pragma once

#include <cstdint>
#include <vector>

namespace wavecrest {

// Their numbers in ascending order; empty where the system does not tell.
std::vector<uint32_t> processorsOfThisProcess();
// How many they are; at least 1.
uint32_t allowedProcessors();

// The number of threads of a render: `wish`, or if that is 0 one for each of these processors, as `--threads` has by
// default in all commands.
uint32_t threadsOrAll(uint32_t wish);

}  // namespace wavecrest
