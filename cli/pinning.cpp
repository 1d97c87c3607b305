#include "cli/pinning.h"

#include <fmt/format.h>

#include <utility>

#include "bench/machine/placement.h"

namespace wavecrest {

Placement pinnedPlacement(uint32_t threads, ProgressKind kind) {
  PlacementPlan plan = placeOnThisMachine(threads);
  static bool warned = false;
  if (!plan.refusal.empty() && !std::exchange(warned, true)) {
    warn(kind, fmt::format("--pin: {}; threads run where the system puts them", plan.refusal));
  }
  return std::move(plan.placement);
}

}  // namespace wavecrest
