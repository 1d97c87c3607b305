// Finds and loads the library that speaks MPI (mpi_plugin.h). It lies beside the program in a build folder, and in
// lib/wavecrest where the program is installed.
#pragma once

#include <stdexcept>

#include "bench/ranks/mpi_plugin.h"

namespace wavecrest {

// Processes that cannot work together, or that one of them has left. The text is complete.
struct RanksError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The functions of the library, which stays loaded. Throws RanksError where there is none.
const MpiFunctions& loadMpi();

}  // namespace wavecrest
