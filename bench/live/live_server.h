// A page on this machine that follows something under way: the page itself, events for it (server-sent events), and an
// image that changes.
//
// Whoever knows the address with its token may read; nobody may write. Nothing but the page is served without the
// token. Events are kept, so a page that is opened late or loaded again sees all of them. Requests are answered on
// threads of their own; publishing never waits for readers.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench/live/host_port.h"
#include "metrics/image/image.h"

namespace httplib {
class Server;
class DataSink;
}  // namespace httplib

namespace wavecrest {

// This machine alone, and any port that is free.
constexpr const char* kPageAddress = "127.0.0.1:0";

class LiveServer {
 public:
  // page: HTML. Serves at /?token=TOKEN, /events?token=TOKEN and /image?token=TOKEN. Throws std::runtime_error where
  // the address cannot be listened at.
  LiveServer(const HostPort& address, std::string page);
  // Gives pages some time to take the last events and the last image.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  // With the token.
  const std::string& url() const { return url_; }
  // json: one line.
  void publish(const std::string& json);
  // Three channels. It is sent as its sides, two 32-bit numbers, then its values row by row as 16-bit floats.
  void setImage(std::shared_ptr<const Image> image);

 private:
  void addRoutes();
  // Sends events from `next` on that there are by now; false once there is nothing more to come.
  bool sendEvents(size_t& next, httplib::DataSink& sink);
  std::string encodedImage();

  const std::string page_, token_;
  std::string url_;
  std::unique_ptr<httplib::Server> server_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> events_;
  std::shared_ptr<const Image> image_;
  std::shared_ptr<const Image> sentImage_;  // the newest that somebody has fetched
  int readers_ = 0;                         // of events
  bool over_ = false;
  std::thread thread_;
};

}  // namespace wavecrest
