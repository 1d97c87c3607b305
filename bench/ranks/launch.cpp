#include "bench/ranks/launch.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "bench/whole_number.h"
#include "engine/tasks/processors.h"

namespace wavecrest {
namespace {

// The number that a variable holds, or nothing.
std::optional<uint32_t> numberIn(const char* text) {
  return text == nullptr ? std::nullopt : wholeNumber<uint32_t>(text);
}

// Which variables hold the number of processes and that of this one among them. The launchers of MPI come before Slurm,
// whose jobs they run in. Slurm's batch script is no step of srun and has no number of tasks of a step.
struct Launcher {
  const char *name, *ranks, *rank;
};
constexpr Launcher kLaunchers[] = {
    {"mpirun", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
    {"mpiexec", "PMI_SIZE", "PMI_RANK"},
    {"srun", "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"},
};

}  // namespace

std::optional<Launch> launchIn(const VariableLookup& variable) {
  const char* const wish = variable(kMpiVariable);
  if (wish != nullptr && std::strcmp(wish, "off") == 0) return std::nullopt;
  for (const Launcher& launcher : kLaunchers) {
    const std::optional<uint32_t> ranks = numberIn(variable(launcher.ranks)), rank = numberIn(variable(launcher.rank));
    if (!ranks || !rank) continue;
    if (*ranks < 2 || *rank >= *ranks) return std::nullopt;
    return Launch{launcher.name, *rank, *ranks};
  }
  return std::nullopt;
}

std::optional<Launch> launchOfThisProcess() {
  return launchIn([](const char* name) -> const char* { return std::getenv(name); });
}

std::string placeOfThisProcess() {
  char host[256] = {};
  gethostname(host, sizeof(host) - 1);
  std::string place = host;
  for (const uint32_t processor : processorsOfThisProcess()) place += " " + std::to_string(processor);
  return place;
}

}  // namespace wavecrest
