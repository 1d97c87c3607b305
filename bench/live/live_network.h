// The connections of a LiveServer: HTTP/1.1, one request each, answered by one thread.
//
// Who has not shown the token costs little: at most kMostStrangers connections, kMostRequest bytes and kRequestTime
// each, a read every kReadPause, and kMostAccepted connections a second. A newcomer takes the place of the stranger
// that has waited longest, so idle connections do not keep anybody out. Who has the token may hold kMostGuests
// connections, and has kReplyTime to take each piece of a reply. Bodies of requests are not read. Every connection is
// closed when the network ends.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "bench/live/host_port.h"

namespace wavecrest {

class LiveServer;

class LiveNetwork {
 public:
  static constexpr size_t kMostStrangers = 8, kMostGuests = 16;
  static constexpr size_t kMostRequest = size_t{16} << 10;
  static constexpr auto kRequestTime = std::chrono::seconds(2);
  static constexpr auto kReplyTime = std::chrono::seconds(5);
  static constexpr auto kReadPause = std::chrono::milliseconds(20);
  static constexpr int kMostAccepted = 50;  // per second

  // Listens. Throws std::runtime_error where the address cannot be listened at.
  LiveNetwork(LiveServer& server, const HostPort& address);
  ~LiveNetwork();
  LiveNetwork(const LiveNetwork&) = delete;
  LiveNetwork& operator=(const LiveNetwork&) = delete;

  // The address with the port that the system has chosen.
  HostPort bound() const;
  // Answers until stop(). The calling thread is the network's. Throws nothing: an error ends one connection.
  void run();
  // From any thread: there is news for readers of events.
  void wake();
  void stop();

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

}  // namespace wavecrest
