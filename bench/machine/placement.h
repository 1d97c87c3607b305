// Which hardware threads a render's threads are bound to: a function of the machine's topology and nothing else.
//
// Each thread gets a core of its own while there are cores; only then do two share one. Threads go to as few NUMA nodes
// as have enough cores, so that memory is near. They are dealt evenly to these nodes, as far as their cores allow, so
// that bandwidth is used evenly. Only hardware threads that the affinity mask and the control group allow are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/tasks/placement.h"

namespace wavecrest {

struct HardwareThread {
  uint32_t cpu = 0;   // the system's number
  uint32_t core = 0;  // numbered over the machine
  uint32_t node = 0;  // the system's number of the NUMA node
};

// The hardware threads that this process may use: of this machine, or of a synthetic one (see syntheticTopology).
std::vector<HardwareThread> usableHardwareThreads();
std::vector<HardwareThread> syntheticHardwareThreads(const std::string& description, const std::string& affinity = {});

// Where threads cannot be bound, the placement is empty and `refusal` says why in one line.
struct PlacementPlan {
  Placement placement;
  std::string refusal;
};
PlacementPlan placeThreads(std::vector<HardwareThread> usable, uint32_t threads);

// The threads first, first + 1, ... of a placement on these hardware threads, with the nodes of their own.
Placement partOf(const Placement& whole, const std::vector<HardwareThread>& usable, size_t first, size_t count);

// On this machine; refuses also where the system forbids to bind threads.
PlacementPlan placeOnThisMachine(uint32_t threads);

}  // namespace wavecrest
