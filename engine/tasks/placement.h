// Where a render's threads run, and over which NUMA nodes the memory that they share is spread. Decided by
// bench/machine/placement.h, carried out by engine/tasks/thread_pins.h.
#pragma once

#include <cstdint>
#include <vector>

namespace wavecrest {

struct Placement {
  std::vector<uint32_t> cpus;   // hardware threads, one for each thread; empty: the system decides
  std::vector<uint32_t> nodes;  // their NUMA nodes, ascending

  bool operator==(const Placement&) const = default;
};

}  // namespace wavecrest
