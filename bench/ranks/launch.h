// Whether a launcher has started this process together with others: what mpirun, mpiexec and srun leave in the
// environment. Known without MPI, so that a program on its own neither needs nor loads it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace wavecrest {

struct Launch {
  std::string by;  // the launcher
  uint32_t rank = 0, ranks = 1;
};

// Set to `off`, each process is on its own, whatever started it.
constexpr const char* kMpiVariable = "WAVECREST_MPI";

// Nothing for a process on its own. variable: the value of an environment variable, or null.
using VariableLookup = std::function<const char*(const char* name)>;
std::optional<Launch> launchIn(const VariableLookup& variable);
// In this process' environment.
std::optional<Launch> launchOfThisProcess();

// The machine and the processors that this process may run on (engine/tasks/processors.h), in words: equal for
// processes that compete for the same ones.
std::string placeOfThisProcess();

}  // namespace wavecrest
