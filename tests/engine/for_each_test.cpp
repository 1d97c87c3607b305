// Turns go round, whether or not all threads come, until the last is over or one fails.
#include "engine/tasks/for_each.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace wavecrest {
namespace {

class TakeTurnsTest : public testing::TestWithParam<size_t> {  // threads that come, of two
 protected:
  static constexpr size_t kThreads = 2;
  const oneapi::tbb::global_control limit_{oneapi::tbb::global_control::max_allowed_parallelism, GetParam()};
  oneapi::tbb::task_arena arena_{kThreads};
};
INSTANTIATE_TEST_SUITE_P(Threads, TakeTurnsTest, testing::Values(1, 2));

TEST_P(TakeTurnsTest, allAreTakenAndNoneTwiceAtATime) {
  std::vector<std::atomic<int>> inTurn(7), turns(7);
  arena_.execute([&] {
    takeTurns(turns.size(), kThreads, [&](size_t i) {
      EXPECT_EQ(inTurn[i]++, 0);
      const bool again = ++turns[i] < 100 * static_cast<int>(i + 1);
      --inTurn[i];
      return again;
    });
  });
  for (size_t i = 0; i < turns.size(); ++i) EXPECT_EQ(turns[i], 100 * static_cast<int>(i + 1)) << i;
}

TEST_P(TakeTurnsTest, anExceptionEndsThemAll) {
  constexpr int kMost = 3000;  // of a millisecond each: more than one that is under way takes to notice
  std::atomic<bool> thrown = false;
  std::atomic<int> after = 0;
  const auto turn = [&](size_t i) {
    if (i == 0) {
      thrown = true;
      throw std::runtime_error("the first turn");
    }
    if (!thrown) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return ++after < kMost;
  };
  arena_.execute([&] { EXPECT_THROW(takeTurns(2, kThreads, turn), std::runtime_error); });
  EXPECT_LT(after, kMost);
}

TEST(TakeTurns, waitForNoThreadThatIsLate) {
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  oneapi::tbb::task_arena arena(2);
  std::vector<int> turns(2);
  const auto turn = [&](size_t i) {
    ++turns[i];
    return turns[0] + turns[1] < 1000;
  };
  arena.execute([&] { takeTurns(turns.size(), 2, turn); });
  EXPECT_GE(std::min(turns[0], turns[1]), 499);
}

}  // namespace
}  // namespace wavecrest
