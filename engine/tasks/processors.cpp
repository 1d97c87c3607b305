#include "engine/tasks/processors.h"

#include <sched.h>

#include <algorithm>
#include <cstddef>

namespace wavecrest {

std::vector<uint32_t> processorsOfThisProcess() {
  std::vector<uint32_t> processors;
  // Masks grow with the machine: the call fails until there is room for all of its processors.
  for (int most = CPU_SETSIZE; most <= 1 << 20; most *= 4) {
    cpu_set_t* const set = CPU_ALLOC(static_cast<size_t>(most));
    if (set == nullptr) break;
    const size_t bytes = CPU_ALLOC_SIZE(static_cast<size_t>(most));
    const bool known = sched_getaffinity(0, bytes, set) == 0;
    for (int processor = 0; known && processor < most; ++processor) {
      if (CPU_ISSET_S(static_cast<size_t>(processor), bytes, set))
        processors.push_back(static_cast<uint32_t>(processor));
    }
    CPU_FREE(set);
    if (known) break;
  }
  return processors;
}

uint32_t allowedProcessors() { return std::max(1u, static_cast<uint32_t>(processorsOfThisProcess().size())); }

uint32_t threadsOrAll(uint32_t wish) { return wish != 0 ? wish : allowedProcessors(); }

}  // namespace wavecrest
