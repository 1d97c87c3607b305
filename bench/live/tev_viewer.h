// Shows a render in the image viewer tev while it goes on (`render --tev`).
//
// A thread of its own connects and sends; the render hands over looks and never waits for the network. A look that
// comes while another is being sent replaces those that wait. What cannot be sent is said once, and nothing is sent any
// more.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "bench/live/host_port.h"
#include "bench/live/look.h"

namespace wavecrest {

// Where tev listens unless told otherwise.
constexpr const char* kTevAddress = "127.0.0.1:14158";

class TevViewer {
 public:
  // name: of the image in tev. warn: is told, from another thread, once at most, what went wrong.
  TevViewer(HostPort address, std::string name, std::function<void(const std::string&)> warn);
  // Sends what waits, for some seconds at most.
  ~TevViewer();
  TevViewer(const TevViewer&) = delete;
  TevViewer& operator=(const TevViewer&) = delete;

  void take(std::shared_ptr<const Look> look);
  // The render has been written: the file takes the place of the image, if tev runs on this machine.
  void showFile(const std::string& file);

 private:
  class Connection;
  void run();

  const HostPort address_;
  const std::string name_;
  const std::function<void(const std::string&)> warn_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Look> look_;  // the newest that has not been sent
  std::string file_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace wavecrest
