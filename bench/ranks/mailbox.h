// Messages between the processes of one render.
//
// A thread of its own does all that MPI does, and never waits within MPI for another process: it looks for messages
// every few milliseconds, so that it takes no time from the threads that render. Messages from one process to another
// arrive in the order in which they were posted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "bench/ranks/mpi_plugin.h"

namespace wavecrest {

class Mailbox {
 public:
  using Bytes = std::vector<unsigned char>;
  // All are called on the mailbox' thread. received: a message, also of this process to itself. tick: now and then.
  // failed: one of the others has thrown, or there was no memory for a message. The mailbox goes on. heard: a message
  // of another process has begun to arrive, perhaps behind a large one that takes long.
  struct Duties {
    std::function<void(uint32_t from, Bytes message)> received;
    std::function<void()> tick;
    std::function<void(const std::exception& error)> failed;
    std::function<void(uint32_t from)> heard = nullptr;
  };

  // Starts MPI. Throws RanksError where it cannot.
  explicit Mailbox(const MpiFunctions& mpi);
  // Abandons the mailbox, unless it was ended before.
  ~Mailbox();
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  uint32_t rank() const { return rank_; }
  uint32_t ranks() const { return ranks_; }
  // To be called once; messages before that wait.
  void open(Duties duties);
  // Hands a message over, from any thread.
  void post(uint32_t to, Bytes message);
  // Within a duty that takes long: begins to send what was posted to others, which waits for the duty's end otherwise.
  void sendNow();
  // Sends what was posted, and waits for all processes to do so.
  void finish();
  // Ends the thread without a word to MPI, which launchers take for a failure. What was posted is sent first, if that
  // takes but a moment. From then on no duty is called.
  void abandon();

 private:
  enum class Ending { none, finish, abandon };
  struct Letter {
    uint32_t other;  // to or from whom
    Bytes bytes;
    void* request = nullptr;
  };

  void run();
  void work();
  enum class Recipients { all, others };  // others: not this process
  std::optional<Letter> takePosted(Recipients recipients);
  bool sendPosted(Recipients recipients);
  bool receiveAll();
  bool deliverAll();
  void leaveToMpi();
  template <class Step>
  void guarded(Step step);
  void end(Ending ending);

  const MpiFunctions& mpi_;
  uint32_t rank_ = 0, ranks_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by the mutex.
  bool started_ = false, failed_ = false;
  Duties duties_;
  std::deque<Letter> posted_;
  Ending ending_ = Ending::none;
  // Of the mailbox' thread.
  std::deque<Letter> underWay_, arriving_;
  std::thread thread_;
};

}  // namespace wavecrest
