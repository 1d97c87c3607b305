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

// Threads of a render: as many as wished, or where that is 0 one for each of these processors. The default of
// `--threads` of all commands.
uint32_t threadsOrAll(uint32_t wish);

}  // namespace wavecrest
