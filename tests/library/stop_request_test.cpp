// A wish to stop a campaign reaches the session that renders, and none that has ended.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

#include "library/stop_watch.h"
#include "tests/library/idle_session.h"

namespace wavecrest {
namespace {

TEST(StopRequest, reachesTheSessionThatIsWatchedAndLaterOnes) {
  IdleSession first, second, after;
  api::StopRequest stop;
  api::StopWatch::watch(stop, &first);
  EXPECT_FALSE(first.interrupted());
  stop.request();
  EXPECT_TRUE(first.interrupted());
  api::StopWatch::watch(stop, &second);
  EXPECT_TRUE(second.interrupted());
  api::StopWatch::watch(stop, nullptr);
  stop.request();
  EXPECT_FALSE(after.interrupted());
}

// What the thread sanitizer reads: an interrupt() of a session that has ended is a race with its end.
TEST(StopRequest, noRequestHoldsASessionThatIsWatchedNoMore) {
  api::StopRequest stop;
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done.load()) stop.request();
  });
  while (!stop.requested()) std::this_thread::yield();
  for (int round = 0; round < 2000; ++round) {
    const auto session = std::make_unique<IdleSession>();
    api::StopWatch::watch(stop, session.get());
    EXPECT_TRUE(session->interrupted());
    std::this_thread::yield();
    api::StopWatch::watch(stop, nullptr);
  }
  done.store(true);
  other.join();
}

}  // namespace
}  // namespace wavecrest
