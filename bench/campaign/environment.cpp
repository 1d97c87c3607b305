#include "bench/campaign/environment.h"

#include <unistd.h>

#include <array>

#include "bench/machine/machine_record.h"
#include "engine/version.h"

namespace wavecrest {

std::map<std::string, std::string> environment(const RenderSettings& settings) {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host = {"unknown"};
  return {{"version", kVersion},
          {"commit", kCommit},
          {"cpu", machineRecord().cpu},
          {"host", host.data()},
          {"isa", std::string(toString(settings.isa))},
          {"threads", std::to_string(settings.threads)}};
}

}  // namespace wavecrest
