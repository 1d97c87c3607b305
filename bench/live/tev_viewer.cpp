#include "bench/live/tev_viewer.h"

#include <algorithm>
#include <asio.hpp>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "bench/live/tev_packets.h"

namespace wavecrest {
namespace {

using asio::ip::tcp;

constexpr auto kPatience = std::chrono::seconds(5);  // for a connection, and for each packet
constexpr size_t kPacketBytes = size_t{16} << 20;    // of rows, about

}  // namespace

// A stream of packets. Throws std::runtime_error where tev does not take them.
class TevViewer::Connection {
 public:
  explicit Connection(const HostPort& address) {
    asio::error_code error;
    const auto endpoints = tcp::resolver(io_).resolve(address.host, std::to_string(address.port), error);
    check("connecting failed", error);
    finish("connecting failed", [&](auto handler) { asio::async_connect(socket_, endpoints, std::move(handler)); });
    socket_.set_option(tcp::no_delay(true));
  }
  void send(const tev::Packet& packet) {
    finish("sending failed",
           [&](auto handler) { asio::async_write(socket_, asio::buffer(packet), std::move(handler)); });
  }
  // In bands, so that the film may be of any size.
  void send(const std::string& name, const Image& image) {
    const size_t rowBytes = size_t{image.width} * image.channels * sizeof(float);
    const auto rows = static_cast<uint32_t>(std::max<size_t>(kPacketBytes / rowBytes, 1));
    for (uint32_t first = 0; first < image.height; first += rows) {
      send(tev::updateRows(name, image, first, std::min(rows, image.height - first)));
    }
  }

 private:
  // Begins a step, which is given its handler, and runs it to its end. Throws if it fails or takes too long.
  template <class Begin>
  void finish(const char* step, Begin begin) {
    asio::error_code error;
    begin([&error](const asio::error_code& result, const auto& /*endpointOrBytes*/) { error = result; });
    io_.restart();
    io_.run_for(kPatience);
    if (!io_.stopped()) {
      // The handler has not been called yet. Closing the socket ends its step.
      socket_.close(error);
      io_.run();
      error = asio::error::timed_out;
    }
    check(step, error);
  }
  static void check(const char* step, const asio::error_code& error) {
    if (error) throw std::runtime_error(std::string(step) + ": " + error.message());
  }

  asio::io_context io_{1};
  tcp::socket socket_{io_};
};

TevViewer::TevViewer(HostPort address, std::string name, std::function<void(const std::string&)> warn)
    : address_(std::move(address)), name_(std::move(name)), warn_(std::move(warn)) {
  thread_ = std::thread([this] {
    // An error ends the thread with a warning. The render goes on.
    try {
      run();
    } catch (const std::exception& error) {
      warn_("--tev " + address_.text() + ": " + error.what() + "; nothing is shown there any more");
    }
  });
}

TevViewer::~TevViewer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void TevViewer::take(std::shared_ptr<const Look> look) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    look_ = std::move(look);
  }
  changed_.notify_one();
}

void TevViewer::showFile(const std::string& file) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // tev may run in another folder, so the path is made absolute.
  file_ = std::filesystem::absolute(file).string();
}

void TevViewer::run() {
  Connection connection(address_);
  bool created = false;
  for (;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    // Wait for a look or the end, and take what there is.
    changed_.wait(lock, [this] { return over_ || look_ != nullptr; });
    const std::shared_ptr<const Look> look = std::exchange(look_, nullptr);
    const std::string file = over_ ? file_ : "";
    lock.unlock();

    // Send the look. The first one tells the size of the image to create.
    if (look) {
      if (!created) connection.send(tev::createImage(name_, look->image.width, look->image.height));
      created = true;
      connection.send(name_, look->image);
      continue;  // another may have come meanwhile
    }
    // The end. An image without a file stays in tev, and a tev on another machine could not read the file.
    if (file.empty() || !isLoopback(address_.host)) return;
    connection.send(tev::openImage(file));
    if (created) connection.send(tev::closeImage(name_));
    return;
  }
}

}  // namespace wavecrest
