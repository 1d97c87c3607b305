#include "bench/machine/system_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

namespace wavecrest {

std::string systemFile(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::optional<CpuTimes> parseProcStat(std::string_view text, double ticksPerSecond) {
  std::istringstream in{std::string(text)};
  std::string word;
  // user, nice, system, idle, iowait, irq, softirq, steal; guests' time is in user already.
  std::array<double, 8> ticks{};
  if (!(in >> word) || word != "cpu") return std::nullopt;
  for (double& count : ticks) {
    if (!(in >> count)) return std::nullopt;
  }
  const double busy = ticks[0] + ticks[1] + ticks[2] + ticks[5] + ticks[6];
  return CpuTimes{.busy = busy / ticksPerSecond, .steal = ticks[7] / ticksPerSecond};
}

std::optional<double> parseCpuMax(std::string_view text) {
  std::istringstream in{std::string(text)};
  double quota = 0, period = 0;
  if (!(in >> quota >> period) || quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

std::optional<double> leastCpuMax(std::string_view ownGroups,
                                  const std::function<std::string(const std::string&)>& read) {
  // The line "0::/path" is that of version 2. Without it the root stands for the group.
  std::istringstream in{std::string(ownGroups)};
  std::string group;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("0::/") && line != "0::/") group = line.substr(3);
  }
  // The group and its parents. The root's path is empty.
  std::optional<double> least;
  for (;; group.erase(group.rfind('/'))) {
    const std::optional<double> limit = parseCpuMax(read("/sys/fs/cgroup" + group + "/cpu.max"));
    if (limit) least = std::min(*limit, least.value_or(*limit));
    if (group.empty()) return least;
  }
}

std::string chosenWord(std::string_view text) {
  const size_t open = text.find('['), close = text.find(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return {};
  return std::string(text.substr(open + 1, close - open - 1));
}

std::string cpuInfoValue(std::string_view text, std::string_view key) {
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with(key)) continue;
    if (line.find_first_not_of(" \t", key.size()) != colon) continue;  // a longer key
    const size_t begin = line.find_first_not_of(' ', colon + 1);
    return begin == std::string::npos ? std::string() : line.substr(begin);
  }
  return {};
}

std::string cpuName(std::string_view text) {
  std::string name = cpuInfoValue(text, "model name");
  if (name.empty()) return "unknown";
  const std::string family = cpuInfoValue(text, "cpu family"), model = cpuInfoValue(text, "model");
  if (name.find_first_of("0123456789") == std::string::npos && !family.empty() && !model.empty()) {
    name += " (family " + family + ", model " + model + ")";
  }
  return name;
}

std::vector<std::string> relevantFlags(std::string_view flags) {
  constexpr std::array<std::string_view, 14> kRelevant{
      "sse4_2",   "avx",      "avx2",     "fma",         "f16c",        "bmi2",     "avx512f",
      "avx512dq", "avx512bw", "avx512vl", "avx512_vnni", "avx512_fp16", "amx_tile", "hypervisor"};
  const std::string all = " " + std::string(flags) + " ";
  std::vector<std::string> found;
  for (const std::string_view flag : kRelevant) {
    if (all.find(" " + std::string(flag) + " ") != std::string::npos) found.emplace_back(flag);
  }
  return found;
}

}  // namespace wavecrest
