#include "bench/machine/energy.h"

#include <string>

#include "bench/machine/system_files.h"

namespace wavecrest {

std::optional<double> packageJoules() {
  double joules = 0;
  bool found = false;
  for (int package = 0;; ++package) {
    const std::string text =
        systemFile("/sys/class/powercap/intel-rapl:" + std::to_string(package) + "/energy_uj");  // also AMD's
    if (text.empty()) break;
    joules += 1e-6 * std::stod(text);
    found = true;
  }
  return found ? std::optional(joules) : std::nullopt;
}

}  // namespace wavecrest
