// A connection that fails ends alone, and one that has much to take gets it in pieces. An executable of its own,
// because it replaces the global operator new by one that refuses large blocks.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "bench/live/live_server.h"

namespace {

std::atomic<size_t> mostBytes{std::numeric_limits<size_t>::max()};  // of a block
std::atomic<int> refused{0};

}  // namespace

void* operator new(size_t bytes) {
  const bool refuse = bytes > mostBytes;
  if (refuse) ++refused;
  void* const memory = refuse ? nullptr : std::malloc(std::max<size_t>(bytes, 1));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(std::max<size_t>(bytes, 1));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, size_t /*bytes*/) noexcept { std::free(p); }

namespace wavecrest {
namespace {

// A connection to this machine that has sent a request.
class Asked {
 public:
  Asked(int port, const std::string& target) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::string request = "GET " + target + " HTTP/1.1\r\n\r\n";
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::write(socket_, request.data(), request.size()), static_cast<ssize_t>(request.size()));
  }
  ~Asked() { ::close(socket_); }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  // Waits for the first byte and takes it.
  void awaitAnswer() const {
    char byte = 0;
    EXPECT_EQ(::read(socket_, &byte, 1), 1);
  }
  // All that comes until the connection ends.
  std::string answer() const {
    std::string text;
    char chunk[4096];
    for (ssize_t count = 0; (count = ::read(socket_, chunk, sizeof chunk)) > 0;) {
      text.append(chunk, static_cast<size_t>(count));
    }
    return text;
  }

 private:
  const int socket_;
};

// The port of http://127.0.0.1:PORT/?token=TOKEN, and what begins with the question mark.
int portOf(const std::string& url) { return std::stoi(url.substr(std::string("http://127.0.0.1:").size())); }
std::string tokenOf(const std::string& url) { return url.substr(url.find('?')); }

TEST(LiveNetwork, answersOthersWhereAReplyFindsNoMemory) {
  LiveServer server({.host = "127.0.0.1", .port = 0}, "the page");
  const int port = portOf(server.url());
  const std::string token = tokenOf(server.url());
  constexpr uint32_t kWidth = 1024, kHeight = 512;
  server.setImage(std::make_shared<const Image>(
      Image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = std::vector<float>(3 * kWidth * kHeight)}));
  mostBytes = size_t{1} << 20;  // less than the image in half precision
  const Asked lost(port, "/image" + token);
  while (refused == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  mostBytes = std::numeric_limits<size_t>::max();
  const std::string answer = Asked(port, "/" + token).answer();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 OK")) << answer;
  EXPECT_TRUE(answer.ends_with("the page")) << answer;
}

// Four megabytes in all, the last of them in one event.
TEST(LiveNetwork, sendsManyEventsInPiecesAndTheEndAfterAll) {
  auto server = std::make_unique<LiveServer>(HostPort{.host = "127.0.0.1", .port = 0}, "the page");
  const std::string small(size_t{1} << 12, 'x'), large(size_t{1} << 20, 'y');
  for (size_t i = 0; i < 768; ++i) server->publish(small);
  server->publish(large);
  size_t next = 0;
  bool over = true;
  const size_t first = server->newEvents(next, over).size();
  EXPECT_LT(first, (size_t{1} << 18) + 2 * small.size());
  EXPECT_GT(next, 0u);
  EXPECT_FALSE(over);

  const Asked reader(portOf(server->url()), "/events" + tokenOf(server->url()));
  reader.awaitAnswer();
  std::thread ending([&] { server.reset(); });
  const std::string answer = reader.answer();
  ending.join();
  EXPECT_GT(answer.size(), 768 * small.size() + large.size());
  EXPECT_TRUE(answer.ends_with("id: 768\ndata: " + large + "\n\nevent: end\ndata: {}\n\n"));
}

}  // namespace
}  // namespace wavecrest
