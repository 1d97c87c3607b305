#include "bench/machine/energy.h"

#include "bench/machine/system_files.h"

namespace wavecrest {

std::optional<double> packageJoules(const std::string& powercap) {
  double joules = 0;
  bool found = false;
  for (int zone = 0;; ++zone) {
    const std::string folder = powercap + "/intel-rapl:" + std::to_string(zone);  // also AMD's
    const std::string name = systemFile(folder + "/name");
    if (name.empty()) break;
    // Another zone of this level is psys, the whole board with the packages in it.
    if (!name.starts_with("package")) continue;
    const std::string text = systemFile(folder + "/energy_uj");
    if (text.empty()) return std::nullopt;
    joules += 1e-6 * std::stod(text);
    found = true;
  }
  return found ? std::optional(joules) : std::nullopt;
}

}  // namespace wavecrest
