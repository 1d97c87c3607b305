// The text files in which Linux tells about itself, read: pure functions of their text, for tests without a machine.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

// The file's text, or empty where it cannot be read.
std::string systemFile(const std::string& path);

// CPU seconds since the machine started, over all cores: the first line of /proc/stat.
struct CpuTimes {
  double busy = 0;   // of this machine's own programs, idle and waiting left out
  double steal = 0;  // that a hypervisor gave to others although this machine had work
};
std::optional<CpuTimes> parseProcStat(std::string_view text, double ticksPerSecond);

// How many cores' worth of time a control group may use: cpu.max of version 2, "max 100000" or "150000 100000".
std::optional<double> parseCpuMax(std::string_view text);

// The least of what the control group of version 2 that /proc/self/cgroup names and its parents may use; nothing where
// none is limited. read: systemFile, or a substitute.
std::optional<double> leastCpuMax(std::string_view ownGroups,
                                  const std::function<std::string(const std::string&)>& read);

// The chosen word of a list such as "always [madvise] never"; empty if none is in brackets.
std::string chosenWord(std::string_view text);

// The values of a key in the first block of /proc/cpuinfo; empty if it is missing.
std::string cpuInfoValue(std::string_view text, std::string_view key);

// What /proc/cpuinfo says that the processor is, or "unknown". Hypervisors leave no more than "AMD EPYC" of a name:
// where it has no digit, family and model follow, which tell Zen 4 from Zen 5.
std::string cpuName(std::string_view text);

// Those of a CPU's flags that kernels could make use of, in a fixed order, and "hypervisor".
std::vector<std::string> relevantFlags(std::string_view flags);

}  // namespace wavecrest
