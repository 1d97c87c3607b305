// The mailbox' thread, with an MPI of one process that is not there.
#include "bench/ranks/mailbox.h"

#include <gtest/gtest.h>

#include <algorithm>
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
int allOver(void** /*request*/) { return 1; }
int nothingArrived(int* /*from*/, uint64_t* /*blocks*/) { return 0; }
// A message that no memory holds.
int endlessArrived(int* from, uint64_t* blocks) {
  *from = 0;
  *blocks = uint64_t{1} << 57;
  return 1;
}
int receiveNothing(int /*from*/, void* /*bytes*/, uint64_t /*blocks*/, void** /*request*/) { return -1; }
int finishAlone() { return 0; }

constexpr MpiFunctions kAlone{kMpiPluginVersion, startAlone,     sendNothing, allOver,
                              nothingArrived,    receiveNothing, finishAlone};

// Three messages, whose numbers are their first bytes: a large one of process 1, of which only the beginning has
// arrived, and behind it one more of process 1 and one of process 2.
constexpr int kSenders[] = {1, 1, 2};
std::atomic<int> begun{0};
std::atomic<bool> largeIsOver{false};

int threeArrived(int* from, uint64_t* blocks) {
  if (begun == 3) return 0;
  *from = kSenders[begun];
  *blocks = 1;
  return 1;
}
int receiveNext(int /*from*/, void* bytes, uint64_t blocks, void** request) {
  auto* const content = static_cast<unsigned char*>(bytes);
  std::fill_n(content, blocks * kMpiBlock, static_cast<unsigned char>(0));
  content[0] = static_cast<unsigned char>(begun);
  content[kMpiBlock - sizeof(uint64_t)] = 1;  // the length
  *request = begun == 0 ? &largeIsOver : nullptr;
  ++begun;
  return 0;
}
int overUnlessLarge(void** request) { return *request == nullptr || largeIsOver ? 1 : 0; }

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

std::atomic<int> sent{0};

int countSent(int /*to*/, const void* /*bytes*/, uint64_t /*blocks*/, void** /*request*/) {
  ++sent;
  return 0;
}

// As a heartbeat has to, while films are added.
TEST(Mailbox, sendsToOthersWithinADuty) {
  MpiFunctions mpi = kAlone;
  mpi.send = countSent;
  int received = 0, sentWithin = 0, receivedWithin = 0;
  Mailbox mailbox(mpi);
  const auto receive = [&](uint32_t, const Mailbox::Bytes&) {
    if (++received > 1) return;
    mailbox.post(0, {2});
    mailbox.post(1, {3});
    mailbox.sendNow();
    sentWithin = sent;
    receivedWithin = received;
  };
  mailbox.open({.received = receive, .tick = [] {}, .failed = [](const std::exception&) {}});
  mailbox.post(0, {1});
  mailbox.finish();
  EXPECT_EQ(sentWithin, 1);
  EXPECT_EQ(receivedWithin, 1) << "a duty was called within another";
  EXPECT_EQ(received, 2);
}

TEST(Mailbox, goesOnWhileALargeMessageArrives) {
  MpiFunctions mpi = kAlone;
  mpi.arrived = threeArrived;
  mpi.receive = receiveNext;
  mpi.over = overUnlessLarge;
  std::atomic<int> received{0}, heard{0}, ticks{0};
  std::atomic<int> order[3] = {-1, -1, -1};
  Mailbox mailbox(mpi);
  mailbox.open({.received = [&](uint32_t, const Mailbox::Bytes& bytes) { order[received++] = bytes.at(0); },
                .tick = [&] { ++ticks; },
                .failed = [](const std::exception&) {},
                .heard = [&](uint32_t) { ++heard; }});
  while (heard < 3) std::this_thread::yield();
  const int before = ticks;
  while (ticks < before + 3) std::this_thread::yield();
  EXPECT_EQ(received.load(), 1);
  EXPECT_EQ(order[0].load(), 2);
  largeIsOver = true;
  mailbox.finish();
  EXPECT_EQ(received.load(), 3);
  EXPECT_EQ(order[1].load(), 0);
  EXPECT_EQ(order[2].load(), 1);
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
