// The processor's time-stamp counter: what measuring a stage costs least with.
#pragma once

#include <cstdint>

namespace wavecrest {

uint64_t readTicks();
// The length of a tick, measured once for the process.
double secondsPerTick();

}  // namespace wavecrest
