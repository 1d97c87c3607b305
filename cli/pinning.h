// --pin: threads bound to cores, for commands that render.
#pragma once

#include <cstdint>

#include "cli/progress.h"
#include "engine/tasks/placement.h"

namespace wavecrest {

// The placement of so many threads on this machine. Where they cannot be bound it is empty; the first such call in a
// process gives a warning.
Placement pinnedPlacement(uint32_t threads, ProgressKind kind);

}  // namespace wavecrest
