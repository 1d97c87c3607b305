// A page on this machine that follows something under way: the page itself, events for it (server-sent events), and an
// image that changes.
//
// Whoever knows the address with its token may read; nobody may write. Nothing but the page is served without the
// token. Events are kept, so a page that is opened late or loaded again sees all of them. One thread answers all
// requests; publishing never waits for readers. What connections may cost is bounded: live_network.h.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bench/live/host_port.h"
#include "metrics/image/image.h"

namespace wavecrest {

class LiveNetwork;

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

  // The members below are for the network's thread.

  bool isToken(std::string_view text) const;
  const std::string& page() const { return page_; }
  // Events from `next` on that there are by now, as text of the stream; of many those that come first. over: no more
  // will come.
  std::string newEvents(size_t& next, bool& over);
  // The newest image with its bytes; null where there is none yet.
  struct Encoded {
    std::shared_ptr<const Image> image;
    std::shared_ptr<const std::string> bytes;
  };
  Encoded encodedImage();
  void imageWasSent(const std::shared_ptr<const Image>& image);
  // A reader of events has come (1) or left (-1).
  void countReader(int change);

 private:
  const std::string page_, token_;
  std::string url_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> events_;
  std::shared_ptr<const Image> image_;
  std::shared_ptr<const Image> sentImage_;  // the newest that somebody has fetched
  int readers_ = 0;                         // of events
  bool over_ = false;
  Encoded encoded_;  // the network's thread alone
  std::unique_ptr<LiveNetwork> network_;
  std::thread thread_;
};

}  // namespace wavecrest
