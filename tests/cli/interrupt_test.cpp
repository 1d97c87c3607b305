// Signals that come to another thread at the moment when a session begins or ends to be watched.
#include "cli/interrupt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/tasks/processors.h"
#include "engine/tasks/thread_pins.h"
#include "tests/library/idle_session.h"

namespace wavecrest {
namespace {

constexpr int kRounds = 2000;

// A thread that sends a signal to itself each time that it is told to. It has a processor of its own where there are
// two, so that its handler runs beside the thread that tells it.
class SignalsAside {
 public:
  explicit SignalsAside(int signal) {
    const std::vector<uint32_t> processors = processorsOfThisProcess();
    thread_ = std::thread([this, signal, last = processors.back()] {
      bindThread(last);
      run(signal);
    });
    bindThread(processors.front());
  }
  ~SignalsAside() {
    told_.store(-1);
    thread_.join();
  }
  SignalsAside(const SignalsAside&) = delete;
  SignalsAside& operator=(const SignalsAside&) = delete;
  // Returns a moment before the signal comes, so that half of them are handled before waitUntilHandled() begins.
  void send() {
    told_.fetch_add(1);
    for (std::atomic<int> left{delay_}; left.load() > 0;) left.fetch_sub(1);
  }
  void waitUntilHandled() {
    delay_ = std::clamp(delay_ + (isHandled() ? -kStep : kStep), 0, kLongestDelay);
    while (!isHandled()) std::this_thread::yield();
  }

 private:
  void run(int signal) {
    unsigned looks = 0;
    for (int told = 0; told >= 0; told = told_.load()) {
      if (told == handled_.load()) {
        // A thread that yields each time would begin too late.
        if (++looks % 4096 == 0) std::this_thread::yield();
        continue;
      }
      raise(signal);
      handled_.store(told);
    }
  }
  bool isHandled() const { return handled_.load() == told_.load(); }

  static constexpr int kStep = 16, kLongestDelay = 20000;  // the latter some tens of microseconds
  int delay_ = 0;
  std::atomic<int> told_{0}, handled_{0};
  std::thread thread_;
};

TEST(InterruptGuard, aStopReachesASessionThatIsJustBeingWatched) {
  SignalsAside signals(SIGTERM);
  int lost = 0;
  for (int round = 0; round < kRounds; ++round) {
    InterruptGuard guard("");
    guard.setIdle(false);
    IdleSession session;
    signals.send();
    {
      const SessionWatch watch(guard, session);
      signals.waitUntilHandled();
      lost += session.interrupted() ? 0 : 1;
    }
  }
  EXPECT_EQ(lost, 0);
}

TEST(InterruptGuard, aSessionThatIsWatchedNoMoreIsLeftAlone) {
  SignalsAside signals(SIGUSR1);
  InterruptGuard guard("");
  int late = 0;
  for (int round = 0; round < kRounds; ++round) {
    IdleSession session;
    {
      const SessionWatch watch(guard, session);
      signals.send();
    }
    session.resume();
    signals.waitUntilHandled();
    late += session.interrupted() ? 1 : 0;
    guard.takeSaveRequest();
  }
  EXPECT_EQ(late, 0);
}

TEST(InterruptGuard, hangupsThatAreIgnoredStayIgnored) {
  struct sigaction ignored {
  }, before{}, now{};
  ignored.sa_handler = SIG_IGN;
  ASSERT_EQ(sigaction(SIGHUP, &ignored, &before), 0);
  {
    const InterruptGuard guard("");
    sigaction(SIGHUP, nullptr, &now);
    EXPECT_EQ(now.sa_handler, SIG_IGN);
  }
  sigaction(SIGHUP, &before, nullptr);
}

}  // namespace
}  // namespace wavecrest
