#include "bench/live/live_network.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <exception>
#include <list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "bench/live/live_server.h"
#include "bench/whole_number.h"

namespace wavecrest {
namespace {

using asio::error_code;
using asio::ip::tcp;

constexpr auto kHeartbeat = std::chrono::seconds(5);  // tells a browser that the render is still there
constexpr int kBacklog = 64;                          // of connections that the system holds
constexpr int kAcceptedAtOnce = 5;                    // before a pause
constexpr size_t kPiece = size_t{1} << 18;            // bytes of a reply that have kReplyTime

// A comment of an event stream.
constexpr const char* kStillThere = ": still there\n\n";

// The page may load nothing from elsewhere, and its address with the token is passed on to nobody.
constexpr const char* kHeaders =
    "Connection: close\r\n"
    "Cache-Control: no-store\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Content-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "connect-src 'self'; img-src 'self' data:; frame-ancestors 'none'\r\n";

// What a request asks for.
struct Request {
  std::string_view method, path, token;
  size_t lastEvent = 0;  // 1 + the id that the reader had last; 0: none
};

// The value of NAME=VALUE in a query; empty where there is none.
std::string_view parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) return pair.substr(name.size() + 1);
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
  }
  return {};
}

// 1 + the value of the header Last-Event-ID, or 0. line: NAME: VALUE.
size_t afterLastEvent(std::string_view line) {
  constexpr std::string_view kName = "last-event-id:";
  const auto equal = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  if (line.size() < kName.size() ||
      !std::equal(kName.begin(), kName.end(), line.begin(), [&](char b, char a) { return equal(a, b); })) {
    return 0;
  }
  line.remove_prefix(std::min(line.find_first_not_of(' ', kName.size()), line.size()));
  const std::optional<unsigned> id = wholeNumber<unsigned>(line);
  return id ? size_t{*id} + 1 : 0;
}

// text: a whole head, lines that end in \r\n. What makes no sense is a request without method or token.
Request parseRequest(std::string_view text) {
  Request request;
  const std::string_view line = text.substr(0, text.find("\r\n"));
  const size_t first = line.find(' '), second = line.find(' ', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return request;
  request.method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, second - first - 1);
  request.path = target.substr(0, target.find('?'));
  if (request.path.size() < target.size()) request.token = parameter(target.substr(request.path.size() + 1), "token");
  // Of the headers only one matters.
  for (size_t at = line.size() + 2; at < text.size() && request.lastEvent == 0;) {
    const size_t end = std::min(text.find("\r\n", at), text.size());
    request.lastEvent = afterLastEvent(text.substr(at, end - at));
    at = end + 2;
  }
  return request;
}

// One connection. request: what has come so far. timer: when it is closed, or for a reader of events the next
// heartbeat.
struct Connection {
  explicit Connection(tcp::socket connected)
      : socket(std::move(connected)), timer(socket.get_executor()), pause(socket.get_executor()) {}
  tcp::socket socket;
  asio::steady_timer timer, pause;
  std::array<char, 4096> chunk{};
  std::string request, head;
  std::shared_ptr<const std::string> body;
  std::shared_ptr<const Image> image;  // that the body holds
  bool reads = false;                  // events
  bool writes = false;                 // just now
  size_t nextEvent = 0;
};
using Held = std::shared_ptr<Connection>;

}  // namespace

class LiveNetwork::Connections {
 public:
  Connections(LiveServer& server, const HostPort& address) : server_(server), host_(address.host) { listen(address); }

  HostPort bound() const { return {host_, acceptor_.local_endpoint().port()}; }
  // What a handler throws, as where memory is short, costs the connection that it served.
  void run() {
    accept();
    for (;;) {
      try {
        io_.run();
        return;
      } catch (const std::exception&) {
        // run() may be called again: the other handlers are still there.
      }
    }
  }
  void wake() {
    asio::post(io_, [this] {
      for (const Held& guest : guests_) {
        if (guest->reads && !guest->writes) sendEvents(guest);
      }
    });
  }
  void stop() { io_.stop(); }

 private:
  void listen(const HostPort& address) {
    try {
      tcp::resolver resolver(io_);
      const tcp::endpoint endpoint =
          *resolver.resolve(address.host, std::to_string(address.port), tcp::resolver::passive).begin();
      acceptor_.open(endpoint.protocol());
      fcntl(acceptor_.native_handle(), F_SETFD, FD_CLOEXEC);
      // Not SO_REUSEPORT, by which a second process would share the port.
      acceptor_.set_option(tcp::acceptor::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen(kBacklog);
    } catch (const asio::system_error& error) {
      throw std::runtime_error(
          fmt::format("{}: cannot be listened at: {}; expected an address of this machine with a free port",
                      address.text(), error.code().message()));
    }
  }

  // Accepts one connection after the other, with a pause now and then. Without descriptors it tries again later.
  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (!error && ++accepted_ % kAcceptedAtOnce != 0) {
        accept();
      } else {
        pause_.expires_after(std::chrono::milliseconds(1000) * kAcceptedAtOnce / kMostAccepted);
        pause_.async_wait([this](const error_code&) { accept(); });
      }
      // Last, as it may throw.
      if (!error) welcome(std::move(socket));
    });
  }

  void welcome(tcp::socket socket) {
    if (strangers_.size() >= kMostStrangers) leave(Held(strangers_.front()));
    const auto stranger = std::make_shared<Connection>(std::move(socket));
    fcntl(stranger->socket.native_handle(), F_SETFD, FD_CLOEXEC);
    error_code ignored;
    stranger->socket.set_option(tcp::no_delay(true), ignored);
    strangers_.push_back(stranger);
    leaveAfter(stranger, kRequestTime);
    read(stranger);
  }

  // Reads until the request's head is complete. Bytes that trickle in are read together after a pause.
  void read(const Held& stranger) {
    stranger->socket.async_read_some(asio::buffer(stranger->chunk),
                                     [this, stranger](const error_code& error, size_t count) {
                                       if (error) return leave(stranger);
                                       stranger->request.append(stranger->chunk.data(), count);
                                       if (stranger->request.find("\r\n\r\n") != std::string::npos)
                                         return answer(stranger);
                                       if (stranger->request.size() >= kMostRequest) return leave(stranger);
                                       stranger->pause.expires_after(kReadPause);
                                       stranger->pause.async_wait([this, stranger](const error_code& stopped) {
                                         if (!stopped && stranger->socket.is_open()) read(stranger);
                                       });
                                     });
  }

  void answer(const Held& stranger) {
    const Request request = parseRequest(stranger->request);
    if (!server_.isToken(request.token)) {
      return reply(stranger, "403 Forbidden", "text/plain",
                   "This address lacks its token; expected the one that wavecrest printed.\n");
    }
    if (guests_.size() >= kMostGuests) return reply(stranger, "503 Service Unavailable", "text/plain", "");
    // From here on the connection is a guest's.
    const Held guest = stranger;
    strangers_.remove(guest);
    guests_.push_back(guest);
    if (request.method != "GET") return reply(guest, "405 Method Not Allowed", "text/plain", "");
    if (request.path == "/") return reply(guest, "200 OK", "text/html", server_.page());
    if (request.path == "/events") return beginEvents(guest, request.lastEvent);
    if (request.path != "/image") return reply(guest, "404 Not Found", "text/plain", "");
    const LiveServer::Encoded encoded = server_.encodedImage();
    if (!encoded.image) return reply(guest, "404 Not Found", "text/plain", "");
    guest->image = encoded.image;
    reply(guest, "200 OK", "application/octet-stream", encoded.bytes);
  }

  void reply(const Held& to, const char* status, const char* type, std::string body) {
    reply(to, status, type, std::make_shared<const std::string>(std::move(body)));
  }

  // Sends a whole reply and closes the connection. Strangers keep the time that they have left.
  void reply(const Held& to, const char* status, const char* type, std::shared_ptr<const std::string> body) {
    to->head = fmt::format("HTTP/1.1 {}\r\n{}Content-Type: {}\r\nContent-Length: {}\r\n\r\n", status, kHeaders, type,
                           body->size());
    to->body = std::move(body);
    to->writes = true;
    sendRest(to, 0);
  }

  // Sends what follows the first `done` bytes, in pieces that have kReplyTime each.
  void sendRest(const Held& to, size_t done) {
    const size_t head = to->head.size();
    if (done == head + to->body->size()) {
      if (to->image) server_.imageWasSent(to->image);
      return finish(to);
    }
    const auto from = done < head ? std::string_view(to->head) : std::string_view(*to->body);
    const std::string_view piece = from.substr(done < head ? done : done - head, kPiece);
    if (isGuest(to)) leaveAfter(to, kReplyTime);
    asio::async_write(to->socket, asio::buffer(piece), [this, to, done](const error_code& error, size_t count) {
      error ? leave(to) : sendRest(to, done + count);
    });
  }

  void beginEvents(const Held& reader, size_t first) {
    reader->reads = true;
    reader->nextEvent = first;
    server_.countReader(1);
    // A reader sends nothing more. What can be read is the end of its connection.
    reader->socket.async_wait(tcp::socket::wait_read, [this, reader](const error_code&) { leave(reader); });
    send(reader, fmt::format("HTTP/1.1 200 OK\r\n{}Content-Type: text/event-stream\r\n\r\n", kHeaders));
  }

  // Sends the events that the reader does not have yet, then waits for news until the next heartbeat.
  void sendEvents(const Held& reader) {
    bool over = false;
    std::string text = server_.newEvents(reader->nextEvent, over);
    if (!text.empty()) return send(reader, std::move(text), over);
    at(reader, kHeartbeat, [this, reader] { send(reader, kStillThere); });
  }

  void send(const Held& reader, std::string text, bool last = false) {
    reader->writes = true;
    reader->head = std::move(text);
    sendText(reader, 0, last);
  }

  // Sends what follows the first `done` bytes of the text, in pieces that have kReplyTime each.
  void sendText(const Held& reader, size_t done, bool last) {
    leaveAfter(reader, kReplyTime);
    asio::async_write(reader->socket, asio::buffer(std::string_view(reader->head).substr(done, kPiece)),
                      [this, reader, done, last](const error_code& error, size_t count) {
                        if (!error && done + count < reader->head.size()) return sendText(reader, done + count, last);
                        reader->writes = false;
                        if (error) return leave(reader);
                        last ? finish(reader) : sendEvents(reader);
                      });
  }

  // Does something after a time, unless the timer is set anew before.
  template <class Then>
  void at(const Held& connection, std::chrono::steady_clock::duration time, Then then) {
    connection->timer.expires_after(time);
    connection->timer.async_wait([connection, then](const error_code& error) {
      const bool due = connection->timer.expiry() <= std::chrono::steady_clock::now();
      if (!error && due && connection->socket.is_open()) then();
    });
  }
  void leaveAfter(const Held& connection, std::chrono::steady_clock::duration time) {
    at(connection, time, [this, connection] { leave(connection); });
  }

  bool isGuest(const Held& connection) const {
    return std::find(guests_.begin(), guests_.end(), connection) != guests_.end();
  }

  // All was sent.
  void finish(const Held& connection) {
    error_code ignored;
    connection->socket.shutdown(tcp::socket::shutdown_send, ignored);
    leave(connection);
  }

  void leave(const Held& connection) {
    if (!connection->socket.is_open()) return;
    error_code ignored;
    connection->socket.close(ignored);
    connection->timer.cancel();
    connection->pause.cancel();
    if (connection->reads) server_.countReader(-1);
    strangers_.remove(connection);
    guests_.remove(connection);
  }

  LiveServer& server_;
  const std::string host_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::steady_timer pause_{io_};
  int accepted_ = 0;
  std::list<Held> strangers_, guests_;  // in the order in which they came
};

LiveNetwork::LiveNetwork(LiveServer& server, const HostPort& address)
    : connections_(std::make_unique<Connections>(server, address)) {}
LiveNetwork::~LiveNetwork() = default;
HostPort LiveNetwork::bound() const { return connections_->bound(); }
void LiveNetwork::run() { connections_->run(); }
void LiveNetwork::wake() { connections_->wake(); }
void LiveNetwork::stop() { connections_->stop(); }

}  // namespace wavecrest
