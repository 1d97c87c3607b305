#include "bench/live/live_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <Imath/half.h>
#include <algorithm>
#include <chrono>
#include <cstring>
#include <random>
#include <stdexcept>
#include <utility>

namespace wavecrest {
namespace {

// A reader of events keeps a thread; others fetch pages and images.
constexpr int kMostReaders = 12, kThreads = 16;
constexpr auto kHeartbeat = std::chrono::seconds(5);  // tells whether a reader is still there
constexpr auto kFarewell = std::chrono::seconds(2);   // for readers to take the end

// 128 random bits in hexadecimal digits.
std::string newToken() {
  std::random_device random;  // the system's
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

// Whether two tokens are equal, in a time that does not tell where they differ.
bool isSame(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

// Width and height as 32-bit numbers, then all values as 16-bit floats. Large values are clamped to the largest half.
std::string encodeImage(const Image& image) {
  const uint32_t sides[2] = {image.width, image.height};
  std::string bytes(sizeof sides + image.pixels.size() * sizeof(half), '\0');
  std::memcpy(bytes.data(), sides, sizeof sides);
  char* to = bytes.data() + sizeof sides;
  constexpr float kMost = HALF_MAX;
  for (const float value : image.pixels) {
    const uint16_t bits = half(std::clamp(value, -kMost, kMost)).bits();
    std::memcpy(to, &bits, sizeof bits);
    to += sizeof bits;
  }
  return bytes;
}

}  // namespace

LiveServer::LiveServer(const HostPort& address, std::string page)
    : page_(std::move(page)), token_(newToken()), server_(std::make_unique<httplib::Server>()) {
  addRoutes();
  // Not the library's own SO_REUSEPORT, by which a second process would share the port.
  server_->set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server_->new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server_->set_keep_alive_max_count(1);  // or ending would wait for connections that are kept for later
  server_->set_tcp_nodelay(true);
  // Bind before the thread starts, so that an error reaches the caller. Port 0 takes any that is free.
  HostPort bound = address;
  if (bound.port == 0) {
    bound.port = server_->bind_to_any_port(bound.host);
  } else if (!server_->bind_to_port(bound.host, bound.port)) {
    bound.port = -1;
  }
  if (bound.port <= 0) throw std::runtime_error(address.text() + ": cannot be listened at; expected a free port");
  url_ = "http://" + bound.text() + "/?token=" + token_;
  thread_ = std::thread([this] { server_->listen_after_bind(); });
}

LiveServer::~LiveServer() {
  {
    // Tell readers of the end. Wait up to kFarewell until they have left and the last image was fetched.
    std::unique_lock<std::mutex> lock(mutex_);
    over_ = true;
    changed_.notify_all();
    const bool wereReaders = readers_ > 0;
    changed_.wait_for(lock, kFarewell,
                      [&] { return readers_ == 0 && (!wereReaders || !image_ || sentImage_ == image_); });
  }
  server_->stop();
  thread_.join();
}

void LiveServer::publish(const std::string& json) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.push_back(json);
  }
  changed_.notify_all();
}

void LiveServer::setImage(std::shared_ptr<const Image> image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  image_ = std::move(image);
}

bool LiveServer::sendEvents(size_t& next, httplib::DataSink& sink) {
  std::unique_lock<std::mutex> lock(mutex_);
  // Wait for news. Without any, a comment is sent, which fails once the reader is gone.
  changed_.wait_for(lock, kHeartbeat, [&] { return over_ || next < events_.size(); });
  // Format all new events. A reader that connects again names the last id that it got.
  std::string text;
  for (; next < events_.size(); ++next) text += fmt::format("id: {}\ndata: {}\n\n", next, events_[next]);
  const bool end = over_;
  lock.unlock();
  // In an event stream a line that begins with a colon is a comment. Writing holds no lock.
  if (text.empty()) text = ": still there\n\n";
  if (end) text += "event: end\ndata: {}\n\n";
  if (!sink.write(text.data(), text.size())) return false;
  if (end) sink.done();
  return !end;
}

std::string LiveServer::encodedImage() {
  std::unique_lock<std::mutex> lock(mutex_);
  // Encode without the lock, so that nobody who publishes has to wait.
  const std::shared_ptr<const Image> image = image_;
  lock.unlock();
  if (!image) return {};
  std::string bytes = encodeImage(*image);
  lock.lock();
  // The destructor waits for this.
  sentImage_ = image;
  changed_.notify_all();
  return bytes;
}

void LiveServer::addRoutes() {
  using httplib::Request;
  using httplib::Response;
  // The page may load nothing from elsewhere, and its address with the token is passed on to nobody.
  server_->set_default_headers({{"Cache-Control", "no-store"},
                                {"Referrer-Policy", "no-referrer"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Content-Security-Policy",
                                 "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
                                 "connect-src 'self'; img-src 'self' data:; frame-ancestors 'none'"}});
  // No request is answered without the token.
  server_->set_pre_routing_handler([this](const Request& request, Response& response) {
    if (isSame(request.get_param_value("token"), token_)) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    response.set_content("This address lacks its token; expected the one that wavecrest printed.\n", "text/plain");
    return httplib::Server::HandlerResponse::Handled;
  });
  // The page, the newest image and the stream of events.
  server_->Get("/", [this](const Request&, Response& response) { response.set_content(page_, "text/html"); });
  server_->Get("/image", [this](const Request&, Response& response) {
    const std::string bytes = encodedImage();
    response.status = bytes.empty() ? 404 : 200;
    response.set_content(bytes, "application/octet-stream");
  });
  server_->Get("/events", [this](const Request& request, Response& response) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (readers_ >= kMostReaders) {
        response.status = 503;
        return;
      }
      ++readers_;
    }
    // A reader that lost its connection says which event it had last.
    size_t next = 0;
    const std::string last = request.get_header_value("Last-Event-ID");
    if (!last.empty() && last.size() < 10 && last.find_first_not_of("0123456789") == std::string::npos) {
      next = std::stoul(last) + 1;
    }
    response.set_chunked_content_provider(
        "text/event-stream", [this, next](size_t, httplib::DataSink& sink) mutable { return sendEvents(next, sink); },
        [this](bool) {
          const std::lock_guard<std::mutex> lock(mutex_);
          --readers_;
          changed_.notify_all();
        });
  });
}

}  // namespace wavecrest
