// What launchers leave in the environment.
#include "bench/ranks/launch.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <map>

namespace wavecrest {
namespace {

using Variables = std::map<std::string, std::string>;

std::optional<Launch> launchWith(const Variables& variables) {
  return launchIn([&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

void expectLaunch(const Variables& variables, const std::string& by, uint32_t rank, uint32_t ranks) {
  const std::optional<Launch> launch = launchWith(variables);
  ASSERT_TRUE(launch);
  EXPECT_EQ(launch->by, by);
  EXPECT_EQ(launch->rank, rank);
  EXPECT_EQ(launch->ranks, ranks);
}

TEST(LaunchTest, launchersAreTold) {
  expectLaunch({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_RANK", "3"}}, "mpirun", 3, 4);
  expectLaunch({{"PMI_SIZE", "2"}, {"PMI_RANK", "0"}}, "mpiexec", 0, 2);
  expectLaunch({{"SLURM_STEP_NUM_TASKS", "8"}, {"SLURM_PROCID", "7"}}, "srun", 7, 8);
  // mpirun within a step of srun that started it alone.
  expectLaunch({{"OMPI_COMM_WORLD_SIZE", "2"},
                {"OMPI_COMM_WORLD_RANK", "1"},
                {"SLURM_STEP_NUM_TASKS", "1"},
                {"SLURM_PROCID", "0"}},
               "mpirun", 1, 2);
}

TEST(LaunchTest, aloneIsNoLaunch) {
  EXPECT_FALSE(launchWith({}));
  EXPECT_FALSE(launchWith({{"OMPI_COMM_WORLD_SIZE", "1"}, {"OMPI_COMM_WORLD_RANK", "0"}}));
  // A batch script of Slurm: the job may have tasks, but srun has started none.
  EXPECT_FALSE(launchWith({{"SLURM_NTASKS", "8"}, {"SLURM_PROCID", "0"}}));
  EXPECT_FALSE(launchWith({{"PMI_SIZE", "two"}, {"PMI_RANK", "0"}}));
  EXPECT_FALSE(launchWith({{"PMI_SIZE", "2"}, {"PMI_RANK", "2"}}));
  EXPECT_FALSE(launchWith({{"PMI_SIZE", "2"}, {"PMI_RANK", "1"}, {"WAVECREST_MPI", "off"}}));
  EXPECT_TRUE(launchWith({{"PMI_SIZE", "2"}, {"PMI_RANK", "1"}, {"WAVECREST_MPI", "on"}}));
}

TEST(LaunchTest, aPlaceIsTheProcessorsOfTheMask) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  const std::string place = placeOfThisProcess();
  int cpu = 0;
  while (!CPU_ISSET(cpu, &before)) ++cpu;
  CPU_ZERO(&one);
  CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(placeOfThisProcess() == place, CPU_COUNT(&before) == 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

}  // namespace
}  // namespace wavecrest
