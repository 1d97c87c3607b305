#include "bench/machine/machine_record.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/machine/clock_rate.h"
#include "bench/machine/system_files.h"

namespace wavecrest {
namespace {

std::string orUnknown(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.empty() ? "unknown" : text;
}

MachineRecord readMachine() {
  const std::string info = systemFile("/proc/cpuinfo");
  MachineRecord machine{.cpu = cpuName(info),
                        .topology = topologyOfThisMachine(),
                        .cpuLimit = leastCpuMax(systemFile("/proc/self/cgroup"), systemFile),
                        .governor = orUnknown(systemFile("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")),
                        .mhz = measuredMhz(),
                        .hugePages = orUnknown(chosenWord(systemFile("/sys/kernel/mm/transparent_hugepage/enabled"))),
                        .flags = relevantFlags(cpuInfoValue(info, "flags"))};
  if (getloadavg(machine.load.data(), 3) != 3) machine.load = {};
  return machine;
}

}  // namespace

const MachineRecord& machineRecord() {
  static const MachineRecord kMachine = readMachine();
  return kMachine;
}

nlohmann::ordered_json toJson(const MachineRecord& machine) {
  const Topology& t = machine.topology;
  nlohmann::ordered_json json = {{"cpu", machine.cpu},
                                 {"sockets", t.sockets},
                                 {"numa_nodes", t.numaNodes},
                                 {"cores", t.cores},
                                 {"smt", t.smt},
                                 {"hardware_threads", t.hardwareThreads},
                                 {"usable_cores", t.usableCores},
                                 {"usable_threads", t.usableThreads},
                                 {"affinity", t.affinity},
                                 {"cpu_limit", nullptr},
                                 {"l2_bytes", t.l2Bytes},
                                 {"l3_bytes", t.l3Bytes},
                                 {"l3_caches", t.l3Caches},
                                 {"governor", machine.governor},
                                 {"mhz", machine.mhz},
                                 {"huge_pages", machine.hugePages},
                                 {"flags", machine.flags},
                                 {"load", machine.load}};
  if (machine.cpuLimit) json["cpu_limit"] = *machine.cpuLimit;
  return json;
}

}  // namespace wavecrest
