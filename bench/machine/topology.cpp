#include "bench/machine/topology.h"

#include <hwloc.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "bench/machine/placement.h"

namespace wavecrest {
namespace {

struct DestroyTopology {
  void operator()(hwloc_topology_t topology) const { hwloc_topology_destroy(topology); }
};
struct FreeBitmap {
  void operator()(hwloc_bitmap_t bitmap) const { hwloc_bitmap_free(bitmap); }
};
using TopologyHandle = std::unique_ptr<hwloc_topology, DestroyTopology>;
using Bitmap = std::unique_ptr<hwloc_bitmap_s, FreeBitmap>;

// Number of objects of a type. hwloc says -1 for a type on several levels, which counts as none.
uint32_t countOf(const TopologyHandle& topology, hwloc_obj_type_t type) {
  return static_cast<uint32_t>(std::max(hwloc_get_nbobjs_by_type(topology.get(), type), 0));
}

// Size of the first cache of a type; 0 if there is none.
size_t cacheBytes(const TopologyHandle& topology, hwloc_obj_type_t type) {
  const hwloc_obj_t cache = hwloc_get_obj_by_type(topology.get(), type, 0);
  return cache == nullptr ? 0 : cache->attr->cache.size;
}

// Hardware threads as a list of ranges: "0-3,8".
std::string listOf(const Bitmap& bitmap) {
  char* text = nullptr;
  if (hwloc_bitmap_list_asprintf(&text, bitmap.get()) < 0) return {};
  const std::unique_ptr<char, decltype(&std::free)> owner(text, &std::free);
  return text;
}

// Everything is read from a loaded topology and the set of hardware threads that may be used.
Topology describe(const TopologyHandle& topology, const Bitmap& usable) {
  Topology result{.sockets = countOf(topology, HWLOC_OBJ_PACKAGE),
                  .numaNodes = countOf(topology, HWLOC_OBJ_NUMANODE),
                  .cores = countOf(topology, HWLOC_OBJ_CORE),
                  .hardwareThreads = countOf(topology, HWLOC_OBJ_PU),
                  .affinity = listOf(usable),
                  .l2Bytes = cacheBytes(topology, HWLOC_OBJ_L2CACHE),
                  .l3Bytes = cacheBytes(topology, HWLOC_OBJ_L3CACHE),
                  .l3Caches = countOf(topology, HWLOC_OBJ_L3CACHE)};
  result.usableThreads = static_cast<uint32_t>(std::max(hwloc_bitmap_weight(usable.get()), 0));
  // A core is usable if one of its hardware threads is.
  for (hwloc_obj_t core = nullptr;
       (core = hwloc_get_next_obj_by_type(topology.get(), HWLOC_OBJ_CORE, core)) != nullptr;) {
    result.smt = std::max(result.smt, static_cast<uint32_t>(hwloc_bitmap_weight(core->cpuset)));
    if (hwloc_bitmap_intersects(core->cpuset, usable.get()) != 0) ++result.usableCores;
  }
  return result;
}

// A topology that is not loaded yet, for flags or a description.
TopologyHandle makeTopology() {
  hwloc_topology_t raw = nullptr;
  if (hwloc_topology_init(&raw) != 0) throw std::runtime_error("hwloc cannot start");
  return TopologyHandle(raw);
}

// A topology and the hardware threads in it that may be used.
struct Machine {
  TopologyHandle topology;
  Bitmap usable;
};

Machine thisMachine() {
  TopologyHandle topology = makeTopology();
  // What a container hides is part of the machine all the same; the affinity mask says what may be used.
  hwloc_topology_set_flags(topology.get(), HWLOC_TOPOLOGY_FLAG_INCLUDE_DISALLOWED);
  if (hwloc_topology_load(topology.get()) != 0) throw std::runtime_error("hwloc cannot read this machine's topology");
  Bitmap usable(hwloc_bitmap_alloc());
  // Without an affinity mask, all is usable that the system allows.
  if (hwloc_get_cpubind(topology.get(), usable.get(), HWLOC_CPUBIND_PROCESS) != 0) {
    hwloc_bitmap_copy(usable.get(), hwloc_topology_get_allowed_cpuset(topology.get()));
  }
  return {std::move(topology), std::move(usable)};
}

Machine syntheticMachine(const std::string& description, const std::string& affinity) {
  TopologyHandle topology = makeTopology();
  if (hwloc_topology_set_synthetic(topology.get(), description.c_str()) != 0 ||
      hwloc_topology_load(topology.get()) != 0) {
    throw std::invalid_argument("not a topology: " + description);
  }
  Bitmap usable(hwloc_bitmap_dup(hwloc_topology_get_topology_cpuset(topology.get())));
  if (!affinity.empty()) {
    const Bitmap asked(hwloc_bitmap_alloc());
    if (hwloc_bitmap_list_sscanf(asked.get(), affinity.c_str()) != 0) {
      throw std::invalid_argument("not a list of hardware threads: " + affinity);
    }
    // A mask may name hardware threads that the machine does not have.
    hwloc_bitmap_and(usable.get(), usable.get(), asked.get());
  }
  return {std::move(topology), std::move(usable)};
}

// The usable hardware threads, in hwloc's order.
std::vector<HardwareThread> hardwareThreads(const Machine& machine) {
  std::vector<HardwareThread> threads;
  hwloc_obj_t unit = nullptr;
  while ((unit = hwloc_get_next_obj_by_type(machine.topology.get(), HWLOC_OBJ_PU, unit)) != nullptr) {
    if (hwloc_bitmap_isset(machine.usable.get(), unit->os_index) == 0) continue;
    // Where hwloc knows no cores, each hardware thread counts as a core. Without nodes, all are on node 0.
    const hwloc_obj_t core = hwloc_get_ancestor_obj_by_type(machine.topology.get(), HWLOC_OBJ_CORE, unit);
    const int node = hwloc_bitmap_first(unit->nodeset);
    threads.push_back({.cpu = unit->os_index,
                       .core = core == nullptr ? unit->logical_index : core->logical_index,
                       .node = static_cast<uint32_t>(std::max(node, 0))});
  }
  return threads;
}

}  // namespace

Topology topologyOfThisMachine() {
  const Machine machine = thisMachine();
  return describe(machine.topology, machine.usable);
}
Topology syntheticTopology(const std::string& description, const std::string& affinity) {
  const Machine machine = syntheticMachine(description, affinity);
  return describe(machine.topology, machine.usable);
}

std::vector<HardwareThread> usableHardwareThreads() { return hardwareThreads(thisMachine()); }
std::vector<HardwareThread> syntheticHardwareThreads(const std::string& description, const std::string& affinity) {
  return hardwareThreads(syntheticMachine(description, affinity));
}

}  // namespace wavecrest
