// What else the machine did while something was measured: a busy machine makes figures that are too low, and says so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/machine/system_files.h"

namespace wavecrest {

struct MachineState {
  double seconds = 0;                     // of the measurement, wall time
  std::optional<double> othersCores;      // cores that other programs kept busy, on average; where Linux tells
  std::optional<double> stolenCores;      // cores that a hypervisor gave to other machines
  double slowestMhz = 0, fastestMhz = 0;  // of this core, looked at now and then
};

class MachineWatch {
 public:
  MachineWatch();
  // Looks at the clock rate; call it between measurements. Takes a few milliseconds.
  void look();
  // From the beginning until now.
  MachineState state() const;

 private:
  double begin_ = 0, ownBegin_ = 0;
  std::optional<CpuTimes> timesBegin_;
  double slowest_ = 0, fastest_ = 0;
};

// Why figures that were measured meanwhile deserve doubt, a sentence each; none on a quiet machine.
std::vector<std::string> doubtsAbout(const MachineState& state);

}  // namespace wavecrest
