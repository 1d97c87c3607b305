// Energy that the processor packages have used, by Intel's and AMD's running average power limit counters.
#pragma once

#include <optional>
#include <string>

namespace wavecrest {

// Joules of all packages together since some moment; the counters wrap around now and then. Nothing where Linux does
// not show them: virtual machines, other processors, or files that only root may read.
std::optional<double> packageJoules(const std::string& powercap = "/sys/class/powercap");

}  // namespace wavecrest
