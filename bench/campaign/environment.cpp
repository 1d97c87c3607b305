#include "bench/campaign/environment.h"

#include <unistd.h>

#include <array>
#include <fstream>

#include "engine/version.h"

namespace wavecrest {

std::string cpuName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::map<std::string, std::string> environment(const RenderSettings& settings) {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host = {"unknown"};
  return {{"version", kVersion},
          {"commit", kCommit},
          {"cpu", cpuName()},
          {"host", host.data()},
          {"isa", std::string(toString(settings.isa))},
          {"threads", std::to_string(settings.threads)}};
}

}  // namespace wavecrest
