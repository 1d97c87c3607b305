// Sockets, cores and caches, as hwloc sees them, and which of them this process may use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace wavecrest {

struct Topology {
  uint32_t sockets = 0, numaNodes = 0, cores = 0;
  uint32_t hardwareThreads = 0;                 // of all cores
  uint32_t smt = 0;                             // hardware threads of a core, the most that any has
  uint32_t usableCores = 0, usableThreads = 0;  // that the affinity mask lets this process run on
  std::string affinity;                         // that mask as a list: "0-3,8"
  size_t l2Bytes = 0, l3Bytes = 0;              // of one cache of its level, 0 if there is none
  uint32_t l3Caches = 0;
};

Topology topologyOfThisMachine();

// Of a machine that hwloc makes up from a description such as "package:2 numa:1 core:56 pu:2", for tests.
// affinity: list of hardware threads, or empty for all. Throws std::invalid_argument for what hwloc cannot read.
Topology syntheticTopology(const std::string& description, const std::string& affinity = {});

}  // namespace wavecrest
