// A busy machine is noticed, a quiet one is not doubted.
#include "bench/machine/machine_watch.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/machine/machine_record.h"

namespace wavecrest {
namespace {

TEST(MachineWatch, aQuietMachineRaisesNoDoubt) {
  EXPECT_TRUE(doubtsAbout({.seconds = 1, .othersCores = 0.03, .stolenCores = 0, .slowestMhz = 2990, .fastestMhz = 3000})
                  .empty());
  EXPECT_TRUE(doubtsAbout({.seconds = 1, .othersCores = {}, .stolenCores = {}}).empty());
}

TEST(MachineWatch, neighboursTheHypervisorAndTheClockAreNamed) {
  const auto doubts =
      doubtsAbout({.seconds = 1, .othersCores = 1.25, .stolenCores = 0.5, .slowestMhz = 2000, .fastestMhz = 3000});
  ASSERT_EQ(doubts.size(), 3u);
  EXPECT_NE(doubts[0].find("1.25 cores"), std::string::npos);
  EXPECT_NE(doubts[1].find("steal"), std::string::npos);
  EXPECT_NE(doubts[2].find("2000 to 3000 MHz"), std::string::npos);
}

// All hardware threads are kept busy by this process: what is left for others is what it did not get.
TEST(MachineWatch, ownWorkIsNotThatOfOthers) {
  const MachineWatch watch;
  const clock_t begin = clock();
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(400);
  std::vector<std::jthread> threads;
  const uint32_t count = machineRecord().topology.hardwareThreads;
  for (uint32_t i = 0; i < count; ++i) {
    threads.emplace_back([end] {
      while (std::chrono::steady_clock::now() < end) {
      }
    });
  }
  threads.clear();
  const MachineState state = watch.state();
  if (!state.othersCores) GTEST_SKIP() << "this kernel does not count CPU time";
  const double own = static_cast<double>(clock() - begin) / CLOCKS_PER_SEC / state.seconds;
  EXPECT_LE(*state.othersCores, count - own + 0.3);  // the kernel counts in steps of 10 ms
}

// The same of children, one for each hardware thread.
TEST(MachineWatch, workOfChildrenIsNotThatOfOthers) {
  const uint32_t count = machineRecord().topology.hardwareThreads;
  const MachineWatch watch;
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(400);
  for (uint32_t i = 0; i < count; ++i) {
    if (fork() != 0) continue;
    while (std::chrono::steady_clock::now() < end) {
    }
    _exit(0);
  }
  double own = 0;
  for (rusage usage{}; wait4(-1, nullptr, 0, &usage) > 0;) {
    own += static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
  }
  const MachineState state = watch.state();
  if (!state.othersCores) GTEST_SKIP() << "this kernel does not count CPU time";
  EXPECT_LE(*state.othersCores, count - own / state.seconds + 0.3);
}

}  // namespace
}  // namespace wavecrest
