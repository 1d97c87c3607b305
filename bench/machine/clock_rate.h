// The clock rate of the core that the calling thread runs on, measured: files tell what a core may do, not what it
// does.
#pragma once

namespace wavecrest {

// Takes a few milliseconds. From a chain of dependent 64-bit multiplications, three cycles each on x86-64 cores of
// Intel since 2008 and of AMD since 2017; elsewhere the figure is proportional to the clock, which suffices to see
// it change.
double measuredMhz();

}  // namespace wavecrest
