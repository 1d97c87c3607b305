// The mailbox' thread, with an MPI of one process that is not there.
#include "bench/ranks/mailbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <new>
#include <thread>

namespace wavecrest {
namespace {

int startAlone(int* rank, int* ranks) {
  *rank = 0;
  *ranks = 1;
  return 0;
}
int sendNothing(int /*to*/, const void* /*bytes*/, uint64_t /*blocks*/, void** /*request*/) { return -1; }
int sentAll(void** /*request*/) { return 1; }
int nothingArrived(int* /*from*/, uint64_t* /*blocks*/) { return 0; }
// A message that no memory holds.
int endlessArrived(int* from, uint64_t* blocks) {
  *from = 0;
  *blocks = uint64_t{1} << 57;
  return 1;
}
int receiveNothing(int /*from*/, void* /*bytes*/, uint64_t /*blocks*/) { return -1; }
int finishAlone() { return 0; }

constexpr MpiFunctions kAlone{kMpiPluginVersion, startAlone,     sendNothing, sentAll,
                              nothingArrived,    receiveNothing, finishAlone};

TEST(Mailbox, callsNobodyOnceItIsAbandoned) {
  std::atomic<int> ticks{0};
  Mailbox mailbox(kAlone);
  mailbox.open({.received = [](uint32_t, const Mailbox::Bytes&) {},
                .tick = [&] { ++ticks; },
                .failed = [](const std::exception&) {}});
  while (ticks == 0) std::this_thread::yield();
  mailbox.abandon();
  const int before = ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // three ticks
  EXPECT_EQ(ticks.load(), before);
}

TEST(Mailbox, goesOnWhereADutyThrows) {
  std::atomic<int> received{0}, failed{0};
  Mailbox mailbox(kAlone);
  const auto receive = [&](uint32_t, const Mailbox::Bytes&) {
    if (++received == 1) throw std::bad_alloc();
  };
  mailbox.open({.received = receive, .tick = [] {}, .failed = [&](const std::exception&) { ++failed; }});
  mailbox.post(0, {1});
  mailbox.post(0, {2});
  mailbox.finish();
  EXPECT_EQ(received.load(), 2);
  EXPECT_EQ(failed.load(), 1);
}

TEST(Mailbox, goesOnWithoutMemoryForAMessage) {
  MpiFunctions mpi = kAlone;
  mpi.arrived = endlessArrived;
  std::atomic<int> received{0}, failed{0};
  Mailbox mailbox(mpi);
  mailbox.open({.received = [&](uint32_t, const Mailbox::Bytes&) { ++received; },
                .tick = [] {},
                .failed = [&](const std::exception&) { ++failed; }});
  while (failed == 0) std::this_thread::yield();
  mailbox.post(0, {1});
  mailbox.finish();
  EXPECT_EQ(received.load(), 1);
}

}  // namespace
}  // namespace wavecrest
