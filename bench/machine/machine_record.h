// What figures have to say about the machine they come from.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/machine/topology.h"

namespace wavecrest {

struct MachineRecord {
  std::string cpu;  // its name
  Topology topology;
  std::optional<double> cpuLimit;  // cores' worth of time that the control group allows, where it limits it
  std::string governor;            // of the clock rate; "unknown" where the kernel does not tell
  double mhz = 0;                  // measured
  std::string hugePages;           // transparent ones: always, madvise, never or unknown
  std::vector<std::string> flags;
  std::array<double, 3> load{};  // average number of running programs over 1, 5 and 15 minutes
};

// Read once in each process, at the first call.
const MachineRecord& machineRecord();

// Keys of the `machine` object in stats and in bench's JSON.
nlohmann::ordered_json toJson(const MachineRecord& machine);

}  // namespace wavecrest
