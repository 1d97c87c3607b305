#include "bench/live/live_server.h"

#include <fmt/format.h>
#include <pthread.h>

#include <Imath/half.h>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>

#include "bench/live/live_network.h"

namespace wavecrest {
namespace {

constexpr auto kFarewell = std::chrono::seconds(2);  // for readers to take the end
constexpr size_t kEventsAtOnce = size_t{1} << 18;    // bytes after which no further event is added

// 128 random bits in hexadecimal digits.
std::string newToken() {
  std::random_device random;  // the system's
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
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

LiveServer::LiveServer(const HostPort& address, std::string page) : page_(std::move(page)), token_(newToken()) {
  // The network listens before the thread starts, so that an error reaches the caller.
  network_ = std::make_unique<LiveNetwork>(*this, address);
  url_ = "http://" + network_->bound().text() + "/?token=" + token_;
  thread_ = std::thread([this] { network_->run(); });
  pthread_setname_np(thread_.native_handle(), "live page");
}

LiveServer::~LiveServer() {
  bool wereReaders = false;  // before any can have taken the end
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
    wereReaders = readers_ > 0;
  }
  network_->wake();
  {
    // Wait up to kFarewell until readers have left and the last image was fetched.
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kFarewell,
                      [&] { return readers_ == 0 && (!wereReaders || !image_ || sentImage_ == image_); });
  }
  network_->stop();
  thread_.join();
}

void LiveServer::publish(const std::string& json) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.push_back(json);
  }
  network_->wake();
}

void LiveServer::setImage(std::shared_ptr<const Image> image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  image_ = std::move(image);
}

// In a time that does not tell where the text differs.
bool LiveServer::isToken(std::string_view text) const {
  if (text.size() != token_.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < text.size(); ++i) difference |= static_cast<unsigned>(text[i] ^ token_[i]);
  return difference == 0;
}

std::string LiveServer::newEvents(size_t& next, bool& over) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // A reader that connects again names the last id that it got.
  std::string text;
  for (; next < events_.size() && text.size() < kEventsAtOnce; ++next) {
    text += fmt::format("id: {}\ndata: {}\n\n", next, events_[next]);
  }
  over = over_ && next >= events_.size();
  if (over) text += "event: end\ndata: {}\n\n";
  return text;
}

LiveServer::Encoded LiveServer::encodedImage() {
  std::shared_ptr<const Image> image;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    image = image_;
  }
  // Encoded once for all readers, without the lock, so that nobody who publishes has to wait.
  if (image && image != encoded_.image) encoded_ = {image, std::make_shared<const std::string>(encodeImage(*image))};
  return encoded_;
}

void LiveServer::imageWasSent(const std::shared_ptr<const Image>& image) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sentImage_ = image;
  }
  changed_.notify_all();
}

void LiveServer::countReader(int change) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    readers_ += change;
  }
  changed_.notify_all();
}

}  // namespace wavecrest
